/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Runs a command and makes the n-th system call fail that changes files below a folder: creating a file, writing, syncing,
 * truncating, closing a written file, renaming. A seccomp filter passes these calls of all threads and children to this process,
 * for root, too; the programs do not notice it. Reports the number of such calls.
 */
#include "config.h" /* for the declarations that it enables in system headers */

#ifndef __linux__
int main(void)
{
    return 77; /* skipped */
}
#else

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <unistd.h>

#include <linux/filter.h>
#include <linux/seccomp.h>

#ifndef SECCOMP_USER_NOTIF_FLAG_CONTINUE /* since Linux 5.5 */
#define SECCOMP_USER_NOTIF_FLAG_CONTINUE 1
#endif
#define SKIPPED 77
#define BROKEN 99

typedef enum kind {
    OF_FILE,  /**< a descriptor is the first argument */
    CLOSING,  /**< the same, counted only for a file with content */
    CREATING, /**< the second argument is a path, the third flags */
    OLD_PATH, /**< the first argument is a path */
    AT_PATH   /**< the second argument is a path */
} kind;

static const struct call {
    int number;
    kind kind;
    int reason; /* error code of a failing call */
} calls[] = {
    {SYS_write, OF_FILE, ENOSPC},   {SYS_pwrite64, OF_FILE, ENOSPC}, {SYS_writev, OF_FILE, ENOSPC},
    {SYS_pwritev, OF_FILE, ENOSPC}, {SYS_ftruncate, OF_FILE, EIO},   {SYS_fsync, OF_FILE, EIO},
    {SYS_fdatasync, OF_FILE, EIO},  {SYS_close, CLOSING, EIO},       {SYS_openat, CREATING, ENOSPC},
    {SYS_renameat2, AT_PATH, EIO},  {SYS_renameat, AT_PATH, EIO},
#ifdef SYS_rename
    {SYS_rename, OLD_PATH, EIO},
#endif
};
enum { CALLS = sizeof calls / sizeof *calls };

/** Selection of the failing calls, and the count. */
typedef struct plan {
    const char *folder;
    long n;   /* number of the failing call */
    int rest; /* the calls after it fail, too */
    long counted;
} plan;

/* ---- The command ---- */

static int install(void)
{
    struct sock_filter filter[CALLS + 3];
    filter[0] = (struct sock_filter)BPF_STMT(BPF_LD | BPF_W | BPF_ABS, (uint32_t)offsetof(struct seccomp_data, nr));
    for (int i = 0; i < CALLS; i++)
        filter[1 + i] =
            (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, (uint32_t)calls[i].number, (uint8_t)(CALLS - i), 0);
    filter[CALLS + 1] = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
    filter[CALLS + 2] = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_USER_NOTIF);
    const struct sock_fprog program = {CALLS + 3, filter};
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0))
        return -1;
    return (int)syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, SECCOMP_FILTER_FLAG_NEW_LISTENER, &program);
}

/** Sends a descriptor through a socket; -1 sends none. */
static void send_descriptor(int to, int fd)
{
    char byte = 0;
    struct iovec data = {&byte, 1};
    union {
        struct cmsghdr head;
        char room[CMSG_SPACE(sizeof(int))];
    } control = {.room = {0}};
    struct msghdr message = {.msg_iov = &data, .msg_iovlen = 1};
    if (fd >= 0) {
        message.msg_control = control.room;
        message.msg_controllen = sizeof control.room;
        control.head = (struct cmsghdr){.cmsg_len = CMSG_LEN(sizeof fd), .cmsg_level = SOL_SOCKET, .cmsg_type = SCM_RIGHTS};
        memcpy(CMSG_DATA(&control.head), &fd, sizeof fd);
    }
    sendmsg(to, &message, 0);
}

static int receive_descriptor(int from)
{
    char byte;
    int fd = -1;
    struct iovec data = {&byte, 1};
    union {
        struct cmsghdr head;
        char room[CMSG_SPACE(sizeof(int))];
    } control;
    struct msghdr message = {.msg_iov = &data,
                             .msg_iovlen = 1,
                             .msg_control = control.room,
                             .msg_controllen = sizeof control.room};
    if (recvmsg(from, &message, 0) == 1 && message.msg_controllen >= sizeof control.head)
        memcpy(&fd, CMSG_DATA(&control.head), sizeof fd);
    return fd;
}

static pid_t start(char **argv, int *listener)
{
    int pair[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pair))
        return -1;
    const pid_t child = fork();
    if (child == 0) {
        send_descriptor(pair[1], install());
        execvp(argv[0], argv);
        _exit(BROKEN);
    }
    *listener = child > 0 ? receive_descriptor(pair[0]) : -1;
    close(pair[0]);
    close(pair[1]);
    return child;
}

/* ---- The system calls ---- */

static int is_below(const plan *p, const char *path)
{
    const size_t n = strlen(p->folder);
    return !strncmp(path, p->folder, n) && (path[n] == '/' || !path[n]);
}

/**
 * True if a descriptor of the process is a regular file below the folder, has at least the given size, and is open for writing.
 */
static int is_ours(const plan *p, pid_t process, int fd, off_t least)
{
    char name[64], path[PATH_MAX];
    struct stat status;
    snprintf(name, sizeof name, "/proc/%ld/fd/%d", (long)process, fd);
    const ssize_t n = readlink(name, path, sizeof path - 1);
    if (n < 0 || stat(name, &status) || !S_ISREG(status.st_mode) || status.st_size < least)
        return 0;
    path[n] = 0;
    if (lstat(name, &status) || !(status.st_mode & S_IWUSR)) /* the link's mode shows the mode of the descriptor */
        return 0;
    return is_below(p, path);
}

static int names_ours(const plan *p, pid_t process, uint64_t address)
{
    char path[PATH_MAX] = "";
    const size_t most = sizeof path - 1, n = 4096 - address % 4096; /* the next page may not be mapped */
    struct iovec here = {path, most};
    struct iovec there[2] = {{(void *)(uintptr_t)address, n < most ? n : most}, {(void *)(uintptr_t)(address + n), 0}};
    there[1].iov_len = most - there[0].iov_len;
    return process_vm_readv(process, &here, 1, there, 2, 0) > 0 && is_below(p, path);
}

static const struct call *find_call(int number)
{
    for (int i = 0; i < CALLS; i++)
        if (calls[i].number == number)
            return &calls[i];
    return NULL;
}

static int is_counted(const plan *p, const struct call *call, const struct seccomp_notif *notice)
{
    const pid_t process = (pid_t)notice->pid;
    switch (call->kind) {
    case OF_FILE:
        return is_ours(p, process, (int)notice->data.args[0], 0);
    case CLOSING:
        return is_ours(p, process, (int)notice->data.args[0], 1);
    case CREATING:
        return (notice->data.args[2] & O_CREAT) && names_ours(p, process, notice->data.args[1]);
    case OLD_PATH:
        return names_ours(p, process, notice->data.args[0]);
    case AT_PATH:
        return names_ours(p, process, notice->data.args[1]);
    }
    return 0;
}

static void answer(plan *p, int listener)
{
    struct seccomp_notif notice = {0};
    struct seccomp_notif_resp reply = {0};
    if (ioctl(listener, SECCOMP_IOCTL_NOTIF_RECV, &notice))
        return;
    const struct call *call = find_call(notice.data.nr);
    reply.id = notice.id;
    reply.flags = SECCOMP_USER_NOTIF_FLAG_CONTINUE;
    if (call && is_counted(p, call, &notice)) {
        p->counted++;
        if (p->counted == p->n || (p->rest && p->counted > p->n)) {
            reply.flags = 0;
            reply.error = -call->reason;
        }
    }
    ioctl(listener, SECCOMP_IOCTL_NOTIF_SEND, &reply);
}

/** Handles system calls until the command has ended. \return its exit code, in the shell's convention */
static int serve(plan *p, pid_t child, int listener)
{
    int state = 0;
    for (;;) {
        struct pollfd wait = {.fd = listener, .events = POLLIN};
        if (poll(&wait, 1, 20) > 0 && (wait.revents & POLLIN))
            answer(p, listener);
        else if (waitpid(child, &state, WNOHANG) == child)
            return WIFEXITED(state) ? WEXITSTATUS(state) : 128 + WTERMSIG(state);
    }
}

int main(int argc, char **argv)
{
    if (argc < 5) {
        fprintf(stderr, "usage: fail-nth FOLDER REPORT N|N+ COMMAND...\n"
                        "Fail the N-th change below FOLDER, with + all later ones, too; write their number to REPORT.\n");
        return BROKEN;
    }
    int listener;
    char *end;
    plan p = {.folder = argv[1], .n = strtol(argv[3], &end, 10)};
    p.rest = *end == '+';
    const pid_t child = start(argv + 4, &listener);
    if (child < 0 || listener < 0) {
        fprintf(stderr, "fail-nth: seccomp notification of system calls is not available\n");
        return SKIPPED;
    }
    const int code = serve(&p, child, listener);
    FILE *report = fopen(argv[2], "w");
    if (!report)
        return BROKEN;
    fprintf(report, "%ld\n", p.counted);
    return fclose(report) ? BROKEN : code;
}

#endif

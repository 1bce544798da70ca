/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Runs another program to its end. */
#include "config.h"

#include "apps/import/child.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#define WAIT_MS 100 /* milliseconds between two checks of the child; chosen by hand, not measured */

extern char **environ;

typedef struct listener {
    FILE *log;
    adcgs_child_line line;
    void *user;
    char text[512];
    size_t n;
    int stop, is_told;
} listener;

/**
 * Writes whole lines to the log, so that equal output makes equal calls however it is split on arrival, and readers see lines.
 */
static void take_bytes(listener *l, const char *bytes, size_t n)
{
    size_t from = 0;
    for (size_t i = 0; i < n; i++) {
        const int ends = bytes[i] == '\n' || bytes[i] == '\r';
        if (l->log && (ends || i + 1 == n)) {
            fwrite(bytes + from, 1, i + 1 - from, l->log);
            from = i + 1;
        }
        if (l->log && ends)
            fflush(l->log);
        if (ends) {
            l->text[l->n] = 0;
            l->n = 0;
            l->stop |= l->line(l->user, l->text) != 0;
        } else if (l->n + 1 < sizeof l->text)
            l->text[l->n++] = bytes[i];
    }
}

/** Reads until all writers have closed the pipe. */
static void listen(listener *l, int fd, pid_t child)
{
    char bytes[4096];
    for (;;) {
        struct pollfd wait = {.fd = fd, .events = POLLIN};
        const int ready = poll(&wait, 1, WAIT_MS);
        const ssize_t n = ready > 0 ? read(fd, bytes, sizeof bytes) : -1;
        if (!n || (ready < 0 && errno != EINTR))
            return;
        if (n > 0)
            take_bytes(l, bytes, (size_t)n);
        else
            l->stop |= l->line(l->user, "") != 0;
        if (l->stop && !l->is_told) {
            kill(child, SIGTERM);
            l->is_told = 1;
        }
    }
}

static int start(pid_t *child, char *const argv[], int output)
{
    posix_spawn_file_actions_t actions;
    int code = posix_spawn_file_actions_init(&actions);
    if (code)
        return code;
    if (!(code = posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0)) &&
        !(code = posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO)) &&
        !(code = posix_spawn_file_actions_adddup2(&actions, output, STDERR_FILENO)))
        code = posix_spawnp(child, argv[0], &actions, NULL, argv, environ);
    posix_spawn_file_actions_destroy(&actions);
    return code;
}

static void write_command(FILE *log, char *const argv[])
{
    fputc('$', log);
    for (int i = 0; argv[i]; i++)
        fprintf(log, " %s", argv[i]);
    fputc('\n', log);
}

adcgs_status adcgs_child_run(char *const argv[], FILE *log, adcgs_child_line line, void *user, int *code, adcgs_error *error)
{
    listener l = {.log = log, .line = line, .user = user};
    int ends[2], state = 0;
    pid_t child;
    if (pipe2(ends, O_CLOEXEC))
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot start: %s", argv[0], strerror(errno));
    if (log)
        write_command(log, argv);
    const int reason = start(&child, argv, ends[1]);
    close(ends[1]);
    if (!reason)
        listen(&l, ends[0], child);
    close(ends[0]);
    if (reason)
        return adcgs_fail(error, reason == ENOENT ? ADCGS_ERR_UNSUPPORTED : ADCGS_ERR_IO, "%s: cannot start: %s", argv[0],
                          strerror(reason));
    while (waitpid(child, &state, 0) < 0)
        if (errno != EINTR)
            return adcgs_fail(error, ADCGS_ERR_IO, "%s: %s", argv[0], strerror(errno));
    *code = WIFEXITED(state) ? WEXITSTATUS(state) : 128 + WTERMSIG(state);
    return ADCGS_OK;
}

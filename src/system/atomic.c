/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Files that appear complete or not at all. */
#include "config.h"

#include "system/atomic.h"

#include "system/flush.h"
#include "system/interrupt.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define NAME_TRIES 1000     /* attempts to find an unused temporary name */
#define NAME_USUAL 255      /* bytes of a name, at most, if the file system does not report it; definition (NAME_MAX of Linux) */
#define LINKS_MAX 40        /* maximum number of links in a chain; definition (MAXSYMLINKS of Linux) */
#define MODE_BITS 0777      /* permissions among the bits of a mode; definition (POSIX, sys/stat.h) */
#define READER_NAP 50000000 /* nanoseconds between two checks for a reader of a pipe */

/** Length of the folder part of a path, with its slash. */
static size_t folder_length(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? (size_t)(slash - path) + 1 : 0;
}

/** Target of a link in the folder of `name`, as a path from the current directory. */
static char *join(const char *name, const char *link)
{
    const size_t folder = *link == '/' ? 0 : folder_length(name), bytes = strlen(link) + 1;
    char *path = malloc(folder + bytes);
    if (path) {
        memcpy(path, name, folder);
        memcpy(path + folder, link, bytes);
    }
    return path;
}

/**
 * True if the kernel would follow this link under protected_symlinks (proc(5)): false for a link of another user in a sticky
 * folder that everybody can write to. We follow links ourselves, so the kernel does not check.
 */
static int may_follow(const char *name)
{
    struct stat link, folder;
    char *const path = join(name, ".");
    const int unknown = !path || lstat(name, &link) || stat(path, &folder);
    free(path);
    if (unknown)
        return 0;
    return link.st_uid == geteuid() || link.st_uid == folder.st_uid || !(folder.st_mode & S_ISVTX) || !(folder.st_mode & S_IWOTH);
}

/**
 * End of a chain of symbolic links; the file need not exist. \return from malloc(); NULL, with errno set, if the chain has no end
 * or may not be followed
 */
static char *follow(const char *path)
{
    char link[PATH_MAX];
    char *name = strdup(path);
    for (int i = 0; name && i < LINKS_MAX; i++) {
        const ssize_t n = readlink(name, link, sizeof link - 1);
        if (n < 0)
            return name;
        link[n] = 0;
        char *next = may_follow(name) ? join(name, link) : NULL;
        free(name);
        if (!next && errno != ENOMEM)
            errno = EACCES;
        if (!next)
            return NULL;
        name = next;
    }
    if (name)
        errno = ELOOP;
    free(name);
    return NULL;
}

/** Length of the part of `base` that fits the folder's limit for names if `added` bytes follow. Cuts between UTF-8 characters. */
static size_t fit_name(const char *folder, const char *base, size_t added)
{
    const long limit = pathconf(folder, _PC_NAME_MAX);
    const size_t most = limit > 0 ? (size_t)limit : NAME_USUAL, room = most > added ? most - added : 0;
    size_t n = strlen(base);
    if (n <= room)
        return n;
    for (n = room; n > 0 && ((unsigned char)base[n] & 0xc0) == 0x80;)
        n--;
    return n;
}

/** Create the new file ".<name>.tmp<process>-<i>" next to a target. The extension stays last for programs that look at it. */
static int open_temporary(const char *target, char *name, size_t size)
{
    const size_t folder = folder_length(target);
    const char *base = target + folder, *dot = strrchr(base, '.');
    const char *extension = dot && dot != base && strlen(dot) < 32 ? dot : "";
    char tail[96];
    for (int i = 0; i < NAME_TRIES; i++) {
        snprintf(tail, sizeof tail, ".tmp%ld-%d%s", (long)getpid(), i, extension);
        snprintf(name, size, "%.*s.", (int)folder, target);
        snprintf(name, size, "%.*s.%.*s%s", (int)folder, target, (int)fit_name(name, base, strlen(tail) + 1), base, tail);
        const int fd = open(name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (fd >= 0 || errno != EEXIST)
            return fd;
    }
    return -1;
}

/**
 * Give the new file the old one's owner and mode. Errors are ignored: some file systems have neither, and only some users may
 * change them.
 */
static void take_mode(int fd, const struct stat *old)
{
    struct stat new;
    if (!fstat(fd, &new) && (new.st_uid != old->st_uid || new.st_gid != old->st_gid) && fchown(fd, old->st_uid, old->st_gid))
        errno = 0;
    if (fchmod(fd, old->st_mode & MODE_BITS))
        errno = 0;
}

/** Open a special file. Waits for a pipe's first reader, as open() would, but a caught signal ends the wait. */
static int open_special(const char *path)
{
    const struct timespec nap = {.tv_nsec = READER_NAP};
    int fd;
    const int before = adcgs_interrupts();
    while ((fd = open(path, O_WRONLY | O_CLOEXEC | O_NONBLOCK)) < 0 && errno == ENXIO) {
        if (adcgs_interrupts() != before) {
            errno = EINTR;
            return -1;
        }
        nanosleep(&nap, NULL);
    }
    if (fd >= 0 && fcntl(fd, F_SETFL, 0) < 0) { /* from here on writing blocks */
        close(fd);
        return -1;
    }
    return fd;
}

/** Open the output: the special file itself, or a temporary file next to the target. \return -1, with errno set, on failure */
static int open_file(adcgs_atomic *atomic)
{
    struct stat old;
    const int exists = !stat(atomic->target, &old);
    if (exists && !S_ISREG(old.st_mode))
        return open_special(atomic->target);
    if (exists && access(atomic->target, W_OK))
        return -1;
    const size_t size = 2 * strlen(atomic->target) + 128;
    atomic->temporary = malloc(size);
    const int fd = atomic->temporary ? open_temporary(atomic->target, atomic->temporary, size) : -1;
    if (fd < 0) {
        free(atomic->temporary);
        atomic->temporary = NULL;
    } else if (exists)
        take_mode(fd, &old);
    return fd;
}

static void forget(adcgs_atomic *atomic)
{
    free(atomic->path);
    free(atomic->target);
    free(atomic->temporary);
    *atomic = (adcgs_atomic){0};
}

adcgs_status adcgs_atomic_open(adcgs_atomic *atomic, const char *path, adcgs_error *error)
{
    struct stat status;
    *atomic = (adcgs_atomic){0};
    if (!stat(path, &status) && S_ISDIR(status.st_mode))
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: is a folder, expected the name of a file", path);
    atomic->path = strdup(path);
    atomic->target = atomic->path ? follow(path) : NULL;
    const int fd = atomic->target ? open_file(atomic) : -1;
    atomic->file = fd < 0 ? NULL : fdopen(fd, "wb");
    if (atomic->file)
        return ADCGS_OK;
    const int reason = errno;
    if (fd >= 0)
        close(fd);
    adcgs_atomic_abort(atomic);
    if (reason == ENOMEM)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    if (reason == EINTR)
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: interrupted while waiting for a reader of this pipe", path);
    return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot create: %s", path, strerror(reason));
}

/** Sync the folder, since its entry must survive a crash too. Folders that cannot be synced are left to the system. */
static void sync_folder(const char *path)
{
    const size_t n = folder_length(path);
    char *folder = n ? strndup(path, n) : strdup(".");
    const int fd = folder ? open(folder, O_RDONLY | O_CLOEXEC) : -1;
    if (fd >= 0) {
        fsync(fd);
        close(fd);
    }
    free(folder);
}

/** All steps up to the rename; closes the file. \return 0 or an errno value */
static int finish(adcgs_atomic *atomic)
{
    int reason = adcgs_file_flush(atomic->file);
    errno = 0;
    if (!reason && atomic->temporary && fsync(fileno(atomic->file)))
        reason = errno;
    if (fclose(atomic->file) && !reason)
        reason = errno;
    atomic->file = NULL;
    if (!reason && atomic->temporary && rename(atomic->temporary, atomic->target))
        reason = errno;
    return reason;
}

adcgs_status adcgs_atomic_commit(adcgs_atomic *atomic, adcgs_error *error)
{
    const int reason = finish(atomic);
    if (reason) {
        const adcgs_status status = adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot write: %s", atomic->path, strerror(reason));
        adcgs_atomic_abort(atomic);
        return status;
    }
    if (atomic->temporary)
        sync_folder(atomic->target);
    forget(atomic);
    return ADCGS_OK;
}

adcgs_status adcgs_atomic_show(adcgs_atomic *atomic, adcgs_error *error)
{
    const int reason = adcgs_file_flush(atomic->file);
    if (!reason && !atomic->temporary)
        return ADCGS_OK;
    if (reason || rename(atomic->temporary, atomic->target)) {
        const adcgs_status status =
            adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot write: %s", atomic->path, strerror(reason ? reason : errno));
        adcgs_atomic_abort(atomic);
        return status;
    }
    free(atomic->temporary);
    atomic->temporary = NULL;
    sync_folder(atomic->target);
    return ADCGS_OK;
}

void adcgs_atomic_abort(adcgs_atomic *atomic)
{
    if (atomic->file)
        fclose(atomic->file);
    if (atomic->temporary)
        unlink(atomic->temporary);
    forget(atomic);
}

adcgs_status adcgs_atomic_save(const char *path, const void *data, size_t bytes, adcgs_error *error)
{
    adcgs_atomic atomic;
    ADCGS_TRY(adcgs_atomic_open(&atomic, path, error));
    setvbuf(atomic.file, NULL, _IONBF, 0); /* one write needs no buffer */
    errno = 0;
    if (fwrite(data, 1, bytes, atomic.file) == bytes)
        return adcgs_atomic_commit(&atomic, error);
    const int reason = errno;
    adcgs_atomic_abort(&atomic);
    return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot write: %s", path, strerror(reason ? reason : EIO));
}

/** True if the last parts of two paths are equal and their folders are the same. */
static int same_place(const char *a, const char *b)
{
    struct stat status[2];
    const char *const path[2] = {a, b};
    if (strcmp(a + folder_length(a), b + folder_length(b)) != 0)
        return 0;
    for (int i = 0; i < 2; i++) {
        char *folder = join(path[i], ".");
        const int bad = !folder || stat(folder, &status[i]);
        free(folder);
        if (bad)
            return 0;
    }
    return status[0].st_dev == status[1].st_dev && status[0].st_ino == status[1].st_ino;
}

int adcgs_atomic_same(const char *a, const char *b)
{
    struct stat first, second;
    if (!stat(a, &first) && !stat(b, &second))
        return S_ISREG(first.st_mode) && first.st_dev == second.st_dev && first.st_ino == second.st_ino;
    char *ends[2] = {follow(a), follow(b)};
    const int same = ends[0] && ends[1] && same_place(ends[0], ends[1]);
    free(ends[0]);
    free(ends[1]);
    return same;
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Files that appear complete or not at all. */
#include "config.h"

#include "io/atomic.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#define NAME_TRIES 1000

/** Create "<path>.tmp<process>-<i>" anew; the extension stays last for libraries that look at it. */
static int open_temporary(const char *path, char *name, size_t size)
{
    const char *slash = strrchr(path, '/');
    const char *base = slash ? slash + 1 : path;
    const char *dot = strrchr(base, '.');
    const char *extension = dot && dot != base ? dot : "";
    for (int i = 0; i < NAME_TRIES; i++) {
        snprintf(name, size, "%.*s.%s.tmp%ld-%d%s", (int)(base - path), path, base, (long)getpid(), i, extension);
        const int fd = open(name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (fd >= 0 || errno != EEXIST)
            return fd;
    }
    return -1;
}

static void forget(adcgs_atomic *atomic)
{
    free(atomic->path);
    free(atomic->temporary);
    *atomic = (adcgs_atomic){0};
}

adcgs_status adcgs_atomic_open(adcgs_atomic *atomic, const char *path, adcgs_error *error)
{
    *atomic = (adcgs_atomic){0};
    struct stat status;
    const int special = !stat(path, &status) && !S_ISREG(status.st_mode);
    if (special && S_ISDIR(status.st_mode))
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: is a folder, expected the name of a file", path);
    const size_t size = 2 * strlen(path) + 64;
    atomic->path = strdup(path);
    atomic->temporary = special ? NULL : malloc(size);
    if (!atomic->path || (!special && !atomic->temporary)) {
        forget(atomic);
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    }
    const int fd = special ? open(path, O_WRONLY | O_CLOEXEC) : open_temporary(path, atomic->temporary, size);
    atomic->file = fd < 0 ? NULL : fdopen(fd, "wb");
    if (!atomic->file) {
        const int reason = errno;
        if (fd >= 0) {
            close(fd);
            if (atomic->temporary)
                unlink(atomic->temporary);
        }
        forget(atomic);
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot create: %s", path, strerror(reason));
    }
    return ADCGS_OK;
}

const char *adcgs_atomic_name(const adcgs_atomic *atomic)
{
    return atomic->temporary ? atomic->temporary : atomic->path;
}

/** The folder's entry must survive a crash too; folders that cannot be synced are left to the system. */
static void sync_folder(const char *path)
{
    const char *slash = strrchr(path, '/');
    char *folder = slash ? strndup(path, (size_t)(slash - path) + 1) : strdup(".");
    const int fd = folder ? open(folder, O_RDONLY | O_CLOEXEC) : -1;
    if (fd >= 0) {
        fsync(fd);
        close(fd);
    }
    free(folder);
}

adcgs_status adcgs_atomic_commit(adcgs_atomic *atomic, adcgs_error *error)
{
    errno = 0;
    int bad = fflush(atomic->file) || ferror(atomic->file) || (atomic->temporary && fsync(fileno(atomic->file)));
    int reason = errno;
    if (fclose(atomic->file) && !bad) {
        bad = 1;
        reason = errno;
    }
    atomic->file = NULL;
    if (!bad && atomic->temporary && rename(atomic->temporary, atomic->path)) {
        bad = 1;
        reason = errno;
    }
    if (bad) {
        const adcgs_status status =
            adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot write: %s", atomic->path, strerror(reason ? reason : EIO));
        adcgs_atomic_abort(atomic);
        return status;
    }
    if (atomic->temporary)
        sync_folder(atomic->path);
    forget(atomic);
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

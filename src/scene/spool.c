/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A file for images that do not fit into memory. */
#include "config.h"

#include "scene/spool.h"

#include "system/paths.h"

#include <errno.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/statvfs.h>
#include <unistd.h>

/* One part in this many of the free space is left for outputs and checkpoints on the same disk; chosen by hand, not measured. */
#define LEFT_TO_OTHERS 16

char *adcgs_spool_folder(void)
{
    const char *const chosen = getenv("TMPDIR");
    return strdup(chosen && *chosen ? chosen : "/var/tmp");
}

uint64_t adcgs_spool_room(const char *folder, int *problem)
{
    struct statvfs s;
    struct rlimit limit;
    *problem = 0;
    if (statvfs(folder, &s) || access(folder, W_OK | X_OK)) {
        *problem = errno;
        return 0;
    }
    const uint64_t block = s.f_frsize ? s.f_frsize : s.f_bsize, free_bytes = (uint64_t)s.f_bavail * block;
    uint64_t room = s.f_blocks ? free_bytes - free_bytes / LEFT_TO_OTHERS : UINT64_MAX; /* tmpfs without a limit has no blocks */
    if (!getrlimit(RLIMIT_FSIZE, &limit) && limit.rlim_cur != RLIM_INFINITY)
        room = ADCGS_MIN(room, (uint64_t)limit.rlim_cur);
    return room;
}

adcgs_status adcgs_spool_init(adcgs_spool *spool, adcgs_error *error)
{
    *spool = (adcgs_spool){.file = -1, .folder = adcgs_spool_folder()};
    return spool->folder ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for images");
}

void adcgs_spool_clear(adcgs_spool *spool)
{
    if (spool->file >= 0)
        close(spool->file);
    free(spool->folder);
    *spool = (adcgs_spool){.file = -1};
}

static void open_file(adcgs_spool *spool)
{
    spool->room = adcgs_spool_room(spool->folder, &spool->problem);
    char *const name = adcgs_path("%s/adcgs-XXXXXX", spool->folder);
    if (!name)
        spool->problem = ENOMEM;
    else if (!spool->problem && (spool->file = mkstemp(name)) < 0)
        spool->problem = errno;
    if (spool->file >= 0)
        unlink(name);
    free(name);
}

int adcgs_spool_take(adcgs_spool *spool, size_t bytes, uint64_t *at)
{
    if (spool->file < 0 && !spool->problem)
        open_file(spool);
    if (spool->problem || bytes > spool->room - spool->used) /* a smaller image may still fit */
        return 0;
    *at = spool->used;
    spool->used += bytes;
    return 1;
}

int adcgs_spool_write(const adcgs_spool *spool, const void *data, size_t bytes, uint64_t at)
{
    for (size_t done = 0; done < bytes;) {
        const ssize_t n = pwrite(spool->file, (const char *)data + done, bytes - done, (off_t)(at + done));
        if (n <= 0 && errno != EINTR)
            return errno ? errno : EIO;
        done += n > 0 ? (size_t)n : 0;
    }
    return 0;
}

int adcgs_spool_read(const adcgs_spool *spool, void *data, size_t bytes, uint64_t at)
{
    for (size_t done = 0; done < bytes;) {
        const ssize_t n = pread(spool->file, (char *)data + done, bytes - done, (off_t)(at + done));
        if (n == 0 || (n < 0 && errno != EINTR))
            return n ? errno : EIO;
        done += n > 0 ? (size_t)n : 0;
    }
    return 0;
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Files that grow under their names. */
#include "config.h"

#include "system/growing.h"

#include "system/flush.h"

#include <errno.h>
#include <unistd.h>

adcgs_status adcgs_growing_open(adcgs_growing *g, const char *path, adcgs_error *error)
{
    *g = (adcgs_growing){.file = stdout};
    if (!strcmp(path, "-"))
        return ADCGS_OK;
    const adcgs_status status = adcgs_atomic_open(&g->atomic, path, error);
    g->file = g->atomic.file;
    g->is_regular = g->atomic.temporary != NULL;
    return status;
}

/** Remove a partly written piece. */
static adcgs_status take_back(adcgs_growing *g, int reason, adcgs_error *error)
{
    if (g->is_regular && ftruncate(fileno(g->file), (off_t)g->bytes))
        reason = reason ? reason : errno;
    return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot write: %s", g->atomic.path ? g->atomic.path : "standard output",
                      strerror(reason ? reason : EIO));
}

adcgs_status adcgs_growing_append(adcgs_growing *g, const void *data, size_t bytes, adcgs_error *error)
{
    errno = 0;
    const int written = fwrite(data, 1, bytes, g->file) == bytes, reason = written ? adcgs_file_flush(g->file) : errno;
    if (!written || reason)
        return take_back(g, reason, error);
    g->bytes += bytes;
    if (!g->atomic.temporary || g->is_hidden)
        return ADCGS_OK;
    const adcgs_status status = adcgs_atomic_show(&g->atomic, error);
    g->file = status == ADCGS_OK ? g->file : NULL; /* on failure it has been closed */
    return status;
}

void adcgs_growing_close(adcgs_growing *g)
{
    if (g->file)
        adcgs_atomic_abort(&g->atomic);
    g->file = NULL;
}

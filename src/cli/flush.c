/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Whether all that was written to a stream has arrived. */
#include "config.h"

#include "cli/flush.h"

#include <errno.h>

int adcgs_file_flush(FILE *file)
{
    const int failed = ferror(file);
    errno = 0;
    if (fflush(file))
        return errno ? errno : EIO;
    if (!failed && !ferror(file))
        return 0;
    /* A write has failed earlier, and its reason is gone by now. It is lost in any case; whoever is full still tells. */
    clearerr(file);
    errno = 0;
    return (fputc('\n', file) == EOF || fflush(file)) && errno ? errno : EIO;
}

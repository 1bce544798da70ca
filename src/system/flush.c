/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Flushing a stream, with all errors. */
#include "config.h"

#include "system/flush.h"

#include <errno.h>

int adcgs_file_flush(FILE *file)
{
    const int failed = ferror(file);
    errno = 0;
    if (fflush(file))
        return errno ? errno : EIO;
    if (!failed && !ferror(file))
        return 0;
    /*
     * An earlier write failed and its errno is lost, as are its data. Writing again gives the reason: a full device fails again.
     */
    clearerr(file);
    errno = 0;
    return (fputc('\n', file) == EOF || fflush(file)) && errno ? errno : EIO;
}

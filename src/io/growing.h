/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A file that grows under its name while others read it: it appears with the first piece, in the place of what was there before,
 * and holds whole pieces, whatever happens. Special files, and standard output ("-"), get piece after piece.
 */
#ifndef ADCGS_IO_GROWING_H
#define ADCGS_IO_GROWING_H

#include "io/atomic.h"

typedef struct adcgs_growing {
    adcgs_atomic atomic;
    FILE *file;       /**< NULL: not open */
    int is_regular;
    int is_hidden;    /**< the caller's to set: a regular file does not appear yet, with whatever piece */
    uint64_t bytes;   /**< of whole pieces */
} adcgs_growing;

/** Errors as of adcgs_atomic_open(). A pipe waits for its reader. */
adcgs_status adcgs_growing_open(adcgs_growing *growing, const char *path, adcgs_error *error);
/** Write a piece out, which shows, with those before it, unless is_hidden. On failure a regular file ends before it. */
adcgs_status adcgs_growing_append(adcgs_growing *growing, const void *data, size_t bytes, adcgs_error *error);
/** Leave it as it is; without a piece a regular file does not appear. Harmless when nothing is open. */
void adcgs_growing_close(adcgs_growing *growing);

#endif

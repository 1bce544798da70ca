/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A file that grows under its name while others read it. It appears with the
 * first piece, replaces the previous file, and always holds whole pieces.
 * Special files, and standard output ("-"), receive piece after piece.
 */
#ifndef ADCGS_SYSTEM_GROWING_H
#define ADCGS_SYSTEM_GROWING_H

#include "system/atomic.h"

typedef struct adcgs_growing {
    adcgs_atomic atomic;
    FILE *file; /**< NULL: not open */
    int is_regular;
    int is_hidden;  /**< set by the caller: a regular file does not appear yet, even after a piece */
    uint64_t bytes; /**< length of the whole pieces */
} adcgs_growing;

/** Errors as of adcgs_atomic_open(). A pipe waits for its reader. */
adcgs_status adcgs_growing_open(adcgs_growing *growing, const char *path, adcgs_error *error);
/**
 * Write a piece. It becomes visible with the pieces before it, except if is_hidden. On failure a regular file ends before this
 * piece.
 */
adcgs_status adcgs_growing_append(adcgs_growing *growing, const void *data, size_t bytes, adcgs_error *error);
/** Leave the file with its pieces; without a piece a regular file does not appear. Harmless when nothing is open. */
void adcgs_growing_close(adcgs_growing *growing);

#endif

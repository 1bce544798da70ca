/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Tables of numbers in NPY files. */
#ifndef ADCGS_MEDIA_ARRAYS_NPY_H
#define ADCGS_MEDIA_ARRAYS_NPY_H

#include "base/base.h"

/** A table inside the file's bytes, which must outlive it. */
typedef struct adcgs_npy {
    uint64_t rows;
    uint32_t columns;
    int item_bytes;         /**< 4 or 8: binary32 or binary64, little-endian */
    const uint8_t *numbers; /**< row by row */
} adcgs_npy;

/**
 * Find the table in an NPY file, formats 1.0 to 3.0: C order, shape (n, columns), without trailing bytes. what: the rows' name in
 * messages, "points", "poses".
 */
adcgs_status adcgs_npy_open(adcgs_npy *out, const uint8_t *data, size_t bytes, uint32_t columns, const char *what,
                            const char *path, adcgs_error *error);
/**
 * The same for a table for each frame: shape (frames, n, columns). The table has frames * n rows, which are fewer than 2^40.
 */
adcgs_status adcgs_npy_open_frames(adcgs_npy *out, uint64_t *frames, const uint8_t *data, size_t bytes, uint32_t columns,
                                   const char *path, adcgs_error *error);
/** A number of the table as stored, so it may not be finite. */
double adcgs_npy_value(const adcgs_npy *table, size_t row, uint32_t column);

#endif

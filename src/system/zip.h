/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A ZIP archive of a few uncompressed files, written sequentially. */
#ifndef ADCGS_SYSTEM_ZIP_H
#define ADCGS_SYSTEM_ZIP_H

#include "base/base.h"

#include <stdio.h>

#define ADCGS_ZIP_FILES 8 /**< files of an archive, at most; chosen by hand, not measured */
/** Upper bound of the ratio of deflate's uncompressed to compressed bytes; literature (zlib's documentation). */
#define ADCGS_DEFLATE_RATIO 1032

typedef struct adcgs_zip {
    FILE *file; /**< the caller checks it for errors; members below are initially zero */
    int n;
    struct {
        const char *name; /**< must outlive the archive */
        uint32_t crc, bytes, offset;
    } files[ADCGS_ZIP_FILES];
    uint32_t at;
} adcgs_zip;

/** Add a file: at most ADCGS_ZIP_FILES, and less than 4 GiB in total. */
void adcgs_zip_add(adcgs_zip *zip, const char *name, const uint8_t *data, size_t bytes);
/** Write the directory, which completes the archive. */
void adcgs_zip_end(adcgs_zip *zip);

#endif

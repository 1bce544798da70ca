/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A ZIP archive of a few files that are stored as they are, written from its beginning to its end. */
#ifndef ADCGS_IO_ZIP_H
#define ADCGS_IO_ZIP_H

#include "base/base.h"

#include <stdio.h>

#define ADCGS_ZIP_FILES 8

typedef struct adcgs_zip {
    FILE *file; /**< the caller's, who looks at its errors; the rest begins as zero */
    int n;
    struct {
        const char *name; /**< lives as long as the archive */
        uint32_t crc, bytes, offset;
    } files[ADCGS_ZIP_FILES];
    uint32_t at;
} adcgs_zip;

/** One of ADCGS_ZIP_FILES at most; all together have less than 4 GiB. */
void adcgs_zip_add(adcgs_zip *zip, const char *name, const uint8_t *data, size_t bytes);
/** The directory, which makes it complete. */
void adcgs_zip_end(adcgs_zip *zip);

#endif

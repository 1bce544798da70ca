/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Files of a ZIP archive in memory, by name. Archives have one part, no encryption and less than 4 GiB, without ZIP64; their
 * files are stored or deflated.
 */
#ifndef ADCGS_MEDIA_ARRAYS_ZIP_READ_H
#define ADCGS_MEDIA_ARRAYS_ZIP_READ_H

#include "base/base.h"

/** An archive. The bytes and the path, which messages name, must outlive it. Nothing needs to be freed. */
typedef struct adcgs_zip_archive {
    const uint8_t *data;
    size_t bytes;
    const char *path;
    size_t directory; /**< position of the directory */
    unsigned n;       /**< number of its entries */
} adcgs_zip_archive;

/** True if the bytes begin like an archive. */
int adcgs_zip_is(const uint8_t *data, size_t bytes);
/**
 * Find and check the directory at the end of an archive. ADCGS_ERR_DATA for a damaged one and one that ends early,
 * ADCGS_ERR_UNSUPPORTED for ZIP64 and for an archive of several parts.
 */
adcgs_status adcgs_zip_open(adcgs_zip_archive *out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error);
/** True if the directory has a file of this name. Folders are a part of names: "a/b.png". */
int adcgs_zip_has(const adcgs_zip_archive *zip, const char *name);
/**
 * Unpack the file of this name: *bytes bytes at *out, from malloc(), and a zero byte after them. Its checksum is checked, in a
 * build with zlib. ADCGS_ERR_DATA without such a file, for a damaged one, and for one of more than `most` bytes, before memory is
 * allocated. ADCGS_ERR_UNSUPPORTED for an encrypted file, another method than deflate, and for a deflated file in a build without
 * zlib. On failure *out is NULL.
 */
adcgs_status adcgs_zip_unpack(uint8_t **out, size_t *bytes, const adcgs_zip_archive *zip, const char *name, uint64_t most,
                              adcgs_error *error);

#endif

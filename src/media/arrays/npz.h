/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Arrays in NPZ files: a ZIP archive with an NPY file for each. */
#ifndef ADCGS_MEDIA_ARRAYS_NPZ_H
#define ADCGS_MEDIA_ARRAYS_NPZ_H

#include "base/base.h"

/**
 * The NPY file with the name of an array, from malloc(), with a zero byte after it. Archives must be like numpy's: one part, no
 * encryption, less than 4 GiB; stored, or deflated if this build has zlib (media/arrays/zip_read.h).
 */
adcgs_status adcgs_npz_parse(uint8_t **out, size_t *bytes, const uint8_t *archive, size_t archive_bytes, const char *path,
                             const char *array, adcgs_error *error);
/** As adcgs_npz_parse(), from a file. */
adcgs_status adcgs_npz_read(uint8_t **out, size_t *bytes, const char *path, const char *array, adcgs_error *error);

#endif

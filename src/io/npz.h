/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Arrays in NPZ files: a ZIP archive with an NPY file for each. */
#ifndef ADCGS_IO_NPZ_H
#define ADCGS_IO_NPZ_H

#include "base/base.h"

/**
 * The NPY file of an array's name, from malloc(), with a zero byte behind it. Archives are those of numpy: one part, no
 * encryption, less than 4 GiB; stored, or deflated where this build has zlib (ADCGS_ERR_UNSUPPORTED where it has not).
 */
adcgs_status adcgs_npz_read(uint8_t **out, size_t *bytes, const char *path, const char *array, adcgs_error *error);

#endif

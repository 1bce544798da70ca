/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A whole file in memory. */
#ifndef ADCGS_IO_FILE_H
#define ADCGS_IO_FILE_H

#include "base/base.h"

/** Load a regular file of at most limit bytes; the caller free()s *data, which has a zero byte after the last one. */
adcgs_status adcgs_file_load(uint8_t **data, size_t *bytes, const char *path, uint64_t limit, adcgs_error *error);

#endif

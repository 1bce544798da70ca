/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Opening and loading files. */
#ifndef ADCGS_SYSTEM_FILE_H
#define ADCGS_SYSTEM_FILE_H

#include "base/base.h"

#include <stdio.h>

/**
 * Open a regular file for reading, as binary. A pipe, a device or a folder gives ADCGS_ERR_IO at once, without waiting for a
 * writer.
 */
adcgs_status adcgs_file_open(FILE **out, const char *path, adcgs_error *error);
/**
 * Check that path is a regular file that can be read and is not empty. what: the expected content for the message, "an image".
 */
adcgs_status adcgs_file_check(const char *path, const char *what, adcgs_error *error);
/** Load a regular file of at most limit bytes. The caller free()s *data; a zero byte follows the last byte. */
adcgs_status adcgs_file_load(uint8_t **data, size_t *bytes, const char *path, uint64_t limit, adcgs_error *error);
/** The same for a file from adcgs_file_open(), read from its start. The caller still closes the file. */
adcgs_status adcgs_file_load_open(uint8_t **data, size_t *bytes, FILE *file, const char *path, uint64_t limit,
                                  adcgs_error *error);
/** Length of the UTF-8 byte order mark that some editors write before a text: 3, or 0 if there is none. */
size_t adcgs_file_mark(const void *text, size_t bytes);
/** Load a text: as adcgs_file_load(), without a byte order mark. */
adcgs_status adcgs_file_load_text(uint8_t **data, size_t *bytes, const char *path, uint64_t limit, adcgs_error *error);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Files that are read: opening them, a whole one in memory. */
#ifndef ADCGS_IO_FILE_H
#define ADCGS_IO_FILE_H

#include "base/base.h"

#include <stdio.h>

/**
 * Open a regular file for reading, as binary. A pipe, a device and a folder are ADCGS_ERR_IO at once: nothing waits for who
 * might write to them.
 */
adcgs_status adcgs_file_open(FILE **out, const char *path, adcgs_error *error);
/** Is it a regular file that can be read and holds something? what it is, for the message: "an image". */
adcgs_status adcgs_file_check(const char *path, const char *what, adcgs_error *error);
/** Load a regular file of at most limit bytes; the caller free()s *data, which has a zero byte after the last one. */
adcgs_status adcgs_file_load(uint8_t **data, size_t *bytes, const char *path, uint64_t limit, adcgs_error *error);
/** The same of one that adcgs_file_open() opened and that is at its start; it stays open, and the caller's. */
adcgs_status adcgs_file_load_open(uint8_t **data, size_t *bytes, FILE *file, const char *path, uint64_t limit,
                                  adcgs_error *error);
/** Bytes of the byte order mark that some editors put before a text in UTF-8: 3, or 0 if there is none. */
size_t adcgs_file_mark(const void *text, size_t bytes);
/** Load a text: as adcgs_file_load(), without that mark. */
adcgs_status adcgs_file_load_text(uint8_t **data, size_t *bytes, const char *path, uint64_t limit, adcgs_error *error);

#endif

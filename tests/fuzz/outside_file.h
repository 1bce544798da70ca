/* SPDX-License-Identifier: BSD-2-Clause */
/** \file An input as a file, for parsers that take a path. */
#ifndef ADCGS_TESTS_FUZZ_OUTSIDE_FILE_H
#define ADCGS_TESTS_FUZZ_OUTSIDE_FILE_H

#include "fuzz.h"

#include <unistd.h>

static inline void write_outside_file(const char *path, const uint8_t *data, size_t size)
{
    FILE *file = fopen(path, "wb");
    FUZZ_REQUIRE(file && fwrite(data, 1, size, file) == size);
    fclose(file);
}

#endif

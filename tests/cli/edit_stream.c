/* SPDX-License-Identifier: BSD-2-Clause */
/** \file edit-stream FILE OLD NEW: replace a text by another one of the same length, and update all checksums. */
#define _GNU_SOURCE

#include "stream_edit.h"

#include <stdio.h>
#include <stdlib.h>

int main(int argc, char **argv)
{
    static uint8_t data[1 << 22];
    FILE *file = argc == 4 && strlen(argv[2]) == strlen(argv[3]) ? fopen(argv[1], "r+b") : NULL;
    const size_t size = file ? fread(data, 1, sizeof data, file) : 0;
    uint8_t *const found = file ? memmem(data, size, argv[2], strlen(argv[2])) : NULL;
    if (!found || size == sizeof data) {
        fprintf(stderr, "edit-stream: no such text, or not FILE OLD NEW\n");
        return 1;
    }
    memcpy(found, argv[3], strlen(argv[3]));
    adcgs_repair_stream(data, size, 0);
    rewind(file);
    const int bad = fwrite(data, 1, size, file) != size;
    return fclose(file) || bad;
}

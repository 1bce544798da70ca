/* SPDX-License-Identifier: BSD-2-Clause */
/** \file NPZ files of arrays of binary32. */
#ifndef ADCGS_TESTS_MEDIA_NPZ_FILES_H
#define ADCGS_TESTS_MEDIA_NPZ_FILES_H

#include "outside_files.h"

#include "system/zip.h"

#include <math.h>

/** An array of an NPZ file: its name with .npy, its shape as Python's text, and the value of all its numbers. */
typedef struct npz_array {
    const char *name, *shape;
    size_t n;
    float value;
} npz_array;

/** An archive of arrays, to be freed; arrays without a name are left out. */
static inline uint8_t *make_npz(const npz_array *arrays, int n, size_t *bytes)
{
    char *text = NULL;
    FILE *const file = open_memstream(&text, bytes);
    adcgs_zip zip = {.file = file};
    for (int i = 0; i < n; i++) {
        uint8_t data[2048] = "\x93NUMPY\x01";
        if (!arrays[i].name)
            continue;
        const int header =
            snprintf((char *)data + 10, 256, "{'descr': '<f4', 'fortran_order': False, 'shape': %s, }\n", arrays[i].shape);
        adcgs_store_le16(data + 8, (uint16_t)header);
        uint8_t *at = data + 10 + header;
        for (size_t k = 0; k < arrays[i].n; k++, at += 4)
            adcgs_store_le32(at, adcgs_float_bits(arrays[i].value));
        assert_true(at <= data + sizeof data);
        adcgs_zip_add(&zip, arrays[i].name, data, (size_t)(at - data));
    }
    adcgs_zip_end(&zip);
    fclose(file);
    return (uint8_t *)text;
}

#endif

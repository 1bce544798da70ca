/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Files of splats made byte by byte, and samples with known values. */
#ifndef ADCGS_TESTS_MEDIA_SPLAT_BYTES_H
#define ADCGS_TESTS_MEDIA_SPLAT_BYTES_H

#include "dynamic_fixture.h"
#include "random_splats.h"

/** A file that is held in memory. */
typedef struct made_file {
    uint8_t data[65536];
    size_t n;
} made_file;

static inline void put(made_file *b, const void *data, size_t n)
{
    assert_true(b->n + n <= sizeof b->data);
    memcpy(b->data + b->n, data, n);
    b->n += n;
}

static inline void put32(made_file *b, uint32_t value)
{
    uint8_t le[4];
    adcgs_store_le32(le, value);
    put(b, le, 4);
}

static inline void put_real(made_file *b, double value)
{
    put32(b, adcgs_float_bits((float)value));
}

static inline adcgs_status parse(adcgs_splats *s, made_file *b)
{
    b->data[b->n] = 0;
    return adcgs_splats_parse(s, b->data, b->n, "file", &error);
}

static inline adcgs_splats open_splats(const char *path)
{
    adcgs_splats s;
    assert_true(adcgs_splats_is(path));
    expect_good(adcgs_splats_read(&s, path, &error));
    assert_int_equal(s.axes, ADCGS_SPLATS_UP_UNKNOWN);
    return s;
}

/** Compares a sample with an answer of expected.json; rows are indices. */
static inline void expect_state(const char *path, const char *name, size_t answer, const tolerance *most)
{
    adcgs_splats s = open_splats(real_data(path));
    json_t *root, *const answers = json_object_get(expected(&root, name), "answers");
    const json_t *const splats = json_object_get(json_array_get(answers, answer), "splats");
    assert_int_equal(s.n, 2000);
    assert_true(json_array_size(splats) >= 5);
    for (size_t i = 0; i < json_array_size(splats); i++) {
        const json_t *const splat = json_array_get(splats, i);
        expect_splat(&s, (uint32_t)json_integer_value(json_object_get(splat, "index")), splat, most);
    }
    json_decref(root);
    adcgs_splats_free(&s);
}

#endif

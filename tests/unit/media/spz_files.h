/* SPDX-License-Identifier: BSD-2-Clause */
/** \file SPZ files of old versions, made byte by byte, and comparison of splats within the format's steps. */
#ifndef ADCGS_TESTS_SPZ_FILES_H
#define ADCGS_TESTS_SPZ_FILES_H

#include "random_splats.h"

#include <math.h>
#include <zlib.h>

#define SQRT_HALF 0.70710678118654752

/** Twice the rounding of a component, and its consequence for the one that follows from the others. */
static inline void near_rotation(const adcgs_splats *a, const adcgs_splats *b, uint32_t i)
{
    double dot = 0.0;
    for (int c = 0; c < 4; c++)
        dot += (double)a->rotation[c][i] * (double)b->rotation[c][i];
    for (int c = 0; c < 4; c++)
        near(a->rotation[c][i], (dot < 0.0 ? -1.0f : 1.0f) * b->rotation[c][i], 0.0, 3.0 * SQRT_HALF / 1022 + 1e-6);
}

/** Expects b to equal the splats written with this many fractional bits. */
static inline void near_splats(const adcgs_splats *a, const adcgs_splats *b, int bits)
{
    assert_int_equal(a->n, b->n);
    for (uint32_t i = 0; i < a->n; i++) {
        near(a->opacity[i], b->opacity[i], 0.0, 0.5 / 255 + 1e-6);
        for (int c = 0; c < 3; c++) {
            near(a->mean[c][i], b->mean[c][i], 1e-7, ldexp(0.5, -bits));
            near(a->scale[c][i], b->scale[c][i], exp(0.5 / 16) - 1 + 1e-5, 0.0);
            near(a->colour[c][i], b->colour[c][i], 0.0, 0.5 / 255 / 0.15 * ADCGS_SPLATS_DC + 1e-6);
        }
        near_rotation(a, b, i);
    }
}

static inline adcgs_status write_version(const adcgs_splats *s, int version, const char *path)
{
    return adcgs_splats_write(s, &(adcgs_splats_style){.comment = "here", .spz_version = version}, path, &error);
}

/** Expects the same splats, read from files of the versions 2 to 4, except for the coarser rotations of version 2. */
static inline void expect_versions(const adcgs_splats *two, const adcgs_splats *three, const adcgs_splats *four,
                                   const adcgs_splats *s)
{
    for (uint32_t i = 0; i < s->n; i++) {
        for (int a = 0; a < 3; a++) {
            assert_true(three->mean[a][i] == four->mean[a][i] && two->mean[a][i] == four->mean[a][i]);
            assert_true(two->scale[a][i] == four->scale[a][i] && two->colour[a][i] == four->colour[a][i]);
        }
        assert_true(two->opacity[i] == four->opacity[i]);
        const float sign = s->rotation[0][i] < 0.0f ? -1.0f : 1.0f;
        for (int a = 0; a < 4; a++) {
            assert_true(three->rotation[a][i] == four->rotation[a][i]);
            near(two->rotation[a][i], sign * s->rotation[a][i], 0.0, a ? 0.012 : 0.12);
        }
    }
}

/** Writes a file packed by gzip. */
static inline size_t put_gzip(const char *name, const uint8_t *raw, size_t bytes)
{
    uint8_t packed[4096];
    z_stream z = {.next_in = (Bytef *)(uintptr_t)raw, .avail_in = (uInt)bytes, .next_out = packed, .avail_out = sizeof packed};
    assert_int_equal(deflateInit2(&z, 6, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY), Z_OK);
    assert_int_equal(deflate(&z, Z_FINISH), Z_STREAM_END);
    deflateEnd(&z);
    put_bytes(name, packed, sizeof packed - z.avail_out);
    return sizeof packed - z.avail_out;
}

/** Two splats with harmonics of degree 1. \return number of bytes. */
static inline size_t make_old(uint8_t *to, int version)
{
    static const uint8_t head[] = {'N', 'G', 'S', 'P', 0, 0, 0, 0, 2, 0, 0, 0, 1, 12, 0, 0};
    static const uint8_t start[] = {0,    0x10, 0,    0, 0xf0, 0xff, 1, 0, 0, /* 1, -1, 2^-12 */
                                    0xff, 0xff, 0x7f, 0, 0,    0x80, 0, 0, 0, /* 2048 - 2^-12, -2048, 0 */
                                    0,    255,  127,  0, 255,  128,  1, 2, 160, 0, 255, 80, 90, 100};
    static const uint8_t of_three[] = {255, 127, 128, 0, 128, 128};
    static const uint8_t of_four[] = {0, 0, 0, 0xc0, 0xff, 0x01, 0x00, 0x40};
    size_t n = 0;
    memcpy(to, head, sizeof head);
    to[4] = (uint8_t)version;
    n += sizeof head;
    memcpy(to + n, start, sizeof start);
    n += sizeof start;
    memcpy(to + n, version == 2 ? of_three : of_four, version == 2 ? sizeof of_three : sizeof of_four);
    n += version == 2 ? sizeof of_three : sizeof of_four;
    for (int i = 0; i < 18; i++)
        to[n++] = (uint8_t)(i < 9 ? 128 + i : 14 * i);
    return n;
}

#endif

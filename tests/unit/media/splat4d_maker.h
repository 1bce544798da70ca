/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Makes small .splat4d files in which every attribute of some splats changes. */
#ifndef ADCGS_TESTS_MEDIA_SPLAT4D_MAKER_H
#define ADCGS_TESTS_MEDIA_SPLAT4D_MAKER_H

#include "outside_files.h"

#include <zstd.h>

enum { MADE_N = 11, MADE_FRAMES = 5, MADE_GROUP = 2, MADE_ROOM = 16384 };

static const int made_channels[5] = {3, 4, 3, 1, 3};
static const char *const made_header =
    "{\"n\":11,\"t\":5,\"fps\":29.97,\"gop\":2,\"steps\":{\"pos\":0.5,\"base_pos\":0.25,\"scale_log\":0.5,"
    "\"base_scale_log\":0.25,"
    "\"rgb\":9,\"alpha\":5,\"rot\":3},\"static_section\":{\"offset\":%u,\"len\":%u},\"gops\":[{\"offset\":%u,\"len\":%u,\"f0\":0,"
    "\"f1\":1},{\"offset\":%u,\"len\":%u,\"f0\":2,\"f1\":3},{\"offset\":%u,\"len\":%u,\"f0\":4,\"f1\":4}]}";

/** Attribute a of splat i changes if its number is a multiple of a + 2. */
static inline int made_moves(int a, int i)
{
    return i % (a + 2) == 0;
}

/** Bin of component c in a frame. */
static inline int made_bin(int a, int i, int c, int frame)
{
    return a == 1   ? (c == i % 4 ? 42 : 0) + (c == (i + 1) % 4 ? 4 * frame : 0)
           : a == 4 ? frame - c - 1
                    : 3 * i + c - 200 * (a == 0) * frame + frame;
}

/** Bin of component c in the static section. */
static inline int made_base(int a, int i, int c)
{
    return a == 1 ? 128 + (c == i % 4 ? -127 : 0) : a == 0 ? 7 * i - 3 * c : a == 4 ? c - i % 3 : 20 * i + c;
}

/** A stream's header and data: symbols of `width` bytes in planes. */
static inline size_t put_symbols(uint8_t *header, uint8_t *data, int attribute, int kind, int width, const uint32_t *symbols,
                                 uint32_t n)
{
    uint8_t planes[4096];
    for (uint32_t i = 0; i < n; i++)
        for (uint32_t j = 0; j < (uint32_t)width; j++)
            planes[j * n + i] = (uint8_t)(symbols[i] >> 8 * j);
    const size_t bytes = ZSTD_compress(data, MADE_ROOM, planes, n * (uint32_t)width, 1);
    header[0] = (uint8_t)attribute;
    header[1] = (uint8_t)kind;
    header[2] = (uint8_t)width;
    adcgs_store_le32(header + 3, n);
    adcgs_store_le32(header + 7, (uint32_t)bytes);
    return bytes;
}

static inline uint32_t fold(int v)
{
    return (uint32_t)v << 1 ^ (v < 0 ? UINT32_MAX : 0);
}

static inline size_t put_static_section(uint8_t *out)
{
    static const int order[5] = {0, 4, 2, 3, 1};
    uint32_t symbols[256];
    size_t at = 0;
    for (int a = 0; a < 5; a++) {
        memset(symbols, 0, sizeof symbols);
        for (int i = 0; i < MADE_N; i++)
            symbols[i / 8] |= (uint32_t)!made_moves(a, i) << (7 - i % 8);
        at += 11 + put_symbols(out + at, out + at + 11, a, 2, 1, symbols, (MADE_N + 7) / 8);
    }
    for (int k = 0; k < 5; k++) {
        const int a = order[k], n = made_channels[a], folded = a == 0 || a == 4;
        for (int i = 0; i < MADE_N; i++)
            for (int c = 0; c < n; c++)
                symbols[i * n + c] =
                    folded ? fold(made_base(a, i, c) - (i ? made_base(a, i - 1, c) : 0)) : (uint32_t)made_base(a, i, c);
        at += 11 + put_symbols(out + at, out + at + 11, a, 2, folded ? 2 : 1, symbols, (uint32_t)(MADE_N * n));
    }
    return at;
}

/** Frames first to last, in one chunk; widths of symbols differ. */
static inline size_t put_group(uint8_t *out, int first, int last)
{
    const int streams = last > first ? 10 : 5;
    size_t at = 2 + 11 * (size_t)streams;
    adcgs_store_le16(out, (uint16_t)streams);
    for (int s = 0; s < streams; s++) {
        const int a = s % 5, kind = s / 5;
        uint32_t symbols[512], n = 0;
        for (int f = first + kind; f <= (kind ? last : first); f++)
            for (int i = 0; i < MADE_N; i++)
                for (int c = 0; made_moves(a, i) && c < made_channels[a]; c++)
                    symbols[n++] = fold(made_bin(a, i, c, f) - (kind ? made_bin(a, i, c, f - 1) : 0));
        at += put_symbols(out + 2 + 11 * s, out + at, a, kind, a ? 1 + kind : 4, symbols, n);
    }
    return at;
}

/** \return bytes of the file */
static inline size_t make_splat4d(uint8_t out[MADE_ROOM])
{
    uint8_t parts[4][MADE_ROOM];
    uint32_t sizes[4], places[4], at;
    char text[1024];
    sizes[0] = (uint32_t)put_static_section(parts[0]);
    for (int g = 0; g < 3; g++)
        sizes[g + 1] = (uint32_t)put_group(parts[g + 1], MADE_GROUP * g, g < 2 ? MADE_GROUP * g + 1 : MADE_FRAMES - 1);
    at = 12 + 512; /* the header is padded with blanks */
    for (int k = 0; k < 4; at += sizes[k++])
        places[k] = at;
    memset(text, ' ', sizeof text);
    const int n = snprintf(text, sizeof text, made_header, places[0], sizes[0], places[1], sizes[1], places[2], sizes[2],
                           places[3], sizes[3]);
    assert_true(n < 512);
    text[n] = ' ';
    memcpy(out, "SP4D\1\0\0", 8);
    adcgs_store_le32(out + 8, 512);
    memcpy(out + 12, text, 512);
    for (int k = 0; k < 4; k++)
        memcpy(out + places[k], parts[k], sizes[k]);
    return at;
}

#endif

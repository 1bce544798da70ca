/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Body of the binning kernel. The part of the ellipse alpha >= 1/255 within a
 * row of 4x4 blocks is convex, so the blocks it touches are those between its
 * leftmost and rightmost points; these are found for sixteen block rows at once.
 */
#include "render/raster_isa.h"

#include <stdalign.h>

typedef struct block_rows {
    alignas(64) int32_t begin[16], end[16]; /* touched blocks of each block row, in blocks from the image's left edge */
} block_rows;

static const alignas(64) float row_centre[16] = {0.5f,  4.5f,  8.5f,  12.5f, 16.5f, 20.5f, 24.5f, 28.5f,
                                                 32.5f, 36.5f, 40.5f, 44.5f, 48.5f, 52.5f, 56.5f, 60.5f};

/* Block rows 4*tile_y .. 4*tile_y + 15. */
static inline void find_rows(block_rows *rows, const adcgs_splat2d *s, const adcgs_outline *o, int tile_y, float blocks)
{
    const vf zero = vf_set1(0.0f), ym = vf_set1(o->ym), y_right = vf_set1(o->y_right), y_left = vf_set1(-o->y_right);
    const vf top = vf_sub(vf_add(vf_load(row_centre), vf_set1(16.0f * (float)tile_y)), vf_set1(s->y));
    const vf bottom = vf_add(top, vf_set1(3.0f));
    const vm touched = vf_ge(ym, vf_max(top, vf_sub(zero, bottom)));
    const vf dy_right = vf_min(vf_max(y_right, top), bottom), dy_left = vf_min(vf_max(y_left, top), bottom);
    const vf yy = vf_mul(ym, ym), slope = vf_set1(o->slope), width = vf_set1(o->width);
    const vf reach_right = vf_sqrt(vf_max(vf_fnma(dy_right, dy_right, yy), zero));
    const vf reach_left = vf_sqrt(vf_max(vf_fnma(dy_left, dy_left, yy), zero));
    const vf right = vf_fma(width, reach_right, vf_mul(slope, dy_right));
    const vf left = vf_fnma(width, reach_left, vf_mul(slope, dy_left));
    const vf size = vf_max(vf_abs(left), vf_abs(right));
    const vf slack = vf_fma(vf_add(size, vf_set1(fabsf(s->x))), vf_set1(0x1p-20f), vf_set1(0x1p-5f));
    const vf begin = vf_mul(vf_add(vf_sub(left, slack), vf_set1(s->x + 0.5f)), vf_set1(0.25f));
    const vf end = vf_mul(vf_add(vf_add(right, slack), vf_set1(s->x + 3.5f)), vf_set1(0.25f));
    vf_store_int(rows->begin, vf_min(vf_max(begin, zero), vf_set1(blocks)));
    vf_store_int(rows->end, vf_only(touched, vf_min(vf_max(end, zero), vf_set1(blocks))));
}

/* Bits [begin, end) of 64, counted from base. */
static inline uint64_t row_bits(int32_t begin, int32_t end, int32_t base)
{
    const int32_t b = begin - base < 0 ? 0 : begin - base, e = end - base > 64 ? 64 : end - base;
    return e > b ? (~(uint64_t)0 >> (64 - (e - b))) << b : 0;
}

/* One row of tiles, sixteen tiles at a time. */
static inline uint32_t bin_row(const block_rows *rows, int r, uint64_t item, int x0, int x1, uint32_t *counts, uint64_t *out)
{
    uint32_t n = 0;
    for (int x = x0; x < x1; x += 16) {
        uint64_t bits[4];
        for (int j = 0; j < 4; j++)
            bits[j] = row_bits(rows->begin[r + j], rows->end[r + j], 4 * x);
        const int tiles = x1 - x < 16 ? x1 - x : 16;
        for (int t = 0; t < tiles; t++) {
            const int s = 4 * t;
            const uint64_t mask = (bits[0] >> s & 15) | (bits[1] >> s & 15) << 4 | (bits[2] >> s & 15) << 8 | (bits[3] >> s & 15) << 12;
            out[n] = item + ((uint64_t)(x + t) << 16) + mask;
            counts[x + t] += mask != 0;
            n += mask != 0;
        }
    }
    return n;
}

static uint32_t bin(const adcgs_splat2d *splat, const adcgs_outline *outline, uint32_t index, int tiles_x, uint32_t *counts,
                    uint64_t *out)
{
    uint32_t n = 0;
    for (int y = splat->tile[1]; y < splat->tile[3]; y += 4) {
        block_rows rows;
        find_rows(&rows, splat, outline, y, 4.0f * (float)tiles_x);
        for (int r = 0; r < 4 && y + r < splat->tile[3]; r++) {
            const size_t line = (size_t)(y + r) * (size_t)tiles_x;
            n += bin_row(&rows, 4 * r, (uint64_t)index << 36 | (uint64_t)line << 16, splat->tile[0], splat->tile[2], counts + line, out + n);
        }
    }
    return n;
}

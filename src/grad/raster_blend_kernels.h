/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Body of the backward blend. A tile's splats are visited front to back, as in the forward pass. Each pixel keeps its
 * transmittance and the product of the gradient and the contribution of the splats still to come.
 */
#include "grad/raster_backward_isa.h"
#include "render/alpha.h"

/* Prefetch distance of splats and their sums, in entries; chosen by hand, not measured. */
#define FETCH_ENTRIES 8

typedef struct tile_state {
    alignas(64) float t[16][16];        /* transmittance before the next splat */
    alignas(64) float alpha[2][16][16]; /* opacities of the current and the next splat */
    alignas(64) float behind[16][16];   /* gradient times (final colour - colour so far) */
    alignas(64) float grad[16][3][16];
    alignas(64) float x[16], y[16]; /* left and top edges of the blocks */
    uint32_t alive;                 /* blocks with remaining transmittance */
} tile_state;

/* Loads the pixels of a block from a plane of the image; pixels outside are 0. */
LANES_INLINE vf load_pixels(const float *plane, int x, int y, int width, int height)
{
    const float *at = plane + (size_t)y * (size_t)width + (size_t)x;
    if (x + 4 <= width && y + 4 <= height)
        return vf_load_rows(at, (size_t)width);
    alignas(64) float v[16] = {0.0f};
    for (int j = 0; j < 4 && y + j < height; j++)
        for (int i = 0; i < 4 && x + i < width; i++)
            v[4 * j + i] = at[(size_t)j * (size_t)width + (size_t)i];
    return vf_load(v);
}

static void start_block(tile_state *s, const adcgs_back_job *job, int block, int x, int y)
{
    const int width = job->view->width, height = job->view->height;
    const size_t plane = (size_t)width * (size_t)height;
    vf behind = vf_set1(0.0f);
    s->x[block] = (float)x;
    s->y[block] = (float)y;
    if (x >= width || y >= height)
        return;
    for (size_t c = 0; c < 3; c++) {
        const vf grad = load_pixels(job->grad + c * plane, x, y, width, height);
        behind = vf_fma(grad, load_pixels(job->rgb + c * plane, x, y, width, height), behind);
        vf_store(s->grad[block][c], grad);
    }
    vf_store(s->behind[block], behind);
    vf_store(s->t[block], initial_transmittance(x, y, width, height));
    s->alive |= (uint32_t)1 << block;
}

/* Passes a block through a splat: adds to the colours' sums and updates the transmittance. Returns alpha * dL/dalpha. */
LANES_INLINE vf pass_block(tile_state *s, uint32_t turn, const adcgs_splat2d *g, int block, vf sum[12])
{
    const vf red = vf_load(s->grad[block][0]), green = vf_load(s->grad[block][1]), blue = vf_load(s->grad[block][2]);
    const vf t = vf_load(s->t[block]), alpha = vf_load(s->alpha[turn][block]), weight = vf_mul(alpha, t);
    const vf toward = vf_fma(vf_set1(g->rgb[2]), blue, vf_fma(vf_set1(g->rgb[1]), green, vf_mul(vf_set1(g->rgb[0]), red)));
    const vf behind = vf_fnma(weight, toward, vf_load(s->behind[block])), through = vf_fnma(alpha, t, t);
    sum[8] = vf_fma(weight, red, sum[8]);
    sum[9] = vf_fma(weight, green, sum[9]);
    sum[10] = vf_fma(weight, blue, sum[10]);
    sum[3] = vf_add(sum[3], weight);
    vf_store(s->t[block], through);
    vf_store(s->behind[block], behind);
    if (!vm_any(vf_ge(through, vf_set1(ADCGS_T_MIN))))
        s->alive &= ~((uint32_t)1 << block);
    return vf_mul(alpha, vf_sub(vf_mul(t, toward), vf_div(behind, vf_sub(vf_set1(1.0f), alpha))));
}

/* Offsets of the blocks of a tile from a splat's centre, and their products. */
typedef struct block_offsets {
    alignas(64) float x[16], y[16], xx[16], xy[16], yy[16];
} block_offsets;

LANES_INLINE void find_offsets(block_offsets *o, const tile_state *s, const adcgs_splat2d *g)
{
    const vf x = vf_sub(vf_load(s->x), vf_set1(g->x)), y = vf_sub(vf_load(s->y), vf_set1(g->y));
    vf_store(o->x, x);
    vf_store(o->y, y);
    vf_store(o->xx, vf_mul(x, x));
    vf_store(o->xy, vf_mul(x, y));
    vf_store(o->yy, vf_mul(y, y));
}

/* Moments of e as if it were concentrated at the block's corner; move_moments() corrects this for all blocks at once. */
LANES_INLINE void add_moments(vf sum[12], vf e, const block_offsets *o, int block)
{
    sum[0] = vf_add(sum[0], e);
    sum[1] = vf_fma(vf_set1(o->x[block]), e, sum[1]);
    sum[2] = vf_fma(vf_set1(o->y[block]), e, sum[2]);
    sum[4] = vf_fma(vf_set1(o->xx[block]), e, sum[4]);
    sum[5] = vf_fma(vf_set1(o->xy[block]), e, sum[5]);
    sum[6] = vf_fma(vf_set1(o->yy[block]), e, sum[6]);
}

LANES_INLINE void move_moments(vf sum[12])
{
    const vf px = vf_load(pixel_x), py = vf_load(pixel_y);
    const vf x = vf_fma(px, sum[0], sum[1]), y = vf_fma(py, sum[0], sum[2]);
    sum[4] = vf_fma(px, vf_add(sum[1], x), sum[4]);
    sum[5] = vf_fma(py, sum[1], vf_fma(px, y, sum[5]));
    sum[6] = vf_fma(py, vf_add(sum[2], y), sum[6]);
    sum[1] = x;
    sum[2] = y;
}

LANES_INLINE void add_screen(vf sum[12], const adcgs_splat2d *g, vf e, const block_offsets *o, int block)
{
    const vf ex = vf_mul(e, vf_add(vf_load(pixel_x), vf_set1(o->x[block])));
    const vf ey = vf_mul(e, vf_add(vf_load(pixel_y), vf_set1(o->y[block]))), b = vf_set1(g->b);
    sum[7] = vf_add(sum[7], vf_abs(vf_fma(vf_set1(2.0f * g->a), ex, vf_mul(b, ey))));
    sum[11] = vf_add(sum[11], vf_abs(vf_fma(vf_set1(2.0f * g->c), ey, vf_mul(b, ex))));
}

/*
 * Opacities of an entry's blocks with remaining transmittance, one entry ahead of their use. They are computed separately,
 * because they do not depend on other results. In one loop with the rest, the processor would wait at the end of a long
 * dependency chain.
 */
static inline void alpha_entry(tile_state *s, const adcgs_back_job *job, uint32_t i)
{
    const adcgs_tile_entry entry = job->kept.entries[i];
    const adcgs_splat2d *g = job->kept.splats + entry.splat;
    const uint32_t mask = entry.mask & s->alive;
    float(*const alpha)[16] = s->alpha[i & 1];
    for (uint32_t left = mask; left; left &= left - 1) {
        const int block = __builtin_ctz(left);
        const vf px = vf_add(vf_load(pixel_x), vf_set1(s->x[block])), py = vf_add(vf_load(pixel_y), vf_set1(s->y[block]));
        vf_store(alpha[block], splat_power(g, vf_sub(px, vf_set1(g->x)), vf_sub(py, vf_set1(g->y))));
    }
    for (uint32_t left = mask; left; left &= left - 1) {
        float *const at = alpha[__builtin_ctz(left)];
        vf_store(at, alpha_of_power(vf_load(at)));
    }
}

/* The sums of colours and of moments fit into AVX registers only one after the other. */
LANES_INLINE void sum_blocks(tile_state *s, uint32_t turn, const adcgs_splat2d *g, uint32_t mask, int screen, vf sum[12])
{
    block_offsets offsets;
    alignas(64) float e[16][16];
    find_offsets(&offsets, s, g);
    for (uint32_t left = mask; left; left &= left - 1) {
        const int block = __builtin_ctz(left);
        vf_store(e[block], pass_block(s, turn, g, block, sum));
    }
    for (uint32_t left = mask; left; left &= left - 1)
        add_moments(sum, vf_load(e[__builtin_ctz(left)]), &offsets, __builtin_ctz(left));
    move_moments(sum);
    for (uint32_t left = screen ? mask : 0; left; left &= left - 1)
        add_screen(sum, g, vf_load(e[__builtin_ctz(left)]), &offsets, __builtin_ctz(left));
}

LANES_INLINE void back_entry(tile_state *s, const adcgs_back_job *job, uint32_t i, int screen, float *sums)
{
    const vf zero = vf_set1(0.0f);
    const adcgs_tile_entry entry = job->kept.entries[i];
    vf sum[12] = {zero, zero, zero, zero, zero, zero, zero, zero, zero, zero, zero, zero};
    sum_blocks(s, i & 1, job->kept.splats + entry.splat, entry.mask & s->alive, screen, sum);
    vf_sums(sums, sum);
}

LANES_INLINE void back_tile(const adcgs_back_job *job, int tile, int screen)
{
    tile_state s;
    const int tile_x = tile % job->kept.tiles_x * ADCGS_TILE, tile_y = tile / job->kept.tiles_x * ADCGS_TILE;
    const uint32_t begin = job->kept.tile_start[tile], end = job->kept.tile_start[tile + 1];
    s.alive = 0;
    for (int block = 0; block < 16; block++)
        start_block(&s, job, block, tile_x + 4 * (block & 3), tile_y + 4 * (block >> 2));
    if (begin < end)
        alpha_entry(&s, job, begin);
    for (uint32_t i = begin; i < end; i++) {
        float *sums = job->sums + (size_t)job->kept.place[i] * SUM_WORDS;
        const uint32_t ahead = i + FETCH_ENTRIES < end ? i + FETCH_ENTRIES : i;
        __builtin_prefetch(job->kept.splats + job->kept.entries[ahead].splat);
        __builtin_prefetch(job->sums + (size_t)job->kept.place[ahead] * SUM_WORDS, 1);
        if (i + 1 < end)
            alpha_entry(&s, job, i + 1);
        if (job->kept.entries[i].mask & s.alive)
            back_entry(&s, job, i, screen, sums);
        else
            vf_store(sums, vf_set1(0.0f));
    }
}

static void blend_back(const adcgs_back_job *job, int tile)
{
    if (job->out.screen)
        back_tile(job, tile, 1);
    else
        back_tile(job, tile, 0);
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Body of the backward blend. A tile's splats are walked front to back, as the
 * forward pass did; each pixel keeps its transmittance and one more number, the
 * product of the gradient and what the splats still to come contribute.
 */
#include "render/alpha.h"
#include "train/raster_isa.h"

/* How far ahead splats and places of sums are fetched. */
#define FETCH_ENTRIES 8

typedef struct tile_state {
    alignas(64) float t[16][16];      /* transmittance before the next splat */
    alignas(64) float alpha[2][16][16]; /* opacities of the splats at hand and next */
    alignas(64) float behind[16][16]; /* gradient times (final colour - colour so far) */
    alignas(64) float grad[16][3][16];
    alignas(64) float x[16][16], y[16][16];
    uint32_t alive; /* blocks with light left */
} tile_state;

/* The pixels of a block from a plane of the image; those outside are 0. */
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
    if (x >= width || y >= height)
        return;
    for (size_t c = 0; c < 3; c++) {
        const vf grad = load_pixels(job->grad + c * plane, x, y, width, height);
        behind = vf_fma(grad, load_pixels(job->rgb + c * plane, x, y, width, height), behind);
        vf_store(s->grad[block][c], grad);
    }
    vf_store(s->behind[block], behind);
    vf_store(s->t[block], initial_transmittance(x, y, width, height));
    vf_store(s->x[block], vf_add(vf_load(pixel_x), vf_set1((float)x)));
    vf_store(s->y[block], vf_add(vf_load(pixel_y), vf_set1((float)y)));
    s->alive |= (uint32_t)1 << block;
}

/*
 * A splat's opacity in each of its blocks comes first and on its own, since nothing there waits for anything: in one loop with
 * the rest the processor would spend its time waiting at the end of a long chain.
 */
LANES_INLINE void alpha_block(tile_state *s, uint32_t turn, const adcgs_splat2d *g, int block)
{
    const vf dx = vf_sub(vf_load(s->x[block]), vf_set1(g->x)), dy = vf_sub(vf_load(s->y[block]), vf_set1(g->y));
    vf_store(s->alpha[turn][block], splat_alpha(g, dx, dy));
}

/* A splat in a block: e = alpha * dL/dalpha, weight = alpha * T, and the pixels' offsets from its centre. */
typedef struct passage {
    vf e, weight, dx, dy;
} passage;

/* Light of a block passes a splat; returns whether any is left. */
LANES_INLINE int pass_block(tile_state *s, uint32_t turn, const adcgs_splat2d *g, int block, passage *p)
{
    const vf red = vf_load(s->grad[block][0]), green = vf_load(s->grad[block][1]), blue = vf_load(s->grad[block][2]);
    const vf t = vf_load(s->t[block]), alpha = vf_load(s->alpha[turn][block]), weight = vf_mul(alpha, t);
    const vf toward = vf_fma(vf_set1(g->rgb[2]), blue, vf_fma(vf_set1(g->rgb[1]), green, vf_mul(vf_set1(g->rgb[0]), red)));
    const vf behind = vf_fnma(weight, toward, vf_load(s->behind[block]));
    const vf through = vf_fnma(alpha, t, t);
    p->e = vf_mul(alpha, vf_sub(vf_mul(t, toward), vf_div(behind, vf_sub(vf_set1(1.0f), alpha))));
    p->weight = weight;
    p->dx = vf_sub(vf_load(s->x[block]), vf_set1(g->x));
    p->dy = vf_sub(vf_load(s->y[block]), vf_set1(g->y));
    vf_store(s->t[block], through);
    vf_store(s->behind[block], behind);
    return vm_any(vf_ge(through, vf_set1(ADCGS_T_MIN)));
}

LANES_INLINE void add_moments(vf sum[12], vf e, vf dx, vf dy)
{
    const vf ex = vf_mul(e, dx), ey = vf_mul(e, dy);
    sum[0] = vf_add(sum[0], e);
    sum[1] = vf_add(sum[1], ex);
    sum[2] = vf_add(sum[2], ey);
    sum[4] = vf_fma(ex, dx, sum[4]);
    sum[5] = vf_fma(ex, dy, sum[5]);
    sum[6] = vf_fma(ey, dy, sum[6]);
}

LANES_INLINE void add_colours(vf sum[12], vf weight, const float grad[3][16])
{
    sum[8] = vf_fma(weight, vf_load(grad[0]), sum[8]);
    sum[9] = vf_fma(weight, vf_load(grad[1]), sum[9]);
    sum[10] = vf_fma(weight, vf_load(grad[2]), sum[10]);
    sum[3] = vf_add(sum[3], weight);
}

LANES_INLINE void add_screen(vf sum[12], const adcgs_splat2d *g, vf e, vf dx, vf dy)
{
    const vf ex = vf_mul(e, dx), ey = vf_mul(e, dy), b = vf_set1(g->b);
    sum[7] = vf_add(sum[7], vf_abs(vf_fma(vf_set1(2.0f * g->a), ex, vf_mul(b, ey))));
    sum[11] = vf_add(sum[11], vf_abs(vf_fma(vf_set1(2.0f * g->c), ey, vf_mul(b, ex))));
}

/* The opacities of an entry's blocks that have light, one entry ahead of their use. */
static inline void alpha_entry(tile_state *s, const adcgs_back_job *job, uint32_t i)
{
    const adcgs_tile_entry entry = job->kept.entries[i];
    const adcgs_splat2d *g = job->kept.splats + entry.splat;
    for (uint32_t left = entry.mask & s->alive; left; left &= left - 1)
        alpha_block(s, i & 1, g, __builtin_ctz(left));
}

#if ADCGS_LANES_ISA == 512
/* All sums fit into registers. */
LANES_INLINE void sum_blocks(tile_state *s, uint32_t turn, const adcgs_splat2d *g, uint32_t mask, int screen, vf sum[12])
{
    for (uint32_t left = mask; left; left &= left - 1) {
        const int block = __builtin_ctz(left);
        passage p;
        if (!pass_block(s, turn, g, block, &p))
            s->alive &= ~((uint32_t)1 << block);
        add_moments(sum, p.e, p.dx, p.dy);
        add_colours(sum, p.weight, s->grad[block]);
        if (screen)
            add_screen(sum, g, p.e, p.dx, p.dy);
    }
}
#else
/* Half of the sums fit into registers: what they are made of is kept, and gone through for each half. */
LANES_INLINE void sum_blocks(tile_state *s, uint32_t turn, const adcgs_splat2d *g, uint32_t mask, int screen, vf sum[12])
{
    passage kept[16];
    uint8_t blocks[16];
    int n = 0;
    for (uint32_t left = mask; left; left &= left - 1) {
        const int block = __builtin_ctz(left);
        if (!pass_block(s, turn, g, block, &kept[n]))
            s->alive &= ~((uint32_t)1 << block);
        blocks[n++] = (uint8_t)block;
    }
    for (int i = 0; i < n; i++)
        add_moments(sum, kept[i].e, kept[i].dx, kept[i].dy);
    for (int i = 0; i < n; i++) {
        add_colours(sum, kept[i].weight, s->grad[blocks[i]]);
        if (screen)
            add_screen(sum, g, kept[i].e, kept[i].dx, kept[i].dy);
    }
}
#endif

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

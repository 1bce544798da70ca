/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Body of the baseline's kernels. A tile has sixteen rows of sixteen lanes. Needs lanes.h. */
#include "plain.h"

#include "render/alpha.h"

static const alignas(64) float columns[16] = {0.5f, 1.5f, 2.5f,  3.5f,  4.5f,  5.5f,  6.5f,  7.5f,
                                              8.5f, 9.5f, 10.5f, 11.5f, 12.5f, 13.5f, 14.5f, 15.5f};

/* Position of a tile, and its rows and columns that lie inside the image. */
static void tile_rect(const plain_job *job, int tile, int rect[4])
{
    rect[0] = tile % job->tiles_x * 16;
    rect[1] = tile / job->tiles_x * 16;
    rect[2] = ADCGS_MIN(16, job->width - rect[0]);
    rect[3] = ADCGS_MIN(16, job->height - rect[1]);
}

static void read_row(const plain_job *job, const float *planes, const int rect[4], int row, vf rgb[3])
{
    for (size_t c = 0; c < 3; c++) {
        alignas(64) float v[16] = {0.0f};
        const float *from = planes + (c * (size_t)job->height + (size_t)(rect[1] + row)) * (size_t)job->width + rect[0];
        memcpy(v, from, (size_t)rect[2] * sizeof *v);
        rgb[c] = vf_load(v);
    }
}

static void write_row(const plain_job *job, const int rect[4], int row, vf t, const vf rgb[3])
{
    for (size_t c = 0; c < 3; c++) {
        alignas(64) float v[16];
        float *to = job->rgb + (c * (size_t)job->height + (size_t)(rect[1] + row)) * (size_t)job->width + rect[0];
        vf_store(v, vf_fma(t, vf_set1(job->background[c]), rgb[c]));
        memcpy(to, v, (size_t)rect[2] * sizeof *v);
    }
}

static void blend(const plain_job *job, int tile)
{
    plain_tile *out = job->tiles + tile;
    const uint32_t *list = job->list + job->start[tile], n = job->start[tile + 1] - job->start[tile];
    int rect[4];
    uint32_t alive = 0;
    vf t[16], rgb[16][3];
    tile_rect(job, tile, rect);
    const vf px = vf_add(vf_load(columns), vf_set1((float)rect[0])), zero = vf_set1(0.0f);
    for (int row = 0; row < rect[3]; row++) {
        t[row] = vf_only(vf_ge(vf_set1((float)rect[2]), vf_load(columns)), vf_set1(1.0f));
        rgb[row][0] = rgb[row][1] = rgb[row][2] = zero;
        out->end[row] = n;
        alive |= (uint32_t)1 << row;
    }
    for (uint32_t i = 0; i < n && alive; i++) {
        const adcgs_splat2d *s = job->splats + list[i];
        const vf dx = vf_sub(px, vf_set1(s->x));
        for (uint32_t left = alive; left; left &= left - 1) {
            const int row = __builtin_ctz(left);
            const vf dy = vf_set1((float)(rect[1] + row) + 0.5f - s->y);
            const vf alpha = alpha_of_power(splat_power(s, dx, dy)), weight = vf_mul(alpha, t[row]);
            for (int c = 0; c < 3; c++)
                rgb[row][c] = vf_fma(vf_set1(s->rgb[c]), weight, rgb[row][c]);
            t[row] = vf_fnma(alpha, t[row], t[row]);
            if (!vm_any(vf_ge(t[row], vf_set1(ADCGS_T_MIN)))) {
                alive &= ~((uint32_t)1 << row);
                out->end[row] = i + 1;
            }
        }
    }
    for (int row = 0; row < rect[3]; row++) {
        write_row(job, rect, row, t[row], rgb[row]);
        vf_store(out->t[row], t[row]);
    }
}

/* State of a row of a tile, from back to front. */
typedef struct row_state {
    vf t, grad[3];
    vf behind; /* gradient times the colour from behind, per unit of light */
} row_state;

LANES_INLINE void back_row(row_state *r, const adcgs_splat2d *s, vf dx, vf dy, vf sum[12])
{
    const vf alpha = alpha_of_power(splat_power(s, dx, dy)), through = vf_sub(vf_set1(1.0f), alpha);
    r->t = vf_div(r->t, through);
    const vf weight = vf_mul(alpha, r->t);
    vf own = vf_mul(vf_set1(s->rgb[0]), r->grad[0]);
    own = vf_fma(vf_set1(s->rgb[1]), r->grad[1], own);
    own = vf_fma(vf_set1(s->rgb[2]), r->grad[2], own);
    const vf e = vf_mul(weight, vf_sub(own, r->behind)), ex = vf_mul(e, dx), ey = vf_mul(e, dy), b = vf_set1(s->b);
    r->behind = vf_fma(alpha, own, vf_mul(through, r->behind));
    sum[0] = vf_add(sum[0], e);
    sum[1] = vf_add(sum[1], ex);
    sum[2] = vf_add(sum[2], ey);
    sum[3] = vf_add(sum[3], weight);
    sum[4] = vf_fma(ex, dx, sum[4]);
    sum[5] = vf_fma(ex, dy, sum[5]);
    sum[6] = vf_fma(ey, dy, sum[6]);
    sum[7] = vf_add(sum[7], vf_abs(vf_fma(vf_set1(2.0f * s->a), ex, vf_mul(b, ey))));
    sum[11] = vf_add(sum[11], vf_abs(vf_fma(vf_set1(2.0f * s->c), ey, vf_mul(b, ex))));
    for (int c = 0; c < 3; c++)
        sum[8 + c] = vf_fma(weight, r->grad[c], sum[8 + c]);
}

static void back(const plain_job *job, int tile)
{
    const plain_tile *in = job->tiles + tile;
    const uint32_t *list = job->list + job->start[tile];
    int rect[4];
    uint32_t end = 0;
    row_state rows[16];
    tile_rect(job, tile, rect);
    const vf px = vf_add(vf_load(columns), vf_set1((float)rect[0])), zero = vf_set1(0.0f);
    for (int row = 0; row < rect[3]; row++) {
        row_state *r = &rows[row];
        read_row(job, job->grad, rect, row, r->grad);
        r->t = vf_load(in->t[row]);
        r->behind = zero;
        for (int c = 0; c < 3; c++)
            r->behind = vf_fma(vf_set1(job->background[c]), r->grad[c], r->behind);
        end = ADCGS_MAX(end, in->end[row]);
    }
    while (end-- > 0) {
        const adcgs_splat2d *s = job->splats + list[end];
        const vf dx = vf_sub(px, vf_set1(s->x));
        vf sum[12] = {zero, zero, zero, zero, zero, zero, zero, zero, zero, zero, zero, zero};
        alignas(64) float sums[16];
        for (int row = 0; row < rect[3]; row++)
            if (end < in->end[row])
                back_row(&rows[row], s, dx, vf_set1((float)(rect[1] + row) + 0.5f - s->y), sum);
        vf_sums(sums, sum);
        float *to = job->sums + (size_t)list[end] * SUM_WORDS;
        vf_store(to, vf_add(vf_load(to), vf_load(sums)));
    }
}

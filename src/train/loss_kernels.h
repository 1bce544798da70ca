/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * L1 and SSIM of a strip, value and gradient, in one pass down its rows. The
 * body of loss_scalar.c, loss_avx2.c and loss_avx512.c, which define KERNEL and
 * ADCGS_LANES_ISA.
 *
 * With G the window, x the image and y the target, SSIM needs m = G x, n = G y,
 * q = G (x^2 + y^2) and c = G (x y) at each pixel, and its gradient is
 *   G (dS/dm) + 2 x G (dS/dq) + y G (dS/dc),
 * the derivatives taken as if m, q and c were independent. G is separable: rows
 * go through it once as they come in, the three derivatives again. Down the
 * columns two rows are done at a time, since their windows share most of what
 * they read. The two halves take turns of some rows, so that the ring of each
 * stays in the first-level cache meanwhile.
 */
#include "train/loss_strip.h"

#include "base/base.h"
#include "base/lanes.h"

#include <string.h>

#define HALO ADCGS_LOSS_HALO

/* exp(-k^2/4.5) for k = 0..5, scaled to sum 1 over -5..5. */
#define G0 0.266011725f
#define G1 0.213005538f
#define G2 0.10936069f
#define G3 0.0360007721f
#define G4 0.00759875814f
#define G5 0.00102838008f

#define C1 (0.01f * 0.01f)
#define C2 (0.03f * 0.03f)

enum { MAP_M, MAP_N, MAP_Q, MAP_C, MAPS_IN };
enum { MAP_DM, MAP_DQ, MAP_DC, MAPS_OUT };
enum { LANES = 16, TURN = 16, RING_IN = 12, RING_OUT = 32 };
_Static_assert(TURN + 2 * HALO + 2 <= RING_OUT, "the rows that a turn reads are there");

/* ---- The window ---- */

/* out[i] = window over in[i+3 .. i+13] */
LANES_INLINE void filter_row(const float *restrict in, float *restrict out, int n)
{
    for (int i = 0; i < n; i += LANES) {
        const float *const p = in + i + 8;
        vf sum = vf_mul(vf_set1(G5), vf_add(vf_loadu(p - 5), vf_loadu(p + 5)));
        sum = vf_fma(vf_set1(G4), vf_add(vf_loadu(p - 4), vf_loadu(p + 4)), sum);
        sum = vf_fma(vf_set1(G3), vf_add(vf_loadu(p - 3), vf_loadu(p + 3)), sum);
        sum = vf_fma(vf_set1(G2), vf_add(vf_loadu(p - 2), vf_loadu(p + 2)), sum);
        sum = vf_fma(vf_set1(G1), vf_add(vf_loadu(p - 1), vf_loadu(p + 1)), sum);
        vf_store(out + i, vf_fma(vf_set1(G0), vf_loadu(p), sum));
    }
}

/* The rows first .. first+11 of a ring. */
typedef struct twelve {
    const float *row[12];
} twelve;

typedef struct pair {
    vf a, b;
} pair;

/*
 * Windows over rows 0 .. 10 and 1 .. 11. Each row is next to its mirror images in both, so that going from one mirror image to
 * the next takes one load for each sum of two.
 */
LANES_INLINE pair columns(const twelve *rows, int at)
{
#define ROW(k) vf_load(rows->row[k] + at)
    const vf r1 = ROW(1), r9 = ROW(9), r3 = ROW(3), r7 = ROW(7), r5 = ROW(5);
    vf b = vf_mul(vf_set1(G5), vf_add(ROW(11), r1));
    vf a = vf_mul(vf_set1(G4), vf_add(r1, r9));
    b = vf_fma(vf_set1(G3), vf_add(r9, r3), b);
    a = vf_fma(vf_set1(G2), vf_add(r3, r7), a);
    b = vf_fma(vf_set1(G1), vf_add(r7, r5), b);
    a = vf_fma(vf_set1(G0), r5, a);
    const vf r10 = ROW(10), r2 = ROW(2), r8 = ROW(8), r4 = ROW(4), r6 = ROW(6);
    a = vf_fma(vf_set1(G5), vf_add(ROW(0), r10), a);
    b = vf_fma(vf_set1(G4), vf_add(r10, r2), b);
    a = vf_fma(vf_set1(G3), vf_add(r2, r8), a);
    b = vf_fma(vf_set1(G2), vf_add(r8, r4), b);
    a = vf_fma(vf_set1(G1), vf_add(r4, r6), a);
    b = vf_fma(vf_set1(G0), r6, b);
    return (pair){a, b};
#undef ROW
}

/* Sum of n numbers, beyond which there is room for a whole vector. */
static double row_sum(const float *p, int n)
{
    _Alignas(64) float lane[LANES];
    vf sum = vf_set1(0.0f);
    const int whole = n / LANES * LANES;
    for (int i = 0; i < whole; i += LANES)
        sum = vf_add(sum, vf_loadu(p + i));
    vf_store(lane, sum);
    for (int i = whole; i < n; i++)
        lane[i - whole] += p[i];
    for (int half = LANES / 2; half; half /= 2)
        for (int i = 0; i < half; i++)
            lane[i] += lane[i + half];
    return (double)lane[0];
}

/* ---- SSIM and its derivatives ---- */

/* Columns first - 16 .. of a row; those outside the image are zero. */
static void load_row(const adcgs_loss_strip *s, int row, adcgs_loss_scratch *w)
{
    enum { N = ADCGS_LOSS_STRIP + 32 };
    const int begin = s->first - LANES, left = begin < 0 ? -begin : 0, right = ADCGS_MIN(s->width - begin, N);
    const size_t from = (size_t)row * (size_t)s->stride + (size_t)(begin + left), bytes = (size_t)(right - left) * sizeof(float);
    const float *const source[2] = {s->image + from, s->target + from};
    for (int i = 0; i < 2; i++) {
        memset(w->pixels[i], 0, (size_t)left * sizeof(float));
        memcpy(w->pixels[i] + left, source[i], bytes);
        memset(w->pixels[i] + right, 0, (size_t)(N - right) * sizeof(float));
    }
    for (int i = 0; i < N; i += LANES) {
        const vf x = vf_load(w->pixels[MAP_M] + i), y = vf_load(w->pixels[MAP_N] + i);
        vf_store(w->pixels[MAP_Q] + i, vf_fma(x, x, vf_mul(y, y)));
        vf_store(w->pixels[MAP_C] + i, vf_mul(x, y));
    }
}

/* A row into the ring of those that came in; there is nothing above and below the image. */
static void take_row(const adcgs_loss_strip *s, int row, adcgs_loss_scratch *w, int n)
{
    float(*const maps)[ADCGS_LOSS_STRIP + 16] = w->in[(row + RING_IN) % RING_IN];
    if (row < 0 || row >= s->height) {
        memset(maps, 0, sizeof w->in[0]);
        return;
    }
    load_row(s, row, w);
    for (int map = 0; map < MAPS_IN; map++)
        filter_row(w->pixels[map], maps[map], n);
}

LANES_INLINE void ssim_of(vf m, vf k, vf q, vf c, float *ssim, float (*derivatives)[ADCGS_LOSS_STRIP + 16], int i)
{
    const vf two = vf_set1(2.0f);
    const vf mm = vf_fma(m, m, vf_mul(k, k)), mk = vf_mul(two, vf_mul(m, k));
    const vf a1 = vf_add(mk, vf_set1(C1)), a2 = vf_add(vf_sub(vf_mul(two, c), mk), vf_set1(C2));
    const vf b1 = vf_add(mm, vf_set1(C1)), b2 = vf_add(vf_sub(q, mm), vf_set1(C2));
    const vf inverse = vf_div(vf_set1(1.0f), vf_mul(b1, b2)), twice = vf_mul(two, inverse);
    const vf s = vf_mul(vf_mul(a1, a2), inverse);
    vf_store(ssim + i, s);
    vf_store(derivatives[MAP_DM] + i, vf_mul(twice, vf_fnma(vf_mul(m, s), vf_sub(b2, b1), vf_mul(k, vf_sub(a2, a1)))));
    vf_store(derivatives[MAP_DQ] + i, vf_mul(vf_sub(vf_set1(0.0f), s), vf_mul(b1, inverse)));
    vf_store(derivatives[MAP_DC] + i, vf_mul(a1, twice));
}

/* Of two rows. Index 0 is column first - 8. */
static void ssim_rows(const twelve *rows, adcgs_loss_scratch *w, int n)
{
    enum { MAP = ADCGS_LOSS_STRIP + 16 };
    for (int i = 0; i < n; i += LANES) {
        const pair m = columns(rows, MAP_M * MAP + i), k = columns(rows, MAP_N * MAP + i);
        const pair q = columns(rows, MAP_Q * MAP + i), c = columns(rows, MAP_C * MAP + i);
        ssim_of(m.a, k.a, q.a, c.a, w->ssim[0], w->derivatives[0], i);
        ssim_of(m.b, k.b, q.b, c.b, w->ssim[1], w->derivatives[1], i);
    }
}

/* Outside the image there is no SSIM, hence no derivative. */
static void clear_outside(const adcgs_loss_strip *s, float *map, int n)
{
    const int begin = s->first - 8, right = s->width - begin;
    if (begin < 0)
        memset(map, 0, (size_t)-begin * sizeof *map);
    if (right < n)
        memset(map + right, 0, (size_t)(n - right) * sizeof *map);
}

/* Derivatives of two rows into the ring of those that go out. */
static void differentiate(adcgs_loss_strip *s, int row, adcgs_loss_scratch *w, int n)
{
    for (int ahead = row ? HALO : -HALO; row < s->height && ahead <= HALO + 1; ahead++)
        take_row(s, row + ahead, w, n);
    if (row < s->height) {
        twelve rows;
        for (int k = 0; k < 12; k++)
            rows.row[k] = w->in[(row - HALO + k + RING_IN) % RING_IN][0];
        ssim_rows(&rows, w, n);
    }
    for (int i = 0; i < 2; i++) {
        float(*const out)[ADCGS_LOSS_STRIP] = w->out[(row + i) % RING_OUT];
        if (row + i >= s->height) {
            memset(out, 0, sizeof w->out[0]);
            continue;
        }
        s->ssim += row_sum(w->ssim[i] + 8, s->count);
        for (int map = 0; map < MAPS_OUT; map++) {
            clear_outside(s, w->derivatives[i][map], n);
            filter_row(w->derivatives[i][map], out[map], (s->count + LANES - 1) / LANES * LANES);
        }
    }
}

/* ---- Gradients ---- */

/* |x - y| and (x - y)^2 besides. */
LANES_INLINE vf gradient_of(const adcgs_loss_strip *s, vf x, vf y, vf dm, vf dq, vf dc, float *distance, float *square)
{
    const vf d = vf_sub(x, y), zero = vf_set1(0.0f), size = vf_abs(d);
    const vf scale = vf_set1(s->l1_scale), slope = vf_sub(vf_only(vf_ge(d, zero), scale), vf_only(vf_ge(zero, d), scale));
    const vf g = vf_fma(y, dc, vf_fma(vf_add(x, x), dq, dm));
    vf_store(distance, size);
    vf_store(square, vf_mul(d, d));
    return vf_fma(vf_set1(s->ssim_scale), g, slope);
}

/* Of one of two rows, columns from at; the strip's last vector may not be whole. */
LANES_INLINE void gradient_vector(const adcgs_loss_strip *s, int row, int at, vf dm, vf dq, vf dc, float *distance, float *square)
{
    const size_t from = (size_t)row * (size_t)s->stride + (size_t)(s->first + at);
    if (at + LANES <= s->count) {
        const vf x = vf_loadu(s->image + from), y = vf_loadu(s->target + from);
        vf_storeu(s->grad + from, gradient_of(s, x, y, dm, dq, dc, distance + at, square + at));
        return;
    }
    _Alignas(64) float x[LANES] = {0.0f}, y[LANES] = {0.0f}, grad[LANES];
    const size_t bytes = (size_t)(s->count - at) * sizeof(float);
    memcpy(x, s->image + from, bytes);
    memcpy(y, s->target + from, bytes);
    vf_store(grad, gradient_of(s, vf_load(x), vf_load(y), dm, dq, dc, distance + at, square + at));
    memcpy(s->grad + from, grad, bytes);
}

static void gradient_rows(adcgs_loss_strip *s, int row, adcgs_loss_scratch *w)
{
    enum { MAP = ADCGS_LOSS_STRIP };
    const int there = ADCGS_MIN(2, s->height - row);
    twelve rows;
    for (int k = 0; k < 12; k++)
        rows.row[k] = w->out[(row - HALO + k + RING_OUT) % RING_OUT][0];
    for (int at = 0; at < s->count; at += LANES) {
        const pair dm = columns(&rows, MAP_DM * MAP + at), dq = columns(&rows, MAP_DQ * MAP + at);
        const pair dc = columns(&rows, MAP_DC * MAP + at);
        gradient_vector(s, row, at, dm.a, dq.a, dc.a, w->distance[0], w->square[0]);
        if (there == 2)
            gradient_vector(s, row + 1, at, dm.b, dq.b, dc.b, w->distance[1], w->square[1]);
    }
    for (int i = 0; i < there; i++) {
        s->l1 += row_sum(w->distance[i], s->count);
        s->mse += row_sum(w->square[i], s->count);
    }
}

void KERNEL(adcgs_loss_strip *s, adcgs_loss_scratch *w)
{
    /* What the window needs, in whole vectors: the rest is computed from zeros or real pixels, and never used. */
    const int n = (s->count + 8 + HALO + LANES - 1) / LANES * LANES;
    int in = 0;
    s->l1 = s->mse = s->ssim = 0.0;
    memset(w->out[RING_OUT - HALO], 0, HALO * sizeof w->out[0]); /* above the image */
    for (int out = 0; out < s->height;) {
        for (const int turn = in + TURN; in < turn; in += 2)
            differentiate(s, in, w, n);
        for (; out < s->height && out + HALO + 1 < in; out += 2)
            gradient_rows(s, out, w);
    }
}

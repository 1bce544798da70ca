/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * L1 and SSIM of a strip, value and gradient, in one pass down its rows. The
 * body of loss_scalar.c, loss_avx2.c and loss_avx512.c, which define KERNEL.
 *
 * With G the window, x the image and y the target, SSIM needs m = G x, n = G y,
 * q = G (x^2 + y^2) and c = G (x y) at each pixel, and its gradient is
 *   G (dS/dm) + 2 x G (dS/dq) + y G (dS/dc),
 * the derivatives taken as if m, q and c were independent. G is separable:
 * rows go through it once as they come in (ring of 4 maps), the three
 * derivative maps again (ring of 3 maps); gradients leave ten rows behind.
 *
 * No sum runs across vector lanes, except row_sum() with lanes fixed at 16, and
 * nothing is fused: gcc vectorises these loops and the bits stay the same.
 */
#include "train/loss_strip.h"

#include <math.h>
#include <string.h>

#define TAPS 11
#define HALO ADCGS_LOSS_HALO
#define ROW ADCGS_LOSS_ROW

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

/* out[i] = window over in[i .. i+10] */
static void filter_row(const float *restrict in, float *restrict out, int n)
{
    for (int i = 0; i < n; i++)
        out[i] = G0 * in[i + 5] + G1 * (in[i + 4] + in[i + 6]) + G2 * (in[i + 3] + in[i + 7]) + G3 * (in[i + 2] + in[i + 8]) +
                 G4 * (in[i + 1] + in[i + 9]) + G5 * (in[i] + in[i + 10]);
}

/* The eleven rows that end with row `last`, oldest first. Rows are kept at their number modulo 11. */
static void ring_rows(const float *ring, int maps, int last, const float *rows[TAPS])
{
    for (int k = 0; k < TAPS; k++)
        rows[k] = ring + (size_t)((last + 1 + k) % TAPS) * (size_t)maps * ROW;
}

/* Each row in a variable of its own: gcc then sees that stores to the outputs leave them alone. */
#define TAKE_ROWS(rows)                                                                                              \
    const float *restrict const r0 = rows[0], *restrict const r1 = rows[1], *restrict const r2 = rows[2],           \
                                *restrict const r3 = rows[3], *restrict const r4 = rows[4], *restrict const r5 = rows[5],   \
                                *restrict const r6 = rows[6], *restrict const r7 = rows[7], *restrict const r8 = rows[8],   \
                                *restrict const r9 = rows[9], *restrict const r10 = rows[10]
#define COLUMN(j)                                                                                             \
    (G0 * r5[j] + G1 * (r4[j] + r6[j]) + G2 * (r3[j] + r7[j]) + G3 * (r2[j] + r8[j]) + G4 * (r1[j] + r9[j]) + \
     G5 * (r0[j] + r10[j]))

static float sum_lanes(const float lane[16])
{
    float a[8];
    for (int i = 0; i < 8; i++)
        a[i] = lane[i] + lane[i + 8];
    return ((a[0] + a[4]) + (a[1] + a[5])) + ((a[2] + a[6]) + (a[3] + a[7]));
}

static double row_sum(const float *p, int n)
{
    float lane[16] = {0.0f};
    const int whole = n & ~15;
    for (int i = 0; i < whole; i += 16)
        for (int l = 0; l < 16; l++)
            lane[l] += p[i + l];
    for (int l = 0; l < n - whole; l++)
        lane[l] += p[whole + l];
    return sum_lanes(lane);
}

/* Index 0 is column first - 10; columns outside the image are zero. */
static void load_row(const adcgs_loss_strip *s, int row, float *restrict scratch, float *restrict maps, int n)
{
    float *const x = scratch, *const y = scratch + ROW, *const q = scratch + 2 * ROW, *const c = scratch + 3 * ROW;
    const int left = s->first - 2 * HALO < 0 ? 2 * HALO - s->first : 0;
    const int right = s->width - (s->first - 2 * HALO) < ROW ? s->width - (s->first - 2 * HALO) : ROW;
    const size_t from = (size_t)row * (size_t)s->stride + (size_t)(s->first - 2 * HALO + left);
    const size_t bytes = (size_t)(right - left) * sizeof(float);
    memset(x, 0, (size_t)left * sizeof(float));
    memset(y, 0, (size_t)left * sizeof(float));
    memcpy(x + left, s->image + from, bytes);
    memcpy(y + left, s->target + from, bytes);
    memset(x + right, 0, (size_t)(ROW - right) * sizeof(float));
    memset(y + right, 0, (size_t)(ROW - right) * sizeof(float));
    for (int i = 0; i < ROW; i++) {
        q[i] = x[i] * x[i] + y[i] * y[i];
        c[i] = x[i] * y[i];
    }
    filter_row(x, maps + MAP_M * ROW, n);
    filter_row(y, maps + MAP_N * ROW, n);
    filter_row(q, maps + MAP_Q * ROW, n);
    filter_row(c, maps + MAP_C * ROW, n);
}

/* SSIM and its three derivatives along a row; index 0 is column first - 5. */
static void ssim_row(const float *const rows[TAPS], float *restrict derivatives, float *restrict ssim, int n)
{
    TAKE_ROWS(rows);
    for (int i = 0; i < n; i++) {
        const float m = COLUMN(MAP_M * ROW + i), k = COLUMN(MAP_N * ROW + i);
        const float q = COLUMN(MAP_Q * ROW + i), c = COLUMN(MAP_C * ROW + i);
        const float mm = m * m + k * k, mk = 2.0f * (m * k);
        const float a1 = mk + C1, a2 = (2.0f * c - mk) + C2, b1 = mm + C1, b2 = (q - mm) + C2;
        const float inverse = 1.0f / (b1 * b2), s = (a1 * a2) * inverse;
        ssim[i] = s;
        derivatives[MAP_DM * ROW + i] = 2.0f * inverse * (k * (a2 - a1) - m * s * (b2 - b1));
        derivatives[MAP_DQ * ROW + i] = -s * b1 * inverse;
        derivatives[MAP_DC * ROW + i] = 2.0f * a1 * inverse;
    }
}

/* Gradient of a row, and |x - y| and (x - y)^2 for the sums. */
static void gradient_row(const adcgs_loss_strip *s, const float *const rows[TAPS], const float *restrict x,
                         const float *restrict y, float *restrict grad, float *restrict distance, float *restrict square)
{
    TAKE_ROWS(rows);
    const float l1_scale = s->l1_scale, ssim_scale = s->ssim_scale;
    const int n = s->count;
    for (int i = 0; i < n; i++) {
        const float d = x[i] - y[i];
        const float g = COLUMN(MAP_DM * ROW + i) + 2.0f * x[i] * COLUMN(MAP_DQ * ROW + i) + y[i] * COLUMN(MAP_DC * ROW + i);
        grad[i] = ssim_scale * g + l1_scale * (float)((d > 0.0f) - (d < 0.0f));
        distance[i] = fabsf(d);
        square[i] = d * d;
    }
}

/* Outside the image there is no SSIM, hence no derivative. */
static void clear_outside(const adcgs_loss_strip *s, float *map, int n)
{
    const int left = s->first < HALO ? HALO - s->first : 0;
    const int right = s->width - (s->first - HALO);
    for (int i = 0; i < left; i++)
        map[i] = 0.0f;
    for (int i = right; i < n; i++)
        map[i] = 0.0f;
}

static void derivatives_in(adcgs_loss_strip *s, const float *ring, float *out, int row, float *scratch, int n, int n_out)
{
    const float *rows[TAPS];
    float *const ssim = scratch, *const derivatives = scratch + ROW;
    ring_rows(ring, MAPS_IN, row + HALO, rows);
    ssim_row(rows, derivatives, ssim, n);
    s->ssim += row_sum(ssim + HALO, s->count);
    for (int map = 0; map < MAPS_OUT; map++) {
        clear_outside(s, derivatives + map * ROW, n);
        filter_row(derivatives + map * ROW, out + map * ROW, n_out);
    }
}

void KERNEL(adcgs_loss_strip *s, float *scratch)
{
    float *const in = scratch, *const out = in + TAPS * MAPS_IN * ROW, *const single = out + TAPS * MAPS_OUT * ROW;
    /* Whole vectors: what lies beyond the columns needed is computed from zeros or real pixels, and never used. */
    const int n_out = (s->count + 15) & ~15, n = (s->count + 2 * HALO + 15) & ~15;
    const size_t in_bytes = MAPS_IN * ROW * sizeof(float), out_bytes = MAPS_OUT * ROW * sizeof(float);
    memset(scratch, 0, ADCGS_LOSS_SCRATCH * sizeof(float));
    s->l1 = s->mse = s->ssim = 0.0;
    for (int r = 0; r < s->height + 2 * HALO; r++) {
        float *const in_row = in + r % TAPS * MAPS_IN * ROW, *const out_row = out + (r + TAPS - HALO) % TAPS * MAPS_OUT * ROW;
        if (r < s->height)
            load_row(s, r, single, in_row, n);
        else
            memset(in_row, 0, in_bytes);
        if (r >= HALO && r < s->height + HALO)
            derivatives_in(s, in, out_row, r - HALO, single + 4 * ROW, n, n_out);
        else
            memset(out_row, 0, out_bytes);
        if (r >= 2 * HALO) {
            const float *rows[TAPS];
            ring_rows(out, MAPS_OUT, r - HALO, rows);
            const size_t at = (size_t)(r - 2 * HALO) * (size_t)s->stride + (size_t)s->first;
            gradient_row(s, rows, s->image + at, s->target + at, s->grad + at, single + 8 * ROW, single + 9 * ROW);
            s->l1 += row_sum(single + 8 * ROW, s->count);
            s->mse += row_sum(single + 9 * ROW, s->count);
        }
    }
}

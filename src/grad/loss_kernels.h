/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Errors and SSIM of a strip, value and gradient, in one pass down its rows. The
 * body of loss_scalar.c, loss_avx2.c and loss_avx512.c, which define KERNEL and
 * ADCGS_LANES_ISA.
 *
 * With G the window, x the image and y the target, SSIM needs m = G x, n = G y,
 * q = G (x^2 + y^2) and c = G (x y) at each pixel, and its gradient is
 *   G (dS/dm) + 2 x G (dS/dq) + y G (dS/dc),
 * with the derivatives taken as if m, q and c were independent. G is separable.
 * Rows are filtered once when they are loaded, and the three derivatives again.
 *
 * A strip's columns are divided into sixteen stripes, one per lane, so that the
 * neighbours of a vector's pixels are vectors too. The window slides along a row
 * as it does down the columns, two positions at a time, since adjacent windows
 * share most of their input. Rows are processed in batches of ADCGS_LOSS_TURN.
 * Down the columns a batch is processed one vector at a time, which keeps the
 * rows of its windows in the L1 cache.
 */
#include "grad/loss_strip.h"

#include "base/base.h"
#include "base/lanes.h"

#include <string.h>

#define HALO ADCGS_LOSS_HALO

/* exp(-k^2/4.5) for k = 0..5, scaled to sum 1 over -5..5: the window of SSIM; literature (Wang et al. 2004). */
#define G0 0.266011725f
#define G1 0.213005538f
#define G2 0.10936069f
#define G3 0.0360007721f
#define G4 0.00759875814f
#define G5 0.00102838008f

/* Stabilising constants of SSIM for values of 0 to 1; literature, likewise. */
#define C1 (0.01f * 0.01f)
#define C2 (0.03f * 0.03f)

enum { MAP_M, MAP_N, MAP_Q, MAP_C, MAPS_IN };
enum { MAP_DM, MAP_DQ, MAP_DC, MAPS_OUT };
enum { SUM_L1, SUM_MSE, SUM_SSIM };
enum { LANES = ADCGS_LOSS_LANES, TURN = ADCGS_LOSS_TURN, RING = ADCGS_LOSS_RING, STRIPE = ADCGS_LOSS_STRIPE };
enum {
    BEHIND = HALO + 1, /* rows by which gradients lag behind derivatives: the halo, and one to make it even */
    /* Rows of prefetch, since a strip's rows are too short for the hardware prefetcher; chosen by hand, not measured. */
    AHEAD = 3
};
_Static_assert(TURN + BEHIND + HALO <= RING, "the rows that a batch reads exist");

/* ---- The window ---- */

typedef struct pair {
    vf a, b;
} pair;

/*
 * Windows over vectors 0 .. 10 and 1 .. 11. In both, each vector is next to its mirror images. So the step from one mirror image
 * to the next needs one load for two sums.
 */
LANES_INLINE pair windows(const float *p, const int at[12])
{
#define AT(k) vf_load_once(p + at[k])
    const vf r1 = AT(1), r9 = AT(9), r3 = AT(3), r7 = AT(7), r5 = AT(5);
    vf b = vf_mul(vf_set1(G5), vf_add(AT(11), r1));
    vf a = vf_mul(vf_set1(G4), vf_add(r1, r9));
    b = vf_fma(vf_set1(G3), vf_add(r9, r3), b);
    a = vf_fma(vf_set1(G2), vf_add(r3, r7), a);
    b = vf_fma(vf_set1(G1), vf_add(r7, r5), b);
    a = vf_fma(vf_set1(G0), r5, a);
    const vf r10 = AT(10), r2 = AT(2), r8 = AT(8), r4 = AT(4), r6 = AT(6);
    a = vf_fma(vf_set1(G5), vf_add(AT(0), r10), a);
    b = vf_fma(vf_set1(G4), vf_add(r10, r2), b);
    a = vf_fma(vf_set1(G3), vf_add(r2, r8), a);
    b = vf_fma(vf_set1(G2), vf_add(r8, r4), b);
    a = vf_fma(vf_set1(G1), vf_add(r4, r6), a);
    b = vf_fma(vf_set1(G0), r6, b);
    return (pair){a, b};
#undef AT
}

/* Filters along a row. Fills the margins first: beyond a stripe lies the stripe of the next lane. */
static void filter_row(adcgs_loss_wide row, adcgs_loss_row out, int stripe)
{
    static const int side_by_side[12] = {0, 16, 32, 48, 64, 80, 96, 112, 128, 144, 160, 176};
    for (int i = 0; i < HALO; i++) {
        vf_store(row[i], vf_before(vf_load(row[stripe + i])));
        vf_store(row[stripe + HALO + i], vf_next(vf_load(row[HALO + i])));
    }
    for (int i = 0; i < stripe; i += 2) {
        const pair w = windows(row[i], side_by_side);
        vf_store(out[i], w.a);
        vf_store(out[i + 1], w.b);
    }
}

/* Positions of the rows around those of a batch, size apart in a ring. */
static void place_rows(int at[TURN + 2 * HALO], int first, int size)
{
    for (int i = 0; i < TURN + 2 * HALO; i++)
        at[i] = (first - HALO + i + RING) % RING * size;
}

/* ---- Stripes ---- */

static void to_stripes(adcgs_loss_wide out, const float *row, int stripe)
{
    for (int i = 0; i < stripe; i += 4) {
        const int at = ADCGS_MIN(i, stripe - 4);
        vf square[4];
        for (int j = 0; j < 4; j++)
            square[j] = vf_load_rows(row + j * stripe + at, 4 * (size_t)stripe);
        vf_turn_squares(square);
        for (int j = 0; j < 4; j++)
            vf_store(out[HALO + at + j], square[j]);
    }
}

static void from_stripes(float *row, adcgs_loss_row in, int stripe)
{
    for (int i = 0; i < stripe; i += 4) {
        const int at = ADCGS_MIN(i, stripe - 4);
        vf square[4];
        for (int j = 0; j < 4; j++)
            square[j] = vf_load(in[at + j]);
        vf_turn_squares(square);
        for (int j = 0; j < 4; j++) {
            float *const to = row + j * stripe + at;
            vf_store_rows((float *const[4]){to, to + 4 * stripe, to + 8 * stripe, to + 12 * stripe}, square[j]);
        }
    }
}

/* Loads a row of the image, which may be narrower than the stripes. */
static void load_row(const adcgs_loss_strip *s, const float *image, int row, adcgs_loss_scratch *w, adcgs_loss_wide out)
{
    const float *from = image + (size_t)row * (size_t)s->width + s->begin;
    for (int i = 0; row + AHEAD < s->height && i < LANES * s->stripe; i += LANES)
        __builtin_prefetch(from + (size_t)AHEAD * (size_t)s->width + i);
    if (s->width < LANES * s->stripe)
        from = memcpy(w->row, from, (size_t)s->width * sizeof *from);
    to_stripes(out, from, s->stripe);
}

/* 1 in `count` columns from `first`, else 0. */
static void mark_columns(adcgs_loss_row out, int first, int count, int stripe)
{
    for (int i = 0; i < LANES * stripe; i++)
        out[i % stripe][i / stripe] = i >= first && i < first + count ? 1.0f : 0.0f;
}

/* ---- SSIM and its derivatives ---- */

/* Loads a row into the rings; rows above and below the image are 0. */
static void take_row(const adcgs_loss_strip *s, int row, adcgs_loss_scratch *w)
{
    adcgs_loss_wide *const pixels = w->pixels[(row + RING) % RING];
    adcgs_loss_row *const in = w->in[(row + RING) % RING];
    if (row < 0 || row >= s->height) {
        memset(pixels, 0, sizeof w->pixels[0]);
        memset(in, 0, sizeof w->in[0]);
        return;
    }
    load_row(s, s->image, row, w, pixels[MAP_M]);
    load_row(s, s->target, row, w, pixels[MAP_N]);
    for (int i = HALO; i < HALO + s->stripe; i++) {
        const vf x = vf_load(pixels[MAP_M][i]), y = vf_load(pixels[MAP_N][i]);
        vf_store(w->products[0][i], vf_fma(x, x, vf_mul(y, y)));
        vf_store(w->products[1][i], vf_mul(x, y));
    }
    filter_row(pixels[MAP_M], in[MAP_M], s->stripe);
    filter_row(pixels[MAP_N], in[MAP_N], s->stripe);
    filter_row(w->products[0], in[MAP_Q], s->stripe);
    filter_row(w->products[1], in[MAP_C], s->stripe);
}

/* `inside` is 0 where there is no SSIM, hence no derivative. */
LANES_INLINE vf ssim_of(vf m, vf k, vf q, vf c, vf inside, adcgs_loss_wide *derivatives, int i)
{
    const vf two = vf_set1(2.0f);
    const vf mm = vf_fma(m, m, vf_mul(k, k)), mk = vf_mul(two, vf_mul(m, k));
    const vf a1 = vf_add(mk, vf_set1(C1)), a2 = vf_add(vf_sub(vf_mul(two, c), mk), vf_set1(C2));
    const vf b1 = vf_add(mm, vf_set1(C1)), b2 = vf_add(vf_sub(q, mm), vf_set1(C2));
    const vf inverse = vf_div(inside, vf_mul(b1, b2)), twice = vf_mul(two, inverse);
    const vf s = vf_mul(vf_mul(a1, a2), inverse);
    vf_store(derivatives[MAP_DM][i], vf_mul(twice, vf_fnma(vf_mul(m, s), vf_sub(b2, b1), vf_mul(k, vf_sub(a2, a1)))));
    vf_store(derivatives[MAP_DQ][i], vf_mul(vf_sub(vf_set1(0.0f), s), vf_mul(b1, inverse)));
    vf_store(derivatives[MAP_DC][i], vf_mul(a1, twice));
    return s;
}

/* Derivatives of a batch of rows; the last rows may be below the image. */
static void ssim_rows(const adcgs_loss_strip *s, int row, adcgs_loss_scratch *w)
{
    enum { MAP = STRIPE * LANES };
    int at[TURN + 2 * HALO];
    place_rows(at, row, MAPS_IN * MAP);
    for (int i = 0; i < s->stripe; i++) {
        const float *const in = w->in[0][0][i];
        const vf inside = vf_load(w->inside[i]), mine = vf_load(w->mine[i]);
        vf sum = vf_load(w->sums[SUM_SSIM]);
        for (int r = 0; r < TURN && row + r < s->height; r += 2) {
            const pair m = windows(in, at + r), k = windows(in + MAP_N * MAP, at + r);
            const pair q = windows(in + MAP_Q * MAP, at + r), c = windows(in + MAP_C * MAP, at + r);
            const vf below = row + r + 1 < s->height ? inside : vf_set1(0.0f);
            sum = vf_fma(mine, ssim_of(m.a, k.a, q.a, c.a, inside, w->derivatives[r], HALO + i), sum);
            sum = vf_fma(mine, ssim_of(m.b, k.b, q.b, c.b, below, w->derivatives[r + 1], HALO + i), sum);
        }
        vf_store(w->sums[SUM_SSIM], sum);
    }
}

/* Filters derivatives of a batch of rows into the output ring. */
static void differentiate(const adcgs_loss_strip *s, int row, adcgs_loss_scratch *w)
{
    ssim_rows(s, row, w);
    for (int r = 0; r < TURN; r++)
        for (int map = 0; map < MAPS_OUT; map++)
            if (row + r < s->height)
                filter_row(w->derivatives[r][map], w->out[(row + r) % RING][map], s->stripe);
            else
                memset(w->out[(row + r) % RING][map], 0, sizeof w->out[0][0]);
}

/* ---- Gradients ---- */

/* Gradient of one vector; adds |x - y| and (x - y)^2 to the sums of its columns. */
LANES_INLINE void gradient_of(const adcgs_loss_strip *s, adcgs_loss_scratch *w, int row, int r, int i, vf dm, vf dq, vf dc,
                              vf sums[2])
{
    const vf x = vf_load(w->pixels[row % RING][MAP_M][HALO + i]), y = vf_load(w->pixels[row % RING][MAP_N][HALO + i]);
    const vf d = vf_sub(x, y), zero = vf_set1(0.0f), mine = vf_load(w->mine[i]);
    const vf scale = vf_set1(s->l1_scale), slope = vf_sub(vf_only(vf_ge(d, zero), scale), vf_only(vf_ge(zero, d), scale));
    const vf g = vf_fma(y, dc, vf_fma(vf_add(x, x), dq, dm));
    vf_store(w->grad[r][i], vf_fma(vf_set1(s->square_scale), d, vf_fma(vf_set1(s->ssim_scale), g, slope)));
    sums[SUM_L1] = vf_fma(mine, vf_abs(d), sums[SUM_L1]);
    sums[SUM_MSE] = vf_fma(vf_mul(mine, d), d, sums[SUM_MSE]);
}

/* Gradients of rows from .. TURN-1 of a batch. */
static void gradient_rows(const adcgs_loss_strip *s, int row, int from, adcgs_loss_scratch *w)
{
    enum { MAP = STRIPE * LANES };
    int at[TURN + 2 * HALO];
    place_rows(at, row, MAPS_OUT * MAP);
    for (int i = 0; i < s->stripe; i++) {
        const float *const out = w->out[0][0][i];
        vf sums[2] = {vf_load(w->sums[SUM_L1]), vf_load(w->sums[SUM_MSE])};
        for (int r = from; r < TURN && row + r < s->height; r += 2) {
            const pair dm = windows(out, at + r), dq = windows(out + MAP_DQ * MAP, at + r);
            const pair dc = windows(out + MAP_DC * MAP, at + r);
            gradient_of(s, w, row + r, r, i, dm.a, dq.a, dc.a, sums);
            gradient_of(s, w, row + r + 1, r + 1, i, dm.b, dq.b, dc.b, sums);
        }
        vf_store(w->sums[SUM_L1], sums[SUM_L1]);
        vf_store(w->sums[SUM_MSE], sums[SUM_MSE]);
    }
    for (int r = from; r < TURN && row + r < s->height; r++) {
        from_stripes(w->row, w->grad[r], s->stripe);
        memcpy(s->grad + (size_t)(row + r) * (size_t)s->width + s->first, w->row + (s->first - s->begin),
               (size_t)s->count * sizeof *w->row);
    }
}

static void add_sums(adcgs_loss_strip *s, adcgs_loss_scratch *w)
{
    for (int i = 0; i < LANES; i++) {
        s->l1 += (double)w->sums[SUM_L1][i];
        s->mse += (double)w->sums[SUM_MSE][i];
        s->ssim += (double)w->sums[SUM_SSIM][i];
    }
    memset(w->sums, 0, sizeof w->sums);
}

void KERNEL(adcgs_loss_strip *s, adcgs_loss_scratch *w)
{
    int in = -HALO;
    s->l1 = s->mse = s->ssim = 0.0;
    mark_columns(w->inside, 0, s->width - s->begin, s->stripe);
    mark_columns(w->mine, s->first - s->begin, s->count, s->stripe);
    memset(w->row, 0, sizeof w->row);
    memset(w->sums, 0, sizeof w->sums);
    memset(w->out[RING - HALO - BEHIND], 0, (HALO + BEHIND) * sizeof w->out[0]); /* above the image */
    for (int row = 0; row - BEHIND < s->height; row += TURN) {
        for (; in < row + TURN + HALO; in++)
            take_row(s, in, w);
        differentiate(s, row, w);
        gradient_rows(s, row - BEHIND, row ? 0 : BEHIND, w);
        add_sums(s, w);
    }
}

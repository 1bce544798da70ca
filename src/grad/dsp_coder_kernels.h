/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The coder's integers as floats, for one CPU level: activations of hidden layers, values as they are coded, and their bits.
 */
#ifndef ADCGS_GRAD_DSP_CODER_KERNELS_H
#define ADCGS_GRAD_DSP_CODER_KERNELS_H

#include "grad/dsp_rate_kernels.h"

/** shr(v, s) of the specification for v = x * 2^s. */
static inline float nearest(float x)
{
    return floorf(x + 0.5f);
}

static void ISA(hidden)(float *restrict h, uint64_t *restrict below, const float *restrict z, const float *restrict in, int n)
{
    for (int i = 0; i < n * LANES; i++)
        h[i] = (z[i] < 0 ? z[i] * 0x1p-6f : z[i]) + (in ? in[i] : 0);
    for (int i = 0; i < n; i++)
        below[i] = below_of(z + i * LANES);
}

static void ISA(hidden_exact)(float *restrict h, uint64_t *restrict below, const float *restrict z, const float *restrict in,
                              int n)
{
    const float up = 1 << ADCGS_E24_BITS, down = 1 / up, most = ADCGS_E24_MAX * down;
    for (int i = 0; i < n * LANES; i++) {
        /* The leaky ReLU is the maximum of the two. */
        const float v = nearest(z[i] * up), slow = nearest(v * 0x1p-6f), a = (v > slow ? v : slow) * down;
        h[i] = adcgs_bounded(in ? a + in[i] : a, -most, most);
    }
    for (int i = 0; i < n; i++)
        below[i] = below_of(z + i * LANES);
}

/** A row of values in the coder's form. */
typedef struct exact_row {
    float mean[LANES], raw[LANES], level[LANES];
    float v[LANES], n[LANES]; /* in steps from the mean; the same rounded, or 0 if nothing is coded */
} exact_row;

static void ISA(exact_values)(exact_row *restrict r, const float *restrict y, const float *restrict mu, const float *restrict si,
                              float inverse)
{
    for (int l = 0; l < LANES; l++) {
        const float level = adcgs_coder_level(si[l]), m = adcgs_coder_mean(mu[l]);
        const float v = adcgs_bounded(y[l] * inverse - m * 0x1p-6f, -ADCGS_LEVEL_MAX, ADCGS_LEVEL_MAX), n = rintf(v);
        r->mean[l] = m;
        r->raw[l] = ADCGS_SI_GAIN * si[l] + ADCGS_SI_CENTRE;
        r->level[l] = level;
        r->v[l] = v;
        r->n[l] = level > 0 ? n : 0;
    }
}

/** The row as input of later networks. */
static void ISA(exact_inputs)(float *restrict x, const exact_row *restrict r)
{
    const float down = 1.0f / (1 << ADCGS_E24_BITS), most = ADCGS_E24_MAX * down, quarter = 1.0f / (1 << ADCGS_E24_INPUT_SHIFT);
    for (int l = 0; l < LANES; l++) {
        const float yq = adcgs_bounded(64 * r->n[l] + r->mean[l], -32767, 32767);
        x[l] = adcgs_bounded(nearest(yq * quarter) * down, -most, most);
    }
}

static double ISA(rate_exact)(const adcgs_rate_io *io)
{
    double total = 0;
    for (int i = 0; i < io->n; i++) {
        exact_row r;
        float bits[LANES], gv[LANES], gs[LANES];
        ISA(exact_values)(&r, io->y + i * LANES, io->mu + i * LANES, io->si + i * LANES, 1 / io->step[i]);
        for (int l = 0; l < LANES; l++)
            io->mean[i * LANES + l] = adcgs_mean_pack(r.mean[l], !(r.level[l] > 0));
        if (io->x)
            ISA(exact_inputs)(io->x + i * LANES, &r);
        ISA(rate_row_exact)(bits, gv, gs, r.v, r.n, r.level, &io->table->cell[0][0]);
        total += ISA(rate_pass_on)(io, i, bits, gv, gs, r.raw);
    }
    return total;
}

#endif

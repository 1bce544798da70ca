/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Bits of values and their derivatives by the continuous twin of the coder's tables, or by these tables, for one CPU level.
 */
#ifndef ADCGS_GRAD_DSP_RATE_KERNELS_H
#define ADCGS_GRAD_DSP_RATE_KERNELS_H

#include "base/fmath.h"
#include "grad/dsp.h"
#include "grad/dsp_vectors.h"

#include <math.h>

/** Upper tail of the standard normal for x >= 0 (Abramowitz and Stegun 26.2.17), and its density. */
static inline float tail(float x, float *density)
{
    const float t = 1 / (1 + 0.2316419f * x);
    const float p = t * (0.319381530f + t * (-0.356563782f + t * (1.781477937f + t * (-1.821255978f + t * 1.330274429f))));
    *density = 0.3989422804f * adcgs_exp(adcgs_clampf(-0.5f * x * x, -80, 0));
    return p * *density;
}

/** One row of values: bits of each lane; v in steps from the mean; gv, gs: derivatives with respect to v and to the level. */
static void ISA(rate_row)(float *restrict bits, float *restrict gv, float *restrict gs, const float *restrict v_row,
                          const float *restrict level_row)
{
    const float log2_ratio = 0.145784517f; /* log2(64/0.11)/63: sigma levels are 2^0.1458 apart */
    const float level0 = -3.18442457f;     /* log2(0.11) */
    for (int l = 0; l < LANES; l++) {
        const float v = v_row[l], av = v < 0 ? -v : v, level = adcgs_clampf(level_row[l], 0, 63);
        const float inv_sigma = adcgs_exp(-0.69314718f * (level * log2_ratio + level0));
        const float a = (av - 0.5f) * inv_sigma, b = (av + 0.5f) * inv_sigma;
        float fa, fb;
        const float qa = tail(a < 0 ? -a : a, &fa), qb = tail(b, &fb);
        const float inside = (a < 0 ? 1 - qa : qa) - qb;
        /* a thin heavy tail models the escape code and keeps gradients nonzero far out */
        const float width = 1 + 4 / inv_sigma, far = 1 / (width * width + av * av), heavy = 0x1p-14f * width * far;
        const float p = inside * (1 - 0x1p-12f) + heavy + 1e-12f, factor = -1.44269504f / p;
        const float dp_dv = (fb - fa) * inv_sigma * (1 - 0x1p-12f) - 2 * heavy * av * far;
        /* d p / d ln sigma; the tail's width grows with sigma */
        const float dp_dlog = -(b * fb - a * fa) * (1 - 0x1p-12f) + 0x1p-14f * far * (1 - 2 * width * width * far) * (width - 1);
        bits[l] = -adcgs_log2(p);
        gv[l] = factor * dp_dv * (v < 0 ? -1.0f : 1.0f);
        gs[l] = factor * dp_dlog * (0.69314718f * log2_ratio);
    }
}

/** The same with the coder's exact costs, from the table cells of each lane's level. */
static void ISA(rate_row_exact)(float *restrict bits, float *restrict gv, float *restrict gs, const float *restrict v_row,
                                const float *restrict n, const float *restrict level, const adcgs_rate_cell *restrict cells)
{
    for (int l = 0; l < LANES; l++) {
        /*
         * The derivative with respect to the level uses the coded value; that with respect to the value uses the unrounded one.
         */
        const float v = v_row[l], a = v < 0 ? -v : v, floor_a = floorf(a);
        const int at = (int)level[l] * ADCGS_RATE_CELLS, below = at + (int)floor_a;
        const float slope = cells[below].by_value + (a - floor_a) * (cells[below + 1].by_value - cells[below].by_value);
        bits[l] = cells[at + (int)(n[l] < 0 ? -n[l] : n[l])].bits;
        gv[l] = v < 0 ? -slope : slope;
        gs[l] = cells[at + (int)floorf(a + 0.5f)].by_level;
    }
}

/** Adds bits and derivatives of a row of io to its sum and gradients; raw: the level before clamping. */
static float ISA(rate_pass_on)(const adcgs_rate_io *io, int i, const float *restrict bits, const float *restrict gv,
                               const float *restrict gs, const float *restrict raw)
{
    float *restrict dy = io->dy + i * LANES, *restrict dmu = io->dmu + i * LANES, *restrict dsi = io->dsi + i * LANES;
    const float *restrict weight = io->weight;
    const float inverse = 1 / io->step[i], scale = io->scale;
    float sum = 0;
    for (int l = 0; l < LANES; l++) {
        const float v = gv[l] * weight[l] * scale, s = gs[l] * weight[l] * scale * ADCGS_SI_GAIN;
        /* a level out of range may only move back */
        const int outwards = ((raw[l] < 0) & (s > 0)) | ((raw[l] > 63) & (s < 0));
        dy[l] += v * inverse;
        dmu[l] = -v * ADCGS_MU_GAIN;
        dsi[l] = outwards ? 0 : s;
    }
    for (int l = 0; l < LANES; l++)
        sum += bits[l] * weight[l];
    return sum;
}

static double ISA(rate)(const adcgs_rate_io *io)
{
    double total = 0;
    for (int i = 0; i < io->n; i++) {
        const float *restrict y = io->y + i * LANES, *restrict mu = io->mu + i * LANES, *restrict si = io->si + i * LANES;
        float v[LANES], raw[LANES], bits[LANES], gv[LANES], gs[LANES];
        const float inverse = 1 / io->step[i];
        for (int l = 0; l < LANES; l++) {
            v[l] = y[l] * inverse - ADCGS_MU_GAIN * mu[l];
            raw[l] = ADCGS_SI_GAIN * si[l] + ADCGS_SI_CENTRE;
        }
        for (int l = 0; io->x && l < LANES; l++)
            io->x[i * LANES + l] = y[l] * inverse * (1 / ADCGS_MU_GAIN);
        ISA(rate_row)(bits, gv, gs, v, raw);
        total += ISA(rate_pass_on)(io, i, bits, gv, gs, raw);
    }
    return total;
}

#endif

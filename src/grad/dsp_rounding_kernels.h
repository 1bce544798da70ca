/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Features with the noise that stands for rounding, and with the rounding of the coder, for one CPU level. */
#ifndef ADCGS_GRAD_DSP_ROUNDING_KERNELS_H
#define ADCGS_GRAD_DSP_ROUNDING_KERNELS_H

#include "grad/dsp.h"
#include "grad/dsp_vectors.h"
#include "grad/random.h"

#include <math.h>

static void ISA(noise)(float *restrict y, const float *restrict p, const float *restrict step, int n, uint32_t seed)
{
    for (int i = 0; i < n; i++)
        for (int l = 0; l < LANES; l++) {
            const uint32_t r = adcgs_mix32(seed + (uint32_t)(i * LANES + l));
            y[i * LANES + l] = p[i * LANES + l] + step[i] * ((float)(int32_t)r * 0x1p-32f);
        }
}

static void ISA(round)(float *restrict y, const float *restrict p, const float *restrict step, const float *restrict mu, int n)
{
    const float most = 32767.0f / 64;
    for (int i = 0; i < n; i++) {
        const float inverse = 1 / step[i];
        for (int l = 0; l < LANES; l++) {
            const int alone = adcgs_mean_alone(mu[i * LANES + l]);
            const float m = (mu[i * LANES + l] - (alone ? ADCGS_MEAN_ALONE : 0)) * 0x1p-6f;
            const float v = adcgs_bounded(rintf(p[i * LANES + l] * inverse - m), -ADCGS_LEVEL_MAX, ADCGS_LEVEL_MAX);
            y[i * LANES + l] = step[i] * adcgs_bounded((alone ? 0 : v) + m, -most, most);
        }
    }
}

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The known answers, compiled per CPU level. Plain loops, lanes and elementary
 * functions all take part, since a flag may affect any one of them alone.
 * Contraction, for example, only shows if the level has a fused instruction.
 */
#ifndef ADCGS_BASE_STRICT_KERNELS_H
#define ADCGS_BASE_STRICT_KERNELS_H

#include "base/lanes.h"
#include "base/strict.h"

/* Sixteen samples of the lane operations. */
static void answer_lanes(float *const out[6], size_t at, const float *px, const float *py, const float *pz)
{
    const vf x = vf_load(px + at), y = vf_load(py + at), z = vf_load(pz + at);
    vf_store(out[0] + at, vf_add(vf_mul(x, y), z));
    vf_store(out[1] + at, vf_sub(z, vf_mul(x, y)));
    vf_store(out[2] + at, vf_fma(x, y, z));
    vf_store(out[3] + at, vf_fnma(x, y, z));
    vf_store(out[4] + at, vf_div(vf_sqrt(vf_abs(x)), y));
    vf_store(out[5] + at, vf_exp2(vf_sub(vf_set1(0.0f), vf_abs(x))));
}

static void answer(float out[ADCGS_STRICT_FUNCTIONS][ADCGS_STRICT_SAMPLES], const float *x, const float *y, const float *z)
{
    float *const lanes[6] = {out[9], out[10], out[11], out[12], out[13], out[14]};
    for (int i = 0; i < ADCGS_STRICT_SAMPLES; i++) {
        out[0][i] = x[i] * y[i] + z[i];
        out[1][i] = z[i] - x[i] * y[i];
        out[2][i] = fmaf(x[i], y[i], z[i]);
        out[3][i] = adcgs_exp2(x[i]);
        out[4][i] = adcgs_exp(x[i]);
        out[5][i] = adcgs_sigmoid(x[i]);
        out[6][i] = adcgs_log2(fabsf(y[i]));
        adcgs_sincospi(x[i], &out[7][i], &out[8][i]);
    }
    for (size_t at = 0; at < ADCGS_STRICT_SAMPLES; at += 16)
        answer_lanes(lanes, at, x, y, z);
}

#endif

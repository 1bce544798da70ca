/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Dense layers: the portable reference, and the choice of a variant. */
#include "config.h"

#include "splat/dense_isa.h"

#include "base/fmath.h"

static void dense(float *y, const float *init, const float *bias, const float *w, size_t ldw, const float *x, int n_out, int n_in)
{
    for (int o = 0; o < n_out; o++) {
        float *row = y + (size_t)o * ADCGS_LANES;
        for (int l = 0; l < ADCGS_LANES; l++)
            row[l] = init ? init[(size_t)o * ADCGS_LANES + (size_t)l] : bias ? bias[o] : 0.0f;
        for (int i = 0; i < n_in; i++)
            for (int l = 0; l < ADCGS_LANES; l++)
                row[l] = fmaf(w[(size_t)o * ldw + (size_t)i], x[(size_t)i * ADCGS_LANES + (size_t)l], row[l]);
    }
}

static void lrelu(float *y, int n)
{
    for (size_t i = 0; i < (size_t)n * ADCGS_LANES; i++)
        y[i] = y[i] < 0.0f ? y[i] * 0x1p-6f : y[i];
}

static void residual(float *y, const float *x, int n)
{
    for (size_t i = 0; i < (size_t)n * ADCGS_LANES; i++)
        y[i] = x[i] + (y[i] < 0.0f ? y[i] * 0x1p-6f : y[i]);
}

void adcgs_dense_dsp_init(adcgs_dense_dsp *dsp, adcgs_cpu_level level)
{
    *dsp = (adcgs_dense_dsp){dense, lrelu, residual};
#ifdef ADCGS_WASM
    *dsp = adcgs_dense_wasm;
#endif
#ifdef HAVE_AVX2
    if (level >= ADCGS_CPU_AVX2)
        *dsp = adcgs_dense_avx2;
#endif
#ifdef HAVE_AVX512
    if (level >= ADCGS_CPU_AVX512)
        *dsp = adcgs_dense_avx512;
#endif
}

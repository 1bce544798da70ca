/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The trainer's kernels for one CPU level, and their table. Included once per level by a file that defines ISA(name) and is
 * compiled with that level's flags. The 64-lane loops are written for the compiler's vectoriser.
 */
#include "grad/dsp.h"
#include "grad/dsp_layers_kernels.h"
#include "grad/dsp_rounding_kernels.h"
#include "grad/dsp_primitives_kernels.h"
#include "grad/dsp_primitives_back_kernels.h"
#include "grad/dsp_rate_kernels.h"
#include "grad/dsp_coder_kernels.h"

#include <math.h>

static void ISA(adam)(float *restrict p, float *restrict g, float *restrict m, float *restrict v, size_t n, float lr, float c1,
                      float c2)
{
    for (size_t i = 0; i < n; i++) {
        m[i] = 0.9f * m[i] + 0.1f * g[i];
        v[i] = 0.999f * v[i] + 0.001f * (g[i] * g[i]);
        const float step = m[i] * c1 / (sqrtf(v[i] * c2) + 1e-15f), low = step < -1 ? -1 : step;
        p[i] -= lr * (low > 1 ? 1 : low);
        g[i] = 0;
    }
}

void ISA(adcgs_train_dsp_init)(adcgs_train_dsp *dsp);
void ISA(adcgs_train_dsp_init)(adcgs_train_dsp *dsp)
{
    dsp->weight_grad = ISA(weight_grad);
    dsp->lrelu_back = ISA(lrelu_back);
    dsp->residual = ISA(residual);
    dsp->residual_back = ISA(residual_back);
    dsp->pack = NULL;
    dsp->noise = ISA(noise);
    dsp->round = ISA(round);
    dsp->primitives = ISA(primitives);
    dsp->primitives_back = ISA(primitives_back);
    dsp->hidden = ISA(hidden);
    dsp->hidden_exact = ISA(hidden_exact);
    dsp->rate = ISA(rate);
    dsp->rate_exact = ISA(rate_exact);
    dsp->adam = ISA(adam);
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The known answers in binary32, AVX-512 variant. */
#define ADCGS_LANES_ISA 512
#include "base/strict_kernels.h"

void adcgs_strict_avx512(float out[ADCGS_STRICT_FUNCTIONS][ADCGS_STRICT_SAMPLES], const float *x, const float *y, const float *z)
{
    answer(out, x, y, z);
}

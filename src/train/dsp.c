/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Choice of the trainer's kernels. */
#include "train/dsp.h"

#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

void adcgs_train_dsp_init_scalar(adcgs_train_dsp *dsp);
void adcgs_train_dsp_init_avx2(adcgs_train_dsp *dsp);
void adcgs_train_dsp_init_avx512(adcgs_train_dsp *dsp);

void adcgs_train_dsp_init(adcgs_train_dsp *dsp, adcgs_cpu_level level)
{
    adcgs_dense_dsp_init(&dsp->dense, level);
    adcgs_train_dsp_init_scalar(dsp);
#ifdef HAVE_AVX2
    if (level >= ADCGS_CPU_AVX2)
        adcgs_train_dsp_init_avx2(dsp);
#endif
#ifdef HAVE_AVX512
    if (level >= ADCGS_CPU_AVX512)
        adcgs_train_dsp_init_avx512(dsp);
#endif
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Choice of the trainer's kernels. */
#include "grad/dsp.h"

#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#include "base/cpu_detect.h"

void adcgs_train_dsp_init_scalar(adcgs_train_dsp *dsp);
void adcgs_train_dsp_init_avx2(adcgs_train_dsp *dsp);
void adcgs_train_dsp_init_avx512(adcgs_train_dsp *dsp);
void adcgs_train_dsp_init_avx512bf16(adcgs_train_dsp *dsp);

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

adcgs_status adcgs_bf16_check(adcgs_cpu_level level, adcgs_error *error)
{
#ifdef HAVE_AVX512BF16
    if (!__builtin_cpu_supports("avx512bf16"))
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "bf16 training needs AVX512-BF16, which this CPU lacks");
    if (level < ADCGS_CPU_AVX512)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "bf16 training needs kernels of CPU level avx512: these are of %s",
                          adcgs_cpu_name(level));
    return ADCGS_OK;
#else
    (void)level;
    return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "bf16 training needs AVX512-BF16, for which this build has no kernels");
#endif
}

void adcgs_train_dsp_init_bf16(adcgs_train_dsp *dsp, adcgs_cpu_level level)
{
    adcgs_train_dsp_init(dsp, level);
#ifdef HAVE_AVX512BF16
    if (adcgs_bf16_check(level, NULL) == ADCGS_OK)
        adcgs_train_dsp_init_avx512bf16(dsp);
#endif
}

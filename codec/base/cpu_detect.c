/* SPDX-License-Identifier: BSD-2-Clause */
/** \file CPU levels that this machine and this build support. */
#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#include "base/cpu_detect.h"

const char *const adcgs_cpu_names[] = {"auto", "scalar", "avx2", "avx512", NULL};
#define LEVELS (ADCGS_COUNTOF(adcgs_cpu_names) - 1)

adcgs_cpu_level adcgs_cpu_best(void)
{
#if defined(__x86_64__) && defined(HAVE_AVX512)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
        __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("fma"))
        return ADCGS_CPU_AVX512;
#endif
#if defined(__x86_64__) && defined(HAVE_AVX2)
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
        return ADCGS_CPU_AVX2;
#endif
    return ADCGS_CPU_SCALAR;
}

const char *adcgs_cpu_name(adcgs_cpu_level level)
{
    return (unsigned)level < LEVELS ? adcgs_cpu_names[level] : "unknown";
}

adcgs_status adcgs_cpu_resolve(adcgs_cpu_level asked, adcgs_cpu_level *level, adcgs_error *error)
{
    const adcgs_cpu_level best = adcgs_cpu_best();
    if ((unsigned)asked >= LEVELS)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "CPU level %d does not exist", (int)asked);
    if (asked > best)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "CPU level %s is not available: this machine and build have %s",
                          adcgs_cpu_name(asked), adcgs_cpu_name(best));
    *level = asked == ADCGS_CPU_AUTO ? best : asked;
    return ADCGS_OK;
}

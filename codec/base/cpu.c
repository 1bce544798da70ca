/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * CPU levels, and the known-answer test of the floating-point environment.
 * A build or a process that contracts, flushes subnormals, rounds otherwise or
 * keeps excess precision would draw other frames, so it is refused.
 */
#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#include "base/cpu.h"

#include <math.h>

static const char *const level_names[] = { "auto", "scalar", "avx2", "avx512" };

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
    return (unsigned)level < ADCGS_COUNTOF(level_names) ? level_names[level] : "unknown";
}

int adcgs_cpu_parse(const char *name, adcgs_cpu_level *level)
{
    for (size_t i = 0; i < ADCGS_COUNTOF(level_names); i++)
        if (!strcmp(name, level_names[i])) {
            *level = (adcgs_cpu_level)i;
            return 0;
        }
    return -1;
}

adcgs_status adcgs_cpu_resolve(adcgs_cpu_level asked, adcgs_cpu_level *level, adcgs_error *error)
{
    const adcgs_cpu_level best = adcgs_cpu_best();
    if ((unsigned)asked >= ADCGS_COUNTOF(level_names))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "CPU level %d does not exist", (int)asked);
    if (asked > best)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "CPU level %s is not available: this machine and build have %s",
                          adcgs_cpu_name(asked), adcgs_cpu_name(best));
    *level = asked == ADCGS_CPU_AUTO ? best : asked;
    return ADCGS_OK;
}

/* Operands come from volatile objects so that nothing is folded at compile time; the expressions themselves are plain, so
 * that they are compiled as the codec's are. */
adcgs_status adcgs_cpu_check_float(adcgs_error *error)
{
    volatile uint32_t bits[] = { 0x3f800001, 0x3f7ffffe, 0x3f800000, 0x00800000, 0x00000001, 0x33800000, 0x40000000, 0x40400000 };
    float v[ADCGS_COUNTOF(bits)];
    for (size_t i = 0; i < ADCGS_COUNTOF(bits); i++)
        v[i] = adcgs_bits_float(bits[i]);
    const float up = v[0], down = v[1], one = v[2], least_normal = v[3], least = v[4], half_ulp = v[5], two = v[6], three = v[7];
    if (adcgs_float_bits(up * down - one) != 0)
        return adcgs_fail(error, ADCGS_ERR_FPENV, "multiplications and additions are contracted or keep excess precision");
    if (adcgs_float_bits(fmaf(up, down, -one)) != 0xa8800000)
        return adcgs_fail(error, ADCGS_ERR_FPENV, "fmaf() rounds twice");
    if (adcgs_float_bits(least_normal * (one / two)) != 0x00400000 || adcgs_float_bits(least * two) != 2)
        return adcgs_fail(error, ADCGS_ERR_FPENV, "subnormal numbers are flushed to zero");
    if (adcgs_float_bits(one + half_ulp) != 0x3f800000 || adcgs_float_bits(up + half_ulp) != 0x3f800002 ||
        adcgs_float_bits(-up - half_ulp) != 0xbf800002 || adcgs_float_bits((one + half_ulp) - one) != 0)
        return adcgs_fail(error, ADCGS_ERR_FPENV, "rounding is not to nearest, ties to even");
    if (adcgs_float_bits(one / three) != 0x3eaaaaab || adcgs_float_bits(sqrtf(two)) != 0x3fb504f3)
        return adcgs_fail(error, ADCGS_ERR_FPENV, "division or square root is not correctly rounded");
    return ADCGS_OK;
}

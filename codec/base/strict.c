/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Check of strict binary32: single operations, then the known answers at every CPU level. */
#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#define ADCGS_LANES_ISA 0
#include "base/cpu_detect.h"
#include "base/digest.h"
#include "base/strict_kernels.h"

/* CRC-32C of the bits of all values, least significant byte first, function by function. */
#define ANSWER 0xb9edc3bcu

void adcgs_strict_scalar(float out[ADCGS_STRICT_FUNCTIONS][ADCGS_STRICT_SAMPLES], const float *x, const float *y, const float *z)
{
    answer(out, x, y, z);
}

/* Operands come from volatile objects, so that the compiler folds nothing. The expressions themselves are plain, so that they are
 * compiled like those of the codec. */
adcgs_status adcgs_strict_modes(adcgs_error *error)
{
    volatile uint32_t bits[] = {0x3f800001, 0x3f7ffffe, 0x3f800000, 0x00800000, 0x00000001,
                                0x33800000, 0x40000000, 0x40400000, 0x80000000};
    float v[ADCGS_COUNTOF(bits)];
    for (size_t i = 0; i < ADCGS_COUNTOF(bits); i++)
        v[i] = adcgs_bits_float(bits[i]);
    const float up = v[0], down = v[1], one = v[2], least_normal = v[3], least = v[4], half_ulp = v[5], two = v[6], three = v[7],
                minus_zero = v[8];
    if (adcgs_float_bits(one + half_ulp) != 0x3f800000 || adcgs_float_bits(up + half_ulp) != 0x3f800002 ||
        adcgs_float_bits(-up - half_ulp) != 0xbf800002)
        return adcgs_fail(error, ADCGS_ERR_FPENV, "rounding is not to nearest, ties to even");
    if (adcgs_float_bits(least_normal * (one / two)) != 0x00400000 || adcgs_float_bits(least * two) != 2)
        return adcgs_fail(error, ADCGS_ERR_FPENV, "subnormal numbers are flushed to zero");
    if (adcgs_float_bits(up * down - one) != 0 || adcgs_float_bits((one + half_ulp) - one) != 0)
        return adcgs_fail(error, ADCGS_ERR_FPENV, "multiplications and additions are contracted or keep excess precision");
    if (adcgs_float_bits(fmaf(up, down, -one)) != 0xa8800000)
        return adcgs_fail(error, ADCGS_ERR_FPENV, "fmaf() rounds twice");
    if (adcgs_float_bits(one / three) != 0x3eaaaaab || adcgs_float_bits(sqrtf(two)) != 0x3fb504f3)
        return adcgs_fail(error, ADCGS_ERR_FPENV, "division or square root is not correctly rounded");
    if (adcgs_float_bits(minus_zero + 0.0f) != 0)
        return adcgs_fail(error, ADCGS_ERR_FPENV, "the sign of zero is not kept");
    return ADCGS_OK;
}

static adcgs_status check_level(adcgs_cpu_level level, adcgs_strict_fn *fn, adcgs_error *error)
{
    _Alignas(64) float in[3][ADCGS_STRICT_SAMPLES];
    _Alignas(64) float out[ADCGS_STRICT_FUNCTIONS][ADCGS_STRICT_SAMPLES];
    uint32_t state = 1, crc = 0;
    uint8_t word[4];
    for (int i = 0; i < ADCGS_STRICT_SAMPLES; i++)
        for (int j = 0; j < 3; j++)
            in[j][i] = ((float)adcgs_strict_draw(&state, 65536) - 32767.5f) / 4096.0f;
    fn(out, in[0], in[1], in[2]);
    for (int f = 0; f < ADCGS_STRICT_FUNCTIONS; f++)
        for (int i = 0; i < ADCGS_STRICT_SAMPLES; i++) {
            adcgs_store_le32(word, adcgs_float_bits(out[f][i]));
            crc = adcgs_crc32c(crc, word, sizeof word);
        }
    if (crc != ANSWER)
        return adcgs_fail(error, ADCGS_ERR_FPENV,
                          "binary32 arithmetic (%s): known-answer test gives 0x%08x, expected 0x%08x: "
                          "check the flags of the build",
                          adcgs_cpu_name(level), (unsigned)crc, ANSWER);
    return ADCGS_OK;
}

adcgs_status adcgs_strict_check(adcgs_error *error)
{
    ADCGS_TRY(adcgs_strict_modes(error));
    ADCGS_TRY(check_level(ADCGS_CPU_SCALAR, adcgs_strict_scalar, error));
#ifdef HAVE_AVX2
    if (adcgs_cpu_best() >= ADCGS_CPU_AVX2)
        ADCGS_TRY(check_level(ADCGS_CPU_AVX2, adcgs_strict_avx2, error));
#endif
#ifdef HAVE_AVX512
    if (adcgs_cpu_best() >= ADCGS_CPU_AVX512)
        ADCGS_TRY(check_level(ADCGS_CPU_AVX512, adcgs_strict_avx512, error));
#endif
    return ADCGS_OK;
}

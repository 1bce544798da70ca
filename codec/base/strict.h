/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Checks that this build, in this process, computes strict binary32. Flags,
 * link-time start-up code and libraries can make it contract, flush subnormals,
 * round differently or reorder. Decoded frames would differ, so the decoder
 * refuses to open.
 */
#ifndef ADCGS_BASE_STRICT_H
#define ADCGS_BASE_STRICT_H

#include "base/base.h"

/** Number of samples and functions of the known answers. */
#define ADCGS_STRICT_SAMPLES 64
#define ADCGS_STRICT_FUNCTIONS 15

/** Check the modes of the calling thread by single operations: ADCGS_ERR_FPENV if wrong. Takes a few nanoseconds. */
adcgs_status adcgs_strict_modes(adcgs_error *error);
/** As above, then the known answers with the code of every CPU level that this machine has. Takes some microseconds. */
adcgs_status adcgs_strict_check(adcgs_error *error);

/** Compute the answers with a level's flags and lanes; x, y, z and out are 64-byte aligned. */
typedef void adcgs_strict_fn(float out[ADCGS_STRICT_FUNCTIONS][ADCGS_STRICT_SAMPLES], const float *x, const float *y,
                             const float *z);
adcgs_strict_fn adcgs_strict_scalar, adcgs_strict_avx2, adcgs_strict_avx512;

/** Generator of numbers for known-answer tests: returns the next number in [0, n). */
static inline uint32_t adcgs_strict_draw(uint32_t *state, uint32_t n)
{
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 8) % n;
}

#endif

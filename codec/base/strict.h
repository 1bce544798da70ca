/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Does this build, in this process, compute strict binary32? Flags, link-time
 * start-up code and libraries can make it contract, flush subnormals, round
 * otherwise or reorder; decoded frames would differ, so that is refused.
 */
#ifndef ADCGS_BASE_STRICT_H
#define ADCGS_BASE_STRICT_H

#include "base/base.h"

/** Samples and functions of the known answers. */
#define ADCGS_STRICT_SAMPLES 64
#define ADCGS_STRICT_FUNCTIONS 15

/** Single operations whose result shows the mode of the calling thread: ADCGS_ERR_FPENV if wrong. A few nanoseconds. */
adcgs_status adcgs_strict_modes(adcgs_error *error);
/** The same, then the known answers with the code of every CPU level that this machine has. Some microseconds. */
adcgs_status adcgs_strict_check(adcgs_error *error);

/** The answers as a level's flags and lanes compute them; x, y, z and out are 64-byte aligned. */
typedef void adcgs_strict_fn(float out[ADCGS_STRICT_FUNCTIONS][ADCGS_STRICT_SAMPLES], const float *x, const float *y,
                             const float *z);
adcgs_strict_fn adcgs_strict_scalar, adcgs_strict_avx2, adcgs_strict_avx512;

/** The generator of numbers for known-answer tests: the next of [0, n). */
static inline uint32_t adcgs_strict_draw(uint32_t *state, uint32_t n)
{
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 8) % n;
}

#endif

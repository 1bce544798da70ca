/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * From model and time to primitives (spec clause "Primitives"): prediction once
 * per model, deformation once per anchor and time.
 *
 * Slot order of primitives: anchors in groups of 64; within a group first by
 * primitive index k, then by anchor: slot = (group*K + k)*64 + (anchor mod 64).
 * The last group is padded; slots of padding and of masked-out primitives have
 * opacity 0.
 */
#ifndef ADCGS_SPLAT_SPLAT_H
#define ADCGS_SPLAT_SPLAT_H

#include "base/thread_pool.h"
#include "model/model.h"

typedef struct adcgs_splat adcgs_splat;

/** Compute the values that do not depend on time. model must outlive the result. pool, memory may be NULL. */
adcgs_status adcgs_splat_create(adcgs_splat **out, const adcgs_model *model, adcgs_cpu_level cpu, adcgs_pool *pool,
                                adcgs_memory *memory, adcgs_error *error);
void adcgs_splat_free(adcgs_splat **splat);
/** Seconds to normalised time: 0 at the model's start, 1 at the end of its crossfade (its end plus reach). NaN becomes 0. */
float adcgs_splat_time(const adcgs_model *model, double seconds);
/** Primitives at normalised time t in [0,1] (clamped). The arrays belong to splat and change with the next call. */
adcgs_status adcgs_splat_at(adcgs_splat *splat, float t, adcgs_primitives *out, adcgs_error *error);
/** MD5 over the existing primitives in order of anchor, then k (conformance point S). */
void adcgs_splat_digest(const adcgs_model *model, const adcgs_primitives *p, uint8_t digest[16]);

/** Compute f_p, 6*octaves values, for 64 anchors. x: [3][64] in [0,1) of the cube; out: [6*octaves][64]. */
void adcgs_position_code(float *out, const float *x, int octaves);

#endif

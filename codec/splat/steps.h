/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Steps that adapt to the anchor (spec clause "Reconstruction"). E_q gives every
 * anchor an index for each group of channels; the index selects a factor of the
 * group's steps. The stream carries nothing for it: the index follows from the
 * decoded f_v.
 */
#ifndef ADCGS_SPLAT_STEPS_H
#define ADCGS_SPLAT_STEPS_H

#include "model/model.h"

/** E_q prepared for evaluation; n = 0 if the parameters have none. */
typedef struct adcgs_steps {
    adcgs_e24 *net;
    int n, n_fv;
} adcgs_steps;

/** 2^(q/8) from the specification's table; q in -16..16. */
float adcgs_step_factor(int q);

adcgs_status adcgs_steps_init(adcgs_steps *steps, const adcgs_model *model, adcgs_cpu_level cpu, adcgs_memory *memory,
                              adcgs_error *error);
void adcgs_steps_clear(adcgs_steps *steps, adcgs_memory *memory);
/** Bytes that adcgs_steps_factors() needs, 64-byte aligned. */
size_t adcgs_steps_scratch(const adcgs_steps *steps);
/**
 * Factors for the 64 anchors from first on, a multiple of 64, whose f_v is final: [n][64], indexed by adcgs_group_steps(). Lanes
 * past the last anchor get 1. Does nothing if n = 0.
 */
void adcgs_steps_factors(const adcgs_steps *steps, const adcgs_model *model, uint32_t first, float (*factor)[ADCGS_LANES],
                         void *scratch);

#endif

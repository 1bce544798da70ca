/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The values of a recipe's models, which are coded while they are drawn at random. */
#ifndef ADCGS_CONFORMANCE_DRAW_H
#define ADCGS_CONFORMANCE_DRAW_H

#include "random_model.h"
#include "recipe_plan.h"

/** A random number from lo to hi. */
static inline int adcgs_draw_int(uint64_t *state, int lo, int hi)
{
    return (int)adcgs_random_range(state, lo, hi);
}

/** Check the recipe's commands "force". */
adcgs_status adcgs_draw_check(adcgs_plan *plan, adcgs_error *error);
/** Draw and code the values of a tier, slice by slice. Its positions, flags, bodies and tables are set. */
adcgs_status adcgs_draw_slices(adcgs_plan *plan, adcgs_model *m, adcgs_drawn_tier *out, adcgs_error *error);

#endif

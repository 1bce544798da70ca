/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Random recipes of valid streams: every branch of the syntax and of decoding within a few hundred seeds. */
#ifndef ADCGS_CONFORMANCE_RANDOM_RECIPE_H
#define ADCGS_CONFORMANCE_RANDOM_RECIPE_H

#include "recipe.h"

#include <stdio.h>

/** The recipe depends on the seed only. text, if not NULL, receives its lines. */
adcgs_status adcgs_random_recipe(adcgs_recipe *out, uint64_t seed, FILE *text, adcgs_error *error);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The manifest's entry of a vector: taken from the portable kernels on one thread, or checked against the recipe. */
#ifndef ADCGS_CONFORMANCE_ANSWERS_H
#define ADCGS_CONFORMANCE_ANSWERS_H

#include "recipe_plan.h"

#include <stdio.h>

/** Decode the vector, check that the result is the one its recipe names, and print its entry. */
adcgs_status adcgs_answers_print(FILE *out, const adcgs_plan *plan, const adcgs_buffer *file, adcgs_error *error);
/** The verdict at the start of an id: "good" of "good-area-feature"; "" if there is none. */
const char *adcgs_answers_verdict(const char *id);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The parts of a plan (session/plan.h): checks whether a part is present and valid, and joins all parts to a stream. */
#ifndef ADCGS_SESSION_PLAN_PARTS_H
#define ADCGS_SESSION_PLAN_PARTS_H

#include "session/plan.h"
#include "stream/stream.h"

/** Returns a plan's name without .json, the prefix of its parts' names. The caller frees it with free(). */
adcgs_status adcgs_plan_base(char **base, const char *path, adcgs_error *error);

/** Checks that the plan is of this version of the encoder. path: the plan's name for the message. */
adcgs_status adcgs_plan_check_version(const adcgs_plan *plan, const char *path, adcgs_error *error);

/**
 * Reads part `part`, from 0, into a stream that the caller clears in any case. *found: 0 if there is no such file.
 * ADCGS_ERR_DATA, naming the file, if it is damaged, or belongs to another plan, place or version.
 */
adcgs_status adcgs_plan_part_load(adcgs_stream *one, const adcgs_plan *plan, const char *base, uint32_t part, adcgs_cpu_level cpu,
                                  adcgs_pool *pool, int *found, adcgs_error *error);
/**
 * Reads the part's model, which adcgs_model_clear() frees. The part has to be present, since the next part is trained from it.
 */
adcgs_status adcgs_plan_part_model(adcgs_model *model, const adcgs_plan *plan, const char *base, uint32_t part,
                                   adcgs_cpu_level cpu, adcgs_pool *pool, adcgs_error *error);

/**
 * Joins all parts in stream, which the caller clears, also on failure. Each part has to be present and follow the previous one.
 */
adcgs_status adcgs_plan_join(adcgs_stream *stream, const adcgs_plan *plan, const char *base, adcgs_cpu_level cpu,
                             adcgs_pool *pool, adcgs_error *error);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The parts of a plan (encode/plan.h): whether one is there and right, and the stream of all. */
#ifndef ADCGS_TOOLS_PLAN_PARTS_H
#define ADCGS_TOOLS_PLAN_PARTS_H

#include "encode/plan.h"
#include "stream/stream.h"

/** A plan's name without .json: what names of its parts begin with. The caller frees it with free(). */
adcgs_status adcgs_plan_base(char **base, const char *path, adcgs_error *error);

/** Whether this program, or a part's, is the one that the plan was made by; path: for the message, of the plan. */
adcgs_status adcgs_plan_check_version(const adcgs_plan *plan, const char *path, adcgs_error *error);

/**
 * Read part `part`, from 0, into a stream that the caller clears, whatever is returned; *found: 0 if there is no such file.
 * ADCGS_ERR_DATA, naming the file, if it is damaged, or of another plan, place or version.
 */
adcgs_status adcgs_plan_part_load(adcgs_stream *one, const adcgs_plan *plan, const char *base, uint32_t part, adcgs_cpu_level cpu,
                                  adcgs_pool *pool, int *found, adcgs_error *error);
/** Its model, which adcgs_model_clear() frees; it has to be there, for the next part to be learnt from it. */
adcgs_status adcgs_plan_part_model(adcgs_model *model, const adcgs_plan *plan, const char *base, uint32_t part,
                                   adcgs_cpu_level cpu, adcgs_pool *pool, adcgs_error *error);

/** Put all parts together, in stream, cleared by the caller, also on failure. Each has to be there, and follow the one before. */
adcgs_status adcgs_plan_join(adcgs_stream *stream, const adcgs_plan *plan, const char *base, adcgs_cpu_level cpu,
                             adcgs_pool *pool, adcgs_error *error);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-enc --plan: makes a plan of a scene's segments, or trains one of its segments. */
#ifndef ADCGS_SESSION_ENC_PLAN_H
#define ADCGS_SESSION_ENC_PLAN_H

#include "scene/layouts/open.h"
#include "session/enc_run.h"

/**
 * Checks the given options with --plan, while cli has their table, and reports a mistake. before: the options before parsing.
 * \return -1 to continue, else the exit code
 */
int adcgs_enc_plan_check(const adcgs_cli *cli, const adcgs_enc_options *o, const adcgs_enc_options *before);

/** Writes the plan, job->o->plan, of a scene that is opened by the options; trains nothing. */
adcgs_status adcgs_enc_plan_make(adcgs_enc_job *job, const adcgs_scene_options *options, adcgs_error *error);

/**
 * Trains segment job->o->segment, from 1, as planned: from its checkpoint if there is one, and from the previous part if it
 * follows one. Reads only the segment's own images. Does nothing if the part is present already.
 */
adcgs_status adcgs_enc_plan_train(adcgs_enc_context *context, adcgs_enc_job *job, adcgs_error *error);

#endif

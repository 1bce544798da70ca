/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-enc --plan: a plan for the segments of a scene, and one segment learnt by it. */
#ifndef ADCGS_TOOLS_ENC_PLAN_H
#define ADCGS_TOOLS_ENC_PLAN_H

#include "layouts/open.h"
#include "tools/enc_run.h"

/**
 * Whether the options that were given go with --plan, while cli has their table; before: what they were before any was given. A
 * mistake is reported. \return -1 to go on, else the exit code
 */
int adcgs_enc_plan_check(const adcgs_cli *cli, const adcgs_enc_options *o, const adcgs_enc_options *before);

/** Write the plan, job->o->plan, of a scene that is opened as the options say; nothing is learnt. */
adcgs_status adcgs_enc_plan_make(adcgs_enc_job *job, const adcgs_scene_options *options, adcgs_error *error);

/**
 * Learn segment job->o->segment, from 1, as the plan says: from its checkpoint if there is one, from the part before if it
 * follows one. Of pictures, only its own are read. Nothing is done where its part is there already.
 */
adcgs_status adcgs_enc_plan_learn(adcgs_enc_watcher *watcher, adcgs_enc_job *job, adcgs_error *error);

#endif

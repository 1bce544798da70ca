/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-enc judges mechanisms on the scene at hand, before a long run (train/trial.h). */
#ifndef ADCGS_TOOLS_ENC_TRIALS_H
#define ADCGS_TOOLS_ENC_TRIALS_H

#include "tools/enc_run.h"

/**
 * Run the trials of the job's scene, before it is cut, note each mechanism that is dropped, and turn it off in the job's
 * configuration. A run that is resumed or finished from a state adopts the verdicts of that state instead.
 */
adcgs_status adcgs_enc_try(adcgs_enc_job *job, adcgs_enc_watcher *w, adcgs_error *error);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Tests mechanisms of adcgs-enc on the current scene, before a long run (train/trial/trial.h). */
#ifndef ADCGS_SESSION_ENC_TRIALS_H
#define ADCGS_SESSION_ENC_TRIALS_H

#include "session/enc_run.h"

/**
 * Runs the trials of the job's scene, before it is cut. Reports each dropped mechanism, and turns it off in the job's
 * configuration. A run that is resumed or finished from a state adopts the verdicts of that state instead.
 */
adcgs_status adcgs_enc_try(adcgs_enc_job *job, adcgs_enc_context *w, adcgs_error *error);

#endif

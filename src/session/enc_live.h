/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-enc --live: trains and writes segments while the footage of the next ones arrives. */
#ifndef ADCGS_SESSION_ENC_LIVE_H
#define ADCGS_SESSION_ENC_LIVE_H

#include "session/enc_run.h"

/**
 * Trains and writes the incoming footage until it ends. The job has options and configuration, but no scene. After a failure the
 * segments so far are ended as a stream. If that fails, as on a full disk, the output ends with the last complete segment.
 */
adcgs_status adcgs_enc_live(adcgs_enc_context *context, adcgs_enc_job *job, adcgs_error *error);

#endif

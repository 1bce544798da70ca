/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The log of a run (--log): JSON lines, as doc/json.md describes them. Without a log, these functions do nothing. */
#ifndef ADCGS_SESSION_ENC_LOG_H
#define ADCGS_SESSION_ENC_LOG_H

#include "session/enc_run.h"

/** The last report of progress. */
void adcgs_enc_log_last(adcgs_enc_context *w);
/** Once per run: the settings whose requested values the scene, a trial or another decision replaced. */
void adcgs_enc_log_settings(adcgs_enc_context *w);
/** At the end of a run: the reasons for the model's size. */
void adcgs_enc_log_decisions(adcgs_enc_context *w);

#endif

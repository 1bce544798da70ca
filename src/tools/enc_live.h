/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-enc --live: segments are learnt and written while the footage of the next ones comes. */
#ifndef ADCGS_TOOLS_ENC_LIVE_H
#define ADCGS_TOOLS_ENC_LIVE_H

#include "tools/enc_run.h"

/**
 * Learn what comes until it ends, and write it. The job has options and configuration, no scene. At a failure what was learnt so
 * far is ended as a stream; if that cannot be, as on a full disk, the output ends with the last whole segment.
 */
adcgs_status adcgs_enc_live(adcgs_enc_watcher *watcher, adcgs_enc_job *job, adcgs_error *error);

#endif

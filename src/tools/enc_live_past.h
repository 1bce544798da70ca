/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-enc --live --resume: what a run before has left of its stream, which goes on. */
#ifndef ADCGS_TOOLS_ENC_LIVE_PAST_H
#define ADCGS_TOOLS_ENC_LIVE_PAST_H

#include "encode/live.h"
#include "tools/enc_live_file.h"
#include "tools/enc_run.h"

/** Zero-initialise before use. */
typedef struct adcgs_enc_live_past {
    adcgs_model last;    /**< the last segment that is whole, not added yet: it may have to be learnt anew; n 0: none */
    uint32_t n;          /**< segments that were added */
    uint64_t bytes;      /**< of them */
    double key;          /**< seconds at which the last key among them begins */
} adcgs_enc_live_past;

/**
 * Read the stream that job->o->resume names, and begin one that goes on with it, to the file, which does not show it yet: its
 * segments as far as they are whole, but for the last. ADCGS_ERR_DATA if there is none.
 */
adcgs_status adcgs_enc_live_past_take(adcgs_enc_live_past *past, adcgs_encode_live *stream, adcgs_enc_live_file *file,
                                      uint32_t max_anchors, const adcgs_enc_job *job, adcgs_error *error);
/** Add the last one, too, unless what comes begins before it ends: then it is forgotten. INFINITY: nothing comes. */
adcgs_status adcgs_enc_live_past_end(adcgs_enc_live_past *past, adcgs_encode_live *stream, adcgs_enc_live_file *file,
                                     double begin, adcgs_error *error);
void adcgs_enc_live_past_clear(adcgs_enc_live_past *past);

#endif

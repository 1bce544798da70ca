/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-enc --live --resume: the stream of an earlier run, which continues. */
#ifndef ADCGS_SESSION_ENC_LIVE_RESUME_H
#define ADCGS_SESSION_ENC_LIVE_RESUME_H

#include "session/enc_live_file.h"
#include "session/enc_run.h"
#include "session/live_stream.h"

/** Zero-initialise before use. */
typedef struct adcgs_enc_live_resume {
    adcgs_model last; /**< the last complete segment, not added yet: it may have to be trained again; n 0: none */
    uint32_t n;       /**< added segments */
    uint64_t bytes;   /**< of the added segments */
    double key;       /**< seconds at which the last key among them begins */
} adcgs_enc_live_resume;

/**
 * Reads the stream job->o->resume, and begins a stream that continues it. Its complete segments, except the last, go to the file,
 * which does not show them yet. ADCGS_ERR_DATA if there are none.
 */
adcgs_status adcgs_enc_live_resume_read(adcgs_enc_live_resume *past, adcgs_encode_live *stream, adcgs_enc_live_file *file,
                                        uint32_t max_anchors, const adcgs_enc_job *job, adcgs_error *error);
/**
 * Adds the last segment, too, unless the next one begins before its end: then it is dropped. begin: INFINITY if nothing follows.
 */
adcgs_status adcgs_enc_live_resume_end(adcgs_enc_live_resume *past, adcgs_encode_live *stream, adcgs_enc_live_file *file,
                                       double begin, adcgs_error *error);
void adcgs_enc_live_resume_clear(adcgs_enc_live_resume *past);

#endif

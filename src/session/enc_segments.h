/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A scene in segments: its cuts, their dependencies, a run for each, and the stream of all. */
#ifndef ADCGS_SESSION_ENC_SEGMENTS_H
#define ADCGS_SESSION_ENC_SEGMENTS_H

#include "session/enc_run.h"

/** Cuts the job's scene every `seconds` seconds. If that gives more than one part, job->config becomes that of parts. */
adcgs_status adcgs_enc_cut(adcgs_enc_job *job, double seconds, adcgs_error *error);
/** Parts share their parameters, so all time tables have as many rows as the shortest part can have. */
void adcgs_enc_cut_config(adcgs_enc_job *job);

/** Selects the part to train, from 0: w->segment and the name of its state. */
adcgs_status adcgs_enc_segment_begin(adcgs_enc_context *context, uint32_t segment, adcgs_error *error);
/** Checks whether a part's stream of a run that this one continues is present. ADCGS_ERR_DATA, naming it, if it is another's. */
adcgs_status adcgs_enc_segment_find(adcgs_enc_context *context, const adcgs_enc_job *job, uint32_t segment, int *found,
                                    adcgs_error *error);
/**
 * Trains the part w->segment, from its checkpoint, w->state, if there is one and the run continues, and leaves its stream on the
 * disk.
 */
adcgs_status adcgs_enc_segment_train(adcgs_enc_context *context, const adcgs_enc_job *job, adcgs_time *spent, adcgs_error *error);
/** Trains the missing parts, one after the other, and leaves their streams on the disk. *spent grows by the training time. */
adcgs_status adcgs_enc_segments_train(adcgs_enc_context *context, const adcgs_enc_job *job, adcgs_time *spent,
                                      adcgs_error *error);
/** Writes the output from the parts' streams, and removes these. */
adcgs_status adcgs_enc_segments_write(adcgs_enc_context *context, const adcgs_enc_job *job, adcgs_time *spent,
                                      adcgs_error *error);

#endif

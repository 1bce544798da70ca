/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A scene in segments: where it is cut, which of them follow which, a run for each, and the stream of all. */
#ifndef ADCGS_TOOLS_ENC_SEGMENTS_H
#define ADCGS_TOOLS_ENC_SEGMENTS_H

#include "tools/enc_run.h"

/** Cut the job's scene every so many seconds. Where that gives more than one part, job->config becomes that of parts. */
adcgs_status adcgs_enc_cut(adcgs_enc_job *job, double seconds, adcgs_error *error);
/** Parts share their parameters, so all have a time table of as many rows as the shortest can have. */
void adcgs_enc_cut_config(adcgs_enc_job *job);

/** Make a part, from 0, the one that is learnt: w->segment and the name of its state. */
adcgs_status adcgs_enc_segment_begin(adcgs_enc_watcher *watcher, uint32_t segment, adcgs_error *error);
/** Whether a part's stream is there, of a run that this one goes on with. ADCGS_ERR_DATA, naming it, if it is another's. */
adcgs_status adcgs_enc_segment_find(adcgs_enc_watcher *watcher, const adcgs_enc_job *job, uint32_t segment, int *found,
                                    adcgs_error *error);
/**
 * Learn the part that w->segment says, from its checkpoint, w->state, if there is one and the run goes on, and leave its stream
 * on the disk.
 */
adcgs_status adcgs_enc_segment_learn(adcgs_enc_watcher *watcher, const adcgs_enc_job *job, adcgs_time *spent, adcgs_error *error);
/** Learn what is not there yet, part by part, and leave their streams on the disk. *spent: grows by what that takes. */
adcgs_status adcgs_enc_segments_learn(adcgs_enc_watcher *watcher, const adcgs_enc_job *job, adcgs_time *spent,
                                      adcgs_error *error);
/** Write the output from the parts' streams, and remove these. */
adcgs_status adcgs_enc_segments_write(adcgs_enc_watcher *watcher, const adcgs_enc_job *job, adcgs_time *spent,
                                      adcgs_error *error);

#endif

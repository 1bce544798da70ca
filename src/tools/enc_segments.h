/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A scene in segments: where it is cut, which of them follow which, a run for each, and the stream of all. */
#ifndef ADCGS_TOOLS_ENC_SEGMENTS_H
#define ADCGS_TOOLS_ENC_SEGMENTS_H

#include "tools/enc_run.h"

/** Cut the job's scene every so many seconds. Where that gives more than one part, job->config becomes that of parts. */
adcgs_status adcgs_enc_cut(adcgs_enc_job *job, double seconds, adcgs_error *error);
/** Parts share their parameters, so all have a time table of as many rows as the shortest can have. */
void adcgs_enc_cut_config(adcgs_enc_job *job);

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

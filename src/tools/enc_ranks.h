/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * adcgs-enc as several ranks (io/ranks.h): rank 0 hands out segments, those on which the most others wait first, as ranks become
 * free and what a segment is learnt from is done; it learns, too, in a thread of its own. What ranks say to each other are notes
 * of one size; models go by the parts' files (tools/enc_parts.h), on a file system that all of them see.
 */
#ifndef ADCGS_TOOLS_ENC_RANKS_H
#define ADCGS_TOOLS_ENC_RANKS_H

#include "io/ranks.h"
#include "tools/enc_run.h"

/** Threads of a rank: of the CPUs that it may use, its share among the ranks of its host. */
int adcgs_enc_ranks_threads(const adcgs_ranks *ranks);

/** How many segments can be learnt at a time, at most: the keys, or the one that is all of the scene. */
uint32_t adcgs_enc_ranks_keys(const adcgs_enc_job *job);
/** Say so, where ranks wait that could be of use. */
void adcgs_enc_ranks_say_idle(const adcgs_enc_job *job);
/** As rank 0: learn all segments that are not there yet. Says in one line how far all are. */
adcgs_status adcgs_enc_ranks_lead(adcgs_enc_watcher *watcher, const adcgs_enc_job *job, adcgs_time *spent, adcgs_error *error);
/** As rank 0: let the others go. */
void adcgs_enc_ranks_dismiss(const adcgs_ranks *ranks);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * adcgs-enc as several ranks (io/ranks.h): rank 0 hands out segments, those on which the most others wait first, as ranks become
 * free and what a segment is learnt from is done; it learns, too, in a thread of its own. What ranks say to each other are notes
 * of one size; models go by the parts' files (tools/enc_parts.h), on a file system that all of them see. Where there are more
 * ranks than segments, it is the first of a team that is handed one, and tells the others (tools/enc_team.h).
 */
#ifndef ADCGS_TOOLS_ENC_RANKS_H
#define ADCGS_TOOLS_ENC_RANKS_H

#include "io/ranks.h"
#include "tools/enc_run.h"

/** Threads of a rank: of the CPUs that it may use, its share among the ranks of its host. */
int adcgs_enc_ranks_threads(const adcgs_ranks *ranks);

/** As any rank that takes part, once it is known how many segments there are: find to those that learn together (enc_team.h). */
adcgs_status adcgs_enc_ranks_gather(adcgs_enc_watcher *watcher, const adcgs_enc_job *job, adcgs_error *error);
/** As one of those that learn a scene which is not cut: rank 0 speaks for all. Without ranks it does nothing. */
void adcgs_enc_ranks_whole(adcgs_enc_watcher *watcher, const adcgs_enc_job *job);

/** As rank 0: learn all segments that are not there yet. Says in one line how far all are. */
adcgs_status adcgs_enc_ranks_lead(adcgs_enc_watcher *watcher, const adcgs_enc_job *job, adcgs_time *spent, adcgs_error *error);
/** As rank 0: let the others go. */
void adcgs_enc_ranks_dismiss(const adcgs_ranks *ranks);

#endif

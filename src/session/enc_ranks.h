/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * adcgs-enc as several ranks (net/ranks.h). Rank 0 hands out segments as ranks become free and the segments' predecessors are
 * done; segments on which the most others wait come first. Rank 0 trains, too, in a thread of its own. Ranks send each other
 * notes of one size. Models go through the parts' files (session/enc_parts.h), on a shared file system. If there are more ranks
 * than segments, the first rank of a team receives a segment, and informs the others (session/enc_team.h).
 */
#ifndef ADCGS_SESSION_ENC_RANKS_H
#define ADCGS_SESSION_ENC_RANKS_H

#include "net/ranks.h"
#include "session/enc_run.h"

/** Threads of a rank: its share of its CPUs among the ranks of its host. */
int adcgs_enc_ranks_threads(const adcgs_ranks *ranks);

/** For any participating rank, once the number of segments is known: forms the teams that train together (enc_team.h). */
adcgs_status adcgs_enc_ranks_gather(adcgs_enc_context *context, const adcgs_enc_job *job, adcgs_error *error);
/** For a rank that trains a scene that is not cut: rank 0 reports for all. Does nothing without ranks. */
void adcgs_enc_ranks_whole(adcgs_enc_context *context, const adcgs_enc_job *job);

/** For rank 0: trains all segments that are not present yet. Shows the progress of all ranks in one line. */
adcgs_status adcgs_enc_ranks_lead(adcgs_enc_context *context, const adcgs_enc_job *job, adcgs_time *spent, adcgs_error *error);
/** For rank 0: dismisses the others. */
void adcgs_enc_ranks_dismiss(const adcgs_ranks *ranks);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Runs that learn the same model together, each in a process of its own: they share the looks of an iteration and do all else
 * alike, so that nobody needs to be sent parameters. Who brings them together gives each run a team; without one it learns alone.
 */
#ifndef ADCGS_TRAIN_TEAM_H
#define ADCGS_TRAIN_TEAM_H

#include "io/ranks.h"

typedef struct adcgs_team {
    int rank, size; /**< rank 0 is the first, who says when to stop; at most ADCGS_TREE_MOST */
    /** Send and receive parts, by ranks of the team; done when it returns. */
    adcgs_status (*swap)(void *user, const adcgs_ranks_part *out, int n_out, const adcgs_ranks_part *in, int n_in,
                         adcgs_error *error);
    void *user;
} adcgs_team;

/** What the first has is what all have then. Without a team (NULL) it is. */
adcgs_status adcgs_team_tell(const adcgs_team *team, void *data, size_t bytes, adcgs_error *error);
/** Of data, rank r has bytes at[r] to at[r + 1]; all have all of it then. at: [size + 1] */
adcgs_status adcgs_team_gather(const adcgs_team *team, void *data, const size_t *at, adcgs_error *error);
/** The same where each has so many bytes. */
adcgs_status adcgs_team_gather_each(const adcgs_team *team, void *data, size_t bytes, adcgs_error *error);

#endif

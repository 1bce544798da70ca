/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Runs that train the same model together, each in its own process. They share the view passes of an iteration and do everything
 * else identically, so no parameters are sent. The caller gives each run a team; without one it trains alone.
 */
#ifndef ADCGS_TRAIN_TEAM_TEAM_H
#define ADCGS_TRAIN_TEAM_TEAM_H

#include "net/ranks.h"

typedef struct adcgs_team {
    int rank, size; /**< rank 0 decides when to stop; size: at most ADCGS_TREE_MOST */
    /** Sends and receives parts, addressed by ranks of the team; complete when it returns. */
    adcgs_status (*swap)(void *user, const adcgs_ranks_part *out, int n_out, const adcgs_ranks_part *in, int n_in,
                         adcgs_error *error);
    void *user;
} adcgs_team;

/** Broadcasts data from rank 0. Does nothing without a team (NULL). */
adcgs_status adcgs_team_broadcast(const adcgs_team *team, void *data, size_t bytes, adcgs_error *error);
/** Gathers data: rank r contributes bytes at[r] to at[r + 1], and all ranks receive the whole. at: [size + 1] */
adcgs_status adcgs_team_gather(const adcgs_team *team, void *data, const size_t *at, adcgs_error *error);
/** The same with equal sizes of `bytes`. */
adcgs_status adcgs_team_gather_each(const adcgs_team *team, void *data, size_t bytes, adcgs_error *error);

#endif

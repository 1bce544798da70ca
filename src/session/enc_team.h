/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Ranks of adcgs-enc that train a segment together: the formation of teams, and the trainer's team (train/team/team.h) on top
 * of ranks (net/ranks.h). Each team consists of consecutive ranks, which mostly are on one host.
 */
#ifndef ADCGS_SESSION_ENC_TEAM_H
#define ADCGS_SESSION_ENC_TEAM_H

#include "train/team/team.h"

#include <adcgs/cpu.h>

/** Zero-initialise: no rank trains together with another. */
typedef struct adcgs_enc_team {
    adcgs_team team; /**< size 1: the rank trains alone; 0: it has nothing to do */
    const adcgs_ranks *ranks;
    int first;                       /**< the team's first rank */
    char (*hosts)[ADCGS_RANKS_HOST]; /**< [team.size] */
    /** Called once if the run is interrupted while it waits for another rank; or NULL. */
    void (*late)(void *user, int rank, const char *host);
    void *late_user;
    double interrupted; /**< time of the interrupt; 0: none */
} adcgs_enc_team;

/**
 * Forms the team of this rank, if `at_once` segments are trained concurrently, with `batch` views per iteration. With one view,
 * or at most as many ranks as segments, each rank trains alone.
 */
void adcgs_enc_team_form(adcgs_enc_team *team, const adcgs_ranks *ranks, uint32_t batch, uint32_t at_once);
/** Number of ranks that are busy in that case. */
int adcgs_enc_team_busy(const adcgs_ranks *ranks, uint32_t batch, uint32_t at_once);
/** Exchanges the hosts of the team: all need kernels of this level. */
adcgs_status adcgs_enc_team_meet(adcgs_enc_team *team, adcgs_cpu_level level, adcgs_error *error);
void adcgs_enc_team_clear(adcgs_enc_team *team);

/** For the trainer. */
static inline const adcgs_team *adcgs_enc_team_of(const adcgs_enc_team *team)
{
    return team->team.size > 1 ? &team->team : NULL;
}

/** True if another rank reports, logs and saves the training of this one. */
static inline int adcgs_enc_team_follows(const adcgs_enc_team *team)
{
    return team->team.size > 1 && team->team.rank > 0;
}

/** Sums a value over the team, for its first rank. */
adcgs_status adcgs_enc_team_sum(const adcgs_enc_team *team, double *value, adcgs_error *error);

#endif

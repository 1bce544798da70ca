/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Ranks of adcgs-enc that learn a segment together: who is with whom, and how the trainer's team (train/team.h) goes by ranks
 * (io/ranks.h). Each team is of ranks one behind the other, which mostly are on one host.
 */
#ifndef ADCGS_TOOLS_ENC_TEAM_H
#define ADCGS_TOOLS_ENC_TEAM_H

#include "train/team.h"

#include <adcgs/cpu.h>

/** Zero-initialise: nobody learns anything together. */
typedef struct adcgs_enc_team {
    adcgs_team team; /**< size 1: the rank learns alone; 0: it has nothing to do */
    const adcgs_ranks *ranks;
    int first;                     /**< the rank that is the team's first */
    char (*hosts)[ADCGS_RANKS_HOST]; /**< [team.size] */
    /** Told once that the run was interrupted while it waits for another rank; or NULL. */
    void (*late)(void *user, int rank, const char *host);
    void *late_user;
    double interrupted; /**< when; 0: it was not */
} adcgs_enc_team;

/**
 * The team of this rank, where `at_once` segments are learnt at a time, from `batch` views to an iteration: with one, or where
 * there are no more ranks than segments, each rank learns alone.
 */
void adcgs_enc_team_form(adcgs_enc_team *team, const adcgs_ranks *ranks, uint32_t batch, uint32_t at_once);
/** How many of the ranks have something to do then. */
int adcgs_enc_team_busy(const adcgs_ranks *ranks, uint32_t batch, uint32_t at_once);
/** Learn who the others are: all have to have kernels of this level. */
adcgs_status adcgs_enc_team_meet(adcgs_enc_team *team, adcgs_cpu_level level, adcgs_error *error);
void adcgs_enc_team_clear(adcgs_enc_team *team);

/** For the trainer. */
static inline const adcgs_team *adcgs_enc_team_of(const adcgs_enc_team *team)
{
    return team->team.size > 1 ? &team->team : NULL;
}

/** Whether another rank says, logs and saves what this one learns. */
static inline int adcgs_enc_team_follows(const adcgs_enc_team *team)
{
    return team->team.size > 1 && team->team.rank > 0;
}

/** The sum of what each has, for the first. */
adcgs_status adcgs_enc_team_sum(const adcgs_enc_team *team, double *value, adcgs_error *error);

#endif

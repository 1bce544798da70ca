/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Ranks of adcgs-enc that train a segment together. */
#include "config.h"

#include "session/enc_team.h"

#include "base/cpu_detect.h"
#include "cli/cli.h"
#include "system/interrupt.h"
#include "train/team/tree_sum.h"

#include <math.h>
#include <sched.h>
#include <stdio.h>
#include <time.h>

/*
 * YIELDS: checks before a wait becomes long. NAP: nanoseconds between later checks. LONG_NAP: nanoseconds after NAPS checks,
 * since the awaited rank is then busy with something else. Chosen by hand, not measured.
 */
enum { YIELDS = 100, NAP = 50000, NAPS = 1000, LONG_NAP = 1000000 };
/* Seconds after an interrupt: until the awaited rank is named, and until it counts as gone; chosen by hand, not measured. */
static const double NAMED_AFTER = 0.3, GONE_AFTER = 30;

/* ---- Formation of teams ---- */

static int teams_of(const adcgs_ranks *r, uint32_t batch, uint32_t at_once)
{
    return batch > 1 && at_once < (uint32_t)r->size ? (int)at_once : r->size;
}

/** The first rank of a team; teams: their number. */
static int first_of(const adcgs_ranks *r, int team, int teams)
{
    return (int)((int64_t)r->size * team / teams);
}

static int size_of(const adcgs_ranks *r, uint32_t batch, int team, int teams)
{
    return (int)ADCGS_MIN((uint32_t)(first_of(r, team + 1, teams) - first_of(r, team, teams)), batch);
}

void adcgs_enc_team_form(adcgs_enc_team *t, const adcgs_ranks *r, uint32_t batch, uint32_t at_once)
{
    const int teams = teams_of(r, batch, at_once);
    int team = 0;
    while (first_of(r, team + 1, teams) <= r->rank)
        team++;
    t->ranks = r;
    t->first = first_of(r, team, teams);
    t->team.rank = r->rank - t->first;
    t->team.size = size_of(r, batch, team, teams);
    if (t->team.rank >= t->team.size)
        t->team.rank = t->team.size = 0;
}

int adcgs_enc_team_busy(const adcgs_ranks *r, uint32_t batch, uint32_t at_once)
{
    const int teams = teams_of(r, batch, at_once);
    int busy = 0;
    for (int team = 0; team < teams && (uint32_t)team < at_once; team++)
        busy += size_of(r, batch, team, teams);
    return busy;
}

/* ---- Swaps ---- */

/** Handles an interrupt of a waiting rank: other ranks may be gone, or may be stopping like this one. */
static adcgs_status doubt(adcgs_enc_team *t, int missing, adcgs_error *error)
{
    const char *const host = t->hosts ? t->hosts[missing - t->first] : "another host";
    if (!adcgs_interrupted())
        return ADCGS_OK;
    if (!(t->interrupted > 0))
        t->interrupted = adcgs_seconds();
    const double since = adcgs_seconds() - t->interrupted;
    if (since > NAMED_AFTER && t->late) {
        t->late(t->late_user, missing, host);
        t->late = NULL;
    }
    return since < GONE_AFTER ? ADCGS_OK
                              : adcgs_fail(error, ADCGS_ERR_IO, "interrupted; rank %d on %s does not answer", missing, host);
}

static adcgs_status swap(void *user, const adcgs_ranks_part *out, int n_out, const adcgs_ranks_part *in, int n_in,
                         adcgs_error *error)
{
    adcgs_enc_team *const t = user;
    int missing = t->first;
    ADCGS_TRY(adcgs_ranks_swap(t->ranks, t->first, out, n_out, in, n_in, error));
    for (int looks = 0; !adcgs_ranks_swapped(t->ranks, &missing);) {
        if (looks++ < YIELDS) {
            sched_yield();
            continue;
        }
        ADCGS_TRY(doubt(t, missing, error));
        nanosleep(&(struct timespec){0, looks < YIELDS + NAPS ? NAP : LONG_NAP}, NULL);
    }
    return ADCGS_OK;
}

typedef struct card {
    int32_t level;
    char host[ADCGS_RANKS_HOST];
} card;

adcgs_status adcgs_enc_team_meet(adcgs_enc_team *t, adcgs_cpu_level level, adcgs_error *error)
{
    card cards[ADCGS_TREE_MOST] = {{.level = 0}};
    if (t->team.size < 2)
        return ADCGS_OK;
    t->team.swap = swap;
    t->team.user = t;
    cards[t->team.rank].level = (int32_t)level;
    memcpy(cards[t->team.rank].host, t->ranks->host, sizeof cards->host);
    ADCGS_TRY(adcgs_team_gather_each(&t->team, cards, sizeof *cards, error));
    t->hosts = adcgs_alloc(NULL, (size_t)t->team.size, sizeof *t->hosts, error);
    if (!t->hosts)
        return adcgs_alloc_status(error);
    for (int i = 0; i < t->team.size; i++) {
        memcpy(t->hosts[i], cards[i].host, sizeof *t->hosts);
        if (cards[i].level != cards[0].level)
            return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED,
                              "rank %d on %s has kernels of level %s, rank %d those of %s, which "
                              "train differently: give --cpu",
                              t->first + i, cards[i].host, adcgs_cpu_name((adcgs_cpu_level)cards[i].level), t->first,
                              adcgs_cpu_name((adcgs_cpu_level)cards[0].level));
    }
    return ADCGS_OK;
}

void adcgs_enc_team_clear(adcgs_enc_team *t)
{
    adcgs_free(NULL, t->hosts);
    t->hosts = NULL;
}

adcgs_status adcgs_enc_team_sum(const adcgs_enc_team *t, double *value, adcgs_error *error)
{
    double values[ADCGS_TREE_MOST];
    if (t->team.size < 2)
        return ADCGS_OK;
    values[t->team.rank] = *value;
    ADCGS_TRY(adcgs_team_gather_each(&t->team, values, sizeof *values, error));
    *value = 0;
    for (int i = 0; i < t->team.size; i++)
        *value += values[i];
    return ADCGS_OK;
}

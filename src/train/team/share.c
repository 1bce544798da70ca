/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Sharing of an iteration between the runs of a team. */
#include "train/team/share.h"

typedef struct sharing {
    adcgs_trainer *t;
    const adcgs_team *team;
    size_t slice[ADCGS_TREE_MOST + 1]; /* start of each rank's slice */
    size_t own;                        /* length of this rank's slice */
    float *room;                       /* [own] for each part of other ranks */
} sharing;

uint32_t adcgs_share_place(const adcgs_trainer *t, int rank)
{
    const uint32_t n = t->config.batch;
    return t->team ? n * (uint32_t)rank / (uint32_t)t->team->size : rank ? n : 0;
}

/** The partial sums that result from a rank's places. */
static int parts_of(const adcgs_trainer *t, int rank, adcgs_tree_part *parts)
{
    int n = 0;
    for (uint32_t i = adcgs_share_place(t, rank); i < adcgs_share_place(t, rank + 1); i++)
        n = adcgs_tree_add(parts, n, (adcgs_tree_part){i, 1, NULL}, 0);
    return n;
}

static adcgs_status begin_sharing(sharing *s, adcgs_trainer *t, adcgs_error *error)
{
    adcgs_train_batch *const b = &t->batch;
    const size_t n = (size_t)t->team->size;
    adcgs_tree_part parts[ADCGS_TREE_PARTS];
    *s = (sharing){.t = t, .team = t->team};
    for (size_t i = 0; i <= n; i++)
        s->slice[i] = b->size * i / n;
    s->own = s->slice[t->team->rank + 1] - s->slice[t->team->rank];
    size_t others = 0;
    for (int r = 0; r < t->team->size; r++)
        others += r == t->team->rank ? 0 : (size_t)parts_of(t, r, parts);
    if (!b->room)
        b->room = adcgs_alloc(NULL, others * s->own, sizeof *b->room, error);
    s->room = b->room;
    return s->room ? ADCGS_OK : adcgs_alloc_status(error);
}

/** Exchanges partial sums: each rank receives its slice of all parts. */
static adcgs_status swap_slices(const sharing *s, const adcgs_tree_part *own, int n_own, adcgs_error *error)
{
    adcgs_ranks_part out[2 * ADCGS_TREE_MOST], in[ADCGS_TREE_MOST];
    adcgs_tree_part parts[ADCGS_TREE_PARTS];
    float *to = s->room;
    int n_out = 0, n_in = 0;
    for (int r = 0; r < s->team->size; r++) {
        if (r == s->team->rank)
            continue;
        for (int i = 0; i < n_own; i++)
            out[n_out++] = (adcgs_ranks_part){r, own[i].sum + s->slice[r], (s->slice[r + 1] - s->slice[r]) * sizeof *to};
        for (int i = parts_of(s->t, r, parts); i > 0; i--, to += s->own)
            in[n_in++] = (adcgs_ranks_part){r, to, s->own * sizeof *to};
    }
    return s->team->swap(s->team->user, out, n_out, in, n_in, error);
}

/** Sums this run's slice of all parts. */
static void sum_slice(const sharing *s, const adcgs_tree_part *own, int n_own)
{
    adcgs_tree_part all[ADCGS_TREE_PARTS], parts[ADCGS_TREE_PARTS];
    float *from = s->room, *const to = own[0].sum + s->slice[s->team->rank];
    int n = 0;
    for (int r = 0; r < s->team->size; r++) {
        const int is_own = r == s->team->rank, n_parts = is_own ? n_own : parts_of(s->t, r, parts);
        for (int i = 0; i < n_parts; i++) {
            adcgs_tree_part next = is_own ? own[i] : parts[i];
            next.sum = is_own ? own[i].sum + s->slice[r] : from;
            from += is_own ? 0 : s->own;
            n = adcgs_tree_add(all, n, next, s->own);
        }
    }
    adcgs_tree_end(all, n, s->own);
    if (all[0].sum != to)
        memcpy(to, all[0].sum, s->own * sizeof *to);
}

adcgs_status adcgs_share(adcgs_trainer *t, const adcgs_tree_part *own, int n_own, adcgs_error *error)
{
    sharing s;
    size_t at[ADCGS_TREE_MOST + 1];
    ADCGS_TRY(begin_sharing(&s, t, error));
    for (int r = 0; r <= t->team->size; r++)
        at[r] = adcgs_share_place(t, r) * sizeof *t->batch.results;
    ADCGS_TRY(adcgs_team_gather(t->team, t->batch.results, at, error));
    ADCGS_TRY(swap_slices(&s, own, n_own, error));
    sum_slice(&s, own, n_own);
    for (int r = 0; r <= t->team->size; r++)
        at[r] = s.slice[r] * sizeof *own[0].sum;
    return adcgs_team_gather(t->team, own[0].sum, at, error);
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The views of an iteration. */
#include "train/batch.h"

#include "train/team/share.h"
#include "train/view_pass.h"

/* ---- Sums: all gradients, followed by the statistics ---- */

static size_t gradients_of(const adcgs_fmodel *f)
{
    size_t n = 0;
    for (int i = 0; i < ADCGS_P_COUNT; i++)
        n += f->param[i].n;
    return n;
}

/** Prepares one more sum and clears its statistics. Buffers of another size, from before a change of the anchors, are freed. */
static adcgs_status begin_sum(adcgs_trainer *t, int i, adcgs_train_stats *stats, adcgs_error *error)
{
    adcgs_train_batch *const b = &t->batch;
    const size_t gradients = gradients_of(t->f), size = gradients + adcgs_train_stats_size(t->f);
    if (size != b->size)
        adcgs_train_batch_forget(b);
    b->size = size;
    if (!b->sum[i])
        b->sum[i] = adcgs_alloc(NULL, size, sizeof *b->sum[i], error);
    if (!b->sum[i])
        return adcgs_alloc_status(error);
    *stats = adcgs_train_stats_at(b->sum[i] + gradients, t->f);
    memset(stats->weight, 0, (size - gradients) * sizeof *stats->weight);
    return ADCGS_OK;
}

/** Moves the model's gradients to a buffer and clears them. */
static void take_gradients(adcgs_fmodel *f, float *to)
{
    for (int i = 0; i < ADCGS_P_COUNT; to += f->param[i++].n) {
        memcpy(to, f->param[i].g, f->param[i].n * sizeof *to);
        memset(f->param[i].g, 0, f->param[i].n * sizeof *to);
    }
}

/** Sets the model's gradients to the mean, and adds the statistics to those of the run. */
static void give(adcgs_trainer *t, const float *sum)
{
    const float share = 1 / (float)t->config.batch;
    for (int i = 0; i < ADCGS_P_COUNT; sum += t->f->param[i++].n)
        for (size_t j = 0; j < t->f->param[i].n; j++)
            t->f->param[i].g[j] = share * sum[j];
    for (size_t i = 0; i < adcgs_train_stats_size(t->f); i++)
        t->stats.weight[i] += sum[i];
    t->stats.n += t->config.batch;
}

/* ---- Means for rounding: each rounding pass updates them from the state that the previous iteration left ---- */

/** The means of a group of parameters; after all groups, the factors of adaptive steps. \return their number */
static size_t means_at(const adcgs_trainer *t, int i, float **at)
{
    *at = i < ADCGS_P_ANCHOR ? t->pass->mu[i] : t->pass->factor;
    return i < ADCGS_P_ANCHOR ? t->f->param[i].n : (size_t)t->f->groups * ADCGS_LANES * (size_t)adcgs_params_steps(&t->f->params);
}

static adcgs_status keep_means(adcgs_trainer *t, adcgs_error *error)
{
    float *at, *to;
    size_t n = 0;
    for (int i = 0; i <= ADCGS_P_ANCHOR; i++)
        n += means_at(t, i, &at);
    if (!t->batch.means)
        t->batch.means = adcgs_alloc(NULL, n, sizeof *to, error);
    if (!t->batch.means)
        return adcgs_alloc_status(error);
    to = t->batch.means;
    for (int i = 0; i <= ADCGS_P_ANCHOR; i++, to += n) {
        n = means_at(t, i, &at);
        memcpy(to, at, n * sizeof *to);
    }
    return ADCGS_OK;
}

static void put_means_back(adcgs_trainer *t)
{
    const float *from = t->batch.means;
    float *at;
    for (int i = 0; i <= ADCGS_P_ANCHOR; i++) {
        const size_t n = means_at(t, i, &at);
        memcpy(at, from, n * sizeof *at);
        from += n;
    }
}

/* ---- View passes ---- */

/** Runs the view passes first..end-1. *n: number of partial sums that result. */
static adcgs_status run_passes(adcgs_trainer *t, double progress, uint32_t first, uint32_t end, adcgs_tree_part *parts, int *n,
                               adcgs_error *error)
{
    adcgs_train_stats stats;
    *n = 0;
    for (uint32_t i = first; i < end; i++) {
        ADCGS_TRY(begin_sum(t, *n, &stats, error));
        if (t->stage.rounding && i == first)
            ADCGS_TRY(keep_means(t, error));
        else if (t->stage.rounding)
            put_means_back(t);
        ADCGS_TRY(adcgs_view_pass(t, progress, t->run.iteration * t->config.batch + i, &stats, &t->batch.results[i], error));
        take_gradients(t->f, t->batch.sum[*n]);
        *n = adcgs_tree_add(parts, *n, (adcgs_tree_part){i, 1, t->batch.sum[*n]}, t->batch.size);
    }
    return ADCGS_OK;
}

static adcgs_status look_at_many(adcgs_trainer *t, double progress, adcgs_error *error)
{
    adcgs_tree_part parts[ADCGS_TREE_PARTS];
    const int rank = t->team ? t->team->rank : 0;
    int n;
    ADCGS_TRY(run_passes(t, progress, adcgs_share_place(t, rank), adcgs_share_place(t, rank + 1), parts, &n, error));
    if (t->team)
        ADCGS_TRY(adcgs_share(t, parts, n, error));
    else
        adcgs_tree_end(parts, n, t->batch.size);
    give(t, parts[0].sum);
    return ADCGS_OK;
}

adcgs_status adcgs_batch_run(adcgs_trainer *t, double progress, adcgs_error *error)
{
    const uint32_t n = t->config.batch;
    memset(t->batch.results, 0, n * sizeof *t->batch.results);
    ADCGS_TRY(n > 1 ? look_at_many(t, progress, error)
                    : adcgs_view_pass(t, progress, t->run.iteration, &t->stats, t->batch.results, error));
    for (uint32_t i = 0; i < n; i++)
        adcgs_view_pass_apply(t, progress, t->run.iteration * n + i, &t->batch.results[i]);
    return ADCGS_OK;
}

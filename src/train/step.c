/* SPDX-License-Identifier: BSD-2-Clause */
/** \file One iteration. */
#include "train/step.h"

#include "fmodel/from_model.h"
#include "fmodel/weight_rate.h"
#include "train/batch.h"
#include "train/stage_table.h"
#include "train/view_pass.h"

#include <math.h>

enum {
    CHECK_EVERY = 10,  /* iterations between exact widenings of quantiser steps; chosen by hand, not measured */
    ADAM_PIECE = 16384 /* values of a job; chosen by hand, not measured */
};
#define ADAM_BETA1 0.9f   /* decay of the mean gradient; literature (Kingma and Ba 2015) */
#define ADAM_BETA2 0.999f /* decay of the mean square; likewise; 0.99 loses 0.1 dB on demo (doc/log/training.md) */
#define KEEP_EARLY 0.9    /* decay of the running means in the first EARLY iterations; chosen by hand, not measured */
#define KEEP 0.99         /* and later; chosen by hand, not measured */
#define EARLY 100         /* iterations; chosen by hand, not measured */
#define BITS_KEEP 0.95    /* decay of the running mean of bits; chosen by hand, not measured */
#define BITS_NEW 0.05     /* 1 - BITS_KEEP */

static int is_network(int group)
{
    return group >= ADCGS_P_ANCHOR;
}

typedef struct adam_job {
    adcgs_trainer *t;
    int group;
    float lr, c1, c2;
} adam_job;

static void adam_piece(void *arg, int i, int thread)
{
    (void)thread;
    const adam_job *job = arg;
    adcgs_param *p = &job->t->f->param[job->group];
    const size_t at = (size_t)i * ADAM_PIECE, n = p->n - at < ADAM_PIECE ? p->n - at : ADAM_PIECE;
    job->t->pass->dsp.adam(p->p + at, p->g + at, p->m + at, p->v + at, n, job->lr, job->c1, job->c2);
}

/**
 * Loss per bit of a network's weights. It is 0 until networks have taken shape, because weights near 0 could not grow. The
 * weights are coded once for the whole run. After a run has met a size, the networks keep their share of it.
 */
static float weight_price(const adcgs_trainer *t, double progress)
{
    const adcgs_train_config *c = &t->config;
    const int landed = t->stage.frozen && c->target == ADCGS_TARGET_SIZE;
    return adcgs_stage_has_begun(c, ADCGS_STAGE_PRUNE_UNITS, progress) && !landed ? c->network_rate * (float)adcgs_cost_of_bit(t)
                                                                                  : 0;
}

/**
 * Moves uncoded values with the mean: if only the mean of a channel is coded, nothing else holds its values. If bits are spent on
 * the channel again later, they would start far from the mean.
 */
static void follow_means(adcgs_trainer *t)
{
    for (int i = 0; i < ADCGS_P_ANCHOR; i++) {
        const size_t n = (size_t)adcgs_fmodel_rows(t->f, i) * t->f->groups * ADCGS_LANES;
        const float *mu = t->pass->mu[i], *used = t->pass->used[i];
        float *p = t->f->param[i].p;
        for (size_t j = 0; j < n; j++)
            p[j] = adcgs_mean_alone(mu[j]) ? used[j] : p[j];
    }
}

/** Frozen anchors have zero gradient, so the optimiser leaves them unchanged. */
static void hold_settled(adcgs_fmodel *f, int group)
{
    const size_t rows = (size_t)adcgs_fmodel_rows(f, group);
    float *g = f->param[group].g;
    for (size_t tile = 0; tile < rows * f->groups; tile++, g += ADCGS_LANES)
        for (size_t l = 0; l < ADCGS_LANES; l++)
            g[l] *= f->trainable[tile / rows * ADCGS_LANES + l];
}

/**
 * True if a group is optimised. Motion groups start with their first nonzero gradient. Their Adam moments start then and are
 * corrected by the steps since. Corrected by the run's iterations, the first steps would be many times too long and could destroy
 * the scene in a long run. Entropy networks also start late, but profit from long first steps: bits fall sooner.
 */
static int begins(const adcgs_param *p, int group)
{
    const int motion = group == ADCGS_P_OMEGA || group == ADCGS_P_VARPI || group == ADCGS_P_TIME;
    size_t i = 0;
    while (motion && !p->steps && i < p->n && p->g[i] == 0)
        i++;
    return i < p->n;
}

static void update(adcgs_trainer *t, double progress)
{
    const float price = weight_price(t, progress);
    for (int i = 0; i < ADCGS_P_COUNT; i++) {
        adcgs_param *p = &t->f->param[i];
        const int entropy = i == ADCGS_P_ETA_PRIOR || i >= ADCGS_P_E_FV;
        if ((t->stage.frozen && (!is_network(i) || entropy)) ||
            (t->stage.rounding && (i == ADCGS_P_STEP || i == ADCGS_P_E_STEPS)) || adcgs_fmodel_is_settled(t->f, i)) {
            memset(p->g, 0, p->n * sizeof *p->g);
            continue;
        }
        if (t->f->mlp[i].n && price > 0)
            adcgs_weight_rate(t->f, i, price);
        if (t->f->follows && !is_network(i))
            hold_settled(t->f, i);
        if (!begins(p, i))
            continue;
        const float lr = t->run.lr_scale * adcgs_train_rate(&t->config, p->lr0, p->lr1, progress), n = (float)++p->steps;
        adam_job job = {t, i, lr, 1 / (1 - powf(ADAM_BETA1, n)), 1 / (1 - powf(ADAM_BETA2, n))};
        adcgs_pool_run(p->n > ADAM_PIECE ? t->pool : NULL, adam_piece, &job, (int)((p->n + ADAM_PIECE - 1) / ADAM_PIECE));
    }
    if (t->stage.rounding && !t->stage.frozen)
        follow_means(t);
    if (!t->stage.rounding && t->run.iteration % CHECK_EVERY == 0)
        adcgs_fmodel_widen_steps(t->f);
    else
        adcgs_fmodel_take_steps(t->f);
    adcgs_trainer_prepare_networks(t);
}

/** True if an iteration is one of the last before values are frozen, or before the end. */
static int averages(const adcgs_trainer *t, double progress)
{
    const adcgs_train_config *c = &t->config;
    const double freeze = t->quantise && !c->without_rounding ? fmin((double)c->freeze_start, 1) : 1;
    const double begin = t->stage.frozen ? freeze
                         : freeze < 1    ? (double)c->quant_round_start
                                         : 0,
                 end = t->stage.frozen ? 1 : freeze;
    return progress >= end - fmin((double)c->average_share, (end - begin) / 2);
}

/** Updates running means of the view passes' results, over few iterations at first, over many later. */
static void note_means(adcgs_trainer *t, int rated)
{
    const double keep = !t->run.iteration ? 0 : t->run.iteration < EARLY ? KEEP_EARLY : KEEP;
    adcgs_view_result mean = {.loss = 0};
    for (uint32_t i = 0; i < t->config.batch; i++) {
        const adcgs_view_result *seen = &t->batch.results[i];
        mean.loss += seen->loss / t->config.batch;
        mean.mse += seen->mse / t->config.batch;
        for (int j = 0; j < ADCGS_GROUPS; j++)
            mean.bits[j] += seen->bits[j] / t->config.batch;
    }
    t->run.mean_loss = keep * t->run.mean_loss + (1 - keep) * mean.loss;
    t->run.mean_mse = keep * t->run.mean_mse + (1 - keep) * mean.mse;
    t->run.least_mse = t->run.iteration ? fmin(t->run.least_mse, t->run.mean_mse) : t->run.mean_mse;
    for (int i = 0; rated && i < ADCGS_GROUPS; i++)
        t->rate.mean_bits[i] =
            t->rate.mean_bits[i] > 0 ? BITS_KEEP * t->rate.mean_bits[i] + BITS_NEW * mean.bits[i] : mean.bits[i];
}

adcgs_status adcgs_train_step(adcgs_trainer *t, double progress, adcgs_error *error)
{
    ADCGS_TRY(adcgs_batch_run(t, progress, error));
    note_means(t, adcgs_view_pass_has_rate(t, progress));
    update(t, progress);
    t->run.iteration++;
    return averages(t, progress) ? adcgs_weight_average_add(&t->average, t->f, error) : ADCGS_OK;
}

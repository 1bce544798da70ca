/* SPDX-License-Identifier: BSD-2-Clause */
/** \file One iteration. */
#include "train/step.h"

#include "fmodel/from_model.h"
#include "fmodel/weight_rate.h"
#include "grad/random.h"
#include "train/tiers.h"
#include "train/views.h"

#include <math.h>

enum { CHECK_EVERY = 10 };

static int is_network(int group)
{
    return group >= ADCGS_P_ANCHOR;
}

typedef struct adam_job {
    adcgs_trainer *t;
    int group;
    float lr, c1, c2;
} adam_job;

enum { ADAM_PIECE = 16384 };

static void adam_piece(void *arg, int i, int thread)
{
    (void)thread;
    const adam_job *job = arg;
    adcgs_param *p = &job->t->f->param[job->group];
    const size_t at = (size_t)i * ADAM_PIECE, n = p->n - at < ADAM_PIECE ? p->n - at : ADAM_PIECE;
    job->t->pass->dsp.adam(p->p + at, p->g + at, p->m + at, p->v + at, n, job->lr, job->c1, job->c2);
}

/**
 * Loss per bit of a network's weights. They cost nothing until networks have found their form: what begins near 0 could not
 * leave it. The weights of all iterations are coded once. A run that has landed on a size keeps what networks take of it.
 */
static float weight_price(const adcgs_trainer *t, double progress)
{
    const adcgs_train_config *c = &t->config;
    const int landed = t->frozen && c->target == ADCGS_TARGET_SIZE;
    return progress >= c->prune_units_at && !c->without_rate && !landed ? c->network_rate * (float)adcgs_price_of_bit(t) : 0;
}

/**
 * Values that are not coded, since all that is coded of their channel is the mean, go with the mean. Nothing else holds them,
 * and should bits be spent on the channel again, they would be far from where any are.
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

/** What is settled has no gradient, and without one stays what it is. */
static void hold_settled(adcgs_fmodel *f, int group)
{
    const size_t rows = (size_t)adcgs_fmodel_rows(f, group);
    float *g = f->param[group].g;
    for (size_t tile = 0; tile < rows * f->groups; tile++, g += ADCGS_LANES)
        for (size_t l = 0; l < ADCGS_LANES; l++)
            g[l] *= f->learns[tile / rows * ADCGS_LANES + l];
}

/**
 * Whether a group takes part: one of motion does from the first gradient that it has. Its moments begin then, and are scaled by
 * the steps since; by those of the run, the first steps would be many times too long, and in a long run blow the scene apart.
 * Entropy networks begin late as well, but gain by long first steps: bits fall sooner.
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
        if ((t->frozen && (!is_network(i) || entropy)) || (t->rounding && (i == ADCGS_P_STEP || i == ADCGS_P_E_STEPS)) ||
            adcgs_fmodel_is_settled(t->f, i)) {
            memset(p->g, 0, p->n * sizeof *p->g);
            continue;
        }
        if (t->f->mlp[i].n && price > 0)
            adcgs_weight_rate(t->f, i, price);
        if (t->f->follows && !is_network(i))
            hold_settled(t->f, i);
        if (!begins(p, i))
            continue;
        const float lr = t->lr_scale * adcgs_train_rate(&t->config, p->lr0, p->lr1, progress), n = (float)++p->steps;
        adam_job job = { t, i, lr, 1 / (1 - powf(0.9f, n)), 1 / (1 - powf(0.999f, n)) };
        adcgs_pool_run(p->n > ADAM_PIECE ? t->pool : NULL, adam_piece, &job, (int)((p->n + ADAM_PIECE - 1) / ADAM_PIECE));
    }
    if (t->rounding && !t->frozen)
        follow_means(t);
    if (!t->rounding && t->iteration % CHECK_EVERY == 0)
        adcgs_fmodel_widen_steps(t->f);
    else
        adcgs_fmodel_take_steps(t->f);
    adcgs_trainer_prepare_networks(t);
}

static void accumulate_stats(adcgs_trainer *t, const adcgs_raster_grads *grads)
{
    const size_t slots = t->pass->primitives.n;
    const float *weight = t->pass->grads.weight, *screen = grads->screen, *opacity = t->pass->primitives.opacity;
    /* Psi is counted in pixels of the full resolution. */
    const float area = (float)(t->divide * t->divide);
    for (size_t i = 0; i < slots; i++) {
        t->stats.weight[i] += area * weight[i];
        t->stats.opacity[i] += opacity[i];
    }
    for (size_t i = 0; screen && i < slots; i++)
        t->stats.significance[i] += area * weight[i] * screen[i];
    for (uint32_t i = 0; i < t->f->groups * ADCGS_LANES; i++)
        t->stats.presence[i] += i < t->f->n ? adcgs_fmodel_presence(t->f, i, t->pass->t) : 0;
    t->stats.n++;
}

/** Whether an iteration is one of the last before values are frozen, or before the end. */
static int averages(const adcgs_trainer *t, double progress)
{
    const adcgs_train_config *c = &t->config;
    const double freeze = t->quantise && !c->without_rounding ? fmin((double)c->freeze_from, 1) : 1;
    const double begin = t->frozen ? freeze : freeze < 1 ? (double)c->round_from : 0, end = t->frozen ? 1 : freeze;
    return progress >= end - fmin((double)c->average_last, (end - begin) / 2);
}

/* Before, the pictures drawn say nothing of brightness. */
static const double EXPOSURE_FROM = 0.02;
/* Iterations for a picture to be read in the meantime. */
enum { PICTURES_AHEAD = 8 };

adcgs_status adcgs_train_step(adcgs_trainer *t, double progress, adcgs_error *error)
{
    const adcgs_train_config *c = &t->config;
    const uint32_t picked = adcgs_view_pick(t, t->iteration);
    const adcgs_train_view *v = &t->views[picked];
    const adcgs_quant quant = t->frozen ? ADCGS_QUANT_NONE : t->rounding ? ADCGS_QUANT_ROUND :
                              progress >= c->noise_from && !c->without_rate ? ADCGS_QUANT_NOISE : ADCGS_QUANT_NONE;
    const int rated = progress >= c->rate_from && !c->without_rate && !t->frozen;
    const adcgs_pass_mode mode = { .quant = quant,
                                   .deform = t->f->follows ? ADCGS_DEFORM_ALL :
                                             progress < c->deform_from && !t->stereo.n_bodies ? ADCGS_DEFORM_NONE :
                                             progress < c->fine_from   ? ADCGS_DEFORM_COARSE : ADCGS_DEFORM_ALL,
                                   .bf16 = c->bf16,
                                   .dropout = progress >= c->round_from ? 0 : c->dropout,
                                   .seed = (uint32_t)adcgs_random64(c->seed, 3000, t->iteration) };
    adcgs_loss_value value;
    adcgs_raster_grads grads = t->pass->grads;
    if (progress >= c->densify_until) /* only growth asks for it */
        grads.screen = NULL;
    adcgs_pass_forward(t->pass, t->f, v->t, &mode);
    ADCGS_TRY(adcgs_view_draw(t, &v->view, t->image, 1, error));
    const float *target;
    ADCGS_TRY(adcgs_trainer_target(t, picked, progress >= EXPOSURE_FROM ? t->image : NULL, &target, error));
    adcgs_pictures_expect(t->pictures, adcgs_view_pick(t, t->iteration + PICTURES_AHEAD));
    ADCGS_TRY(adcgs_trainer_loss(t, picked, target, &value, error));
    ADCGS_TRY(adcgs_view_draw_back(t, &v->view, &grads, error));
    accumulate_stats(t, &grads);
    if (c->scale_weight > 0 && progress >= c->scale_from)
        adcgs_scale_penalty(&t->pass->primitives, &t->viewpoints, c->scale_weight, grads.scale);
    if (c->distortion_weight > 0 && t->iteration % (uint32_t)c->distortion_period == 0)
        ADCGS_TRY(adcgs_distortion_add(&t->distortion, t->raster, t->back, &t->pass->primitives, &v->view, ADCGS_SCREEN_FILTER,
                                       c->distortion_weight * (float)c->distortion_period, &grads, NULL, error));
    t->pass->pull = NULL;
    if (c->rigid_weight > 0 && mode.deform && t->f->mlp[ADCGS_P_OMEGA].n) {
        adcgs_rigidity_pull(&t->rigid, t->pass, t->f, c->rigid_weight);
        t->pass->pull = t->rigid.pull;
    }
    adcgs_rate rate = { .total = 0 };
    /* Loss per bit: lambda per 2^23 bits. */
    adcgs_pass_backward(t->pass, t->f, mode.deform, rated ? (float)adcgs_price_of_bit(t) : 0, c->rate_period,
                        (int)(t->iteration % (uint32_t)c->rate_period), rated ? &rate : NULL);
    ADCGS_TRY(adcgs_tiers_learn(t, picked, &mode, error));
    const double keep = t->iteration < 100 ? 0.9 : 0.99;
    t->mean_loss = t->iteration ? keep * t->mean_loss + (1 - keep) * value.loss : value.loss;
    t->mean_mse = t->iteration ? keep * t->mean_mse + (1 - keep) * value.mse : value.mse;
    t->least_mse = t->iteration ? fmin(t->least_mse, t->mean_mse) : t->mean_mse;
    for (int i = 0; rated && i < ADCGS_GROUPS; i++)
        t->mean_bits[i] = t->mean_bits[i] > 0 ? 0.95 * t->mean_bits[i] + 0.05 * rate.bits[i] : rate.bits[i];
    update(t, progress);
    t->iteration++;
    return averages(t, progress) ? adcgs_weight_average_add(&t->average, t->f, error) : ADCGS_OK;
}

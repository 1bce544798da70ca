/* SPDX-License-Identifier: BSD-2-Clause */
/** \file One view pass. */
#include "train/view_pass.h"

#include "grad/random.h"
#include "train/rate/tier_assignment.h"
#include "train/stage_table.h"
#include "train/train_views.h"

/* Share of the run: earlier renders are too inaccurate for gains; chosen by hand, not measured. */
static const double EXPOSURE_FROM = 0.02;
/* View passes ahead for which images are prefetched; chosen by hand, not measured. */
enum { PICTURES_AHEAD = 8 };

int adcgs_view_pass_has_rate(const adcgs_trainer *t, double progress)
{
    return adcgs_stage_has_begun(&t->config, ADCGS_STAGE_RATE, progress) && !t->stage.frozen;
}

static int follows_exposure(const adcgs_trainer *t, double progress)
{
    return progress >= EXPOSURE_FROM && t->exposure.n;
}

static adcgs_pass_mode mode_of(const adcgs_trainer *t, double progress, uint32_t number)
{
    const adcgs_train_config *c = &t->config;
    const adcgs_quant quant = t->stage.frozen                                         ? ADCGS_QUANT_NONE
                              : t->stage.rounding                                     ? ADCGS_QUANT_ROUND
                              : adcgs_stage_has_begun(c, ADCGS_STAGE_NOISE, progress) ? ADCGS_QUANT_NOISE
                                                                                      : ADCGS_QUANT_NONE;
    const int moves = adcgs_stage_has_begun(c, ADCGS_STAGE_COARSE, progress) || t->stereo.n_bodies;
    return (adcgs_pass_mode){.quant = quant,
                             .deform = t->f->follows                                           ? ADCGS_DEFORM_ALL
                                       : !moves                                                ? ADCGS_DEFORM_NONE
                                       : !adcgs_stage_has_begun(c, ADCGS_STAGE_FINE, progress) ? ADCGS_DEFORM_COARSE
                                                                                               : ADCGS_DEFORM_ALL,
                             .bf16 = c->bf16,
                             .dropout = adcgs_stage_has_begun(c, ADCGS_STAGE_ROUND, progress) ? 0 : c->dropout,
                             .seed = (uint32_t)adcgs_random64(c->seed, 3000, number)};
}

/** True if a view's image contains the centre of one of an anchor's primitives, or pixels that one covers. */
static int is_in_view(const adcgs_trainer *t, const adcgs_view *v, uint32_t anchor)
{
    const float *const *mean = t->pass->primitives.mean;
    for (int k = 0; k < t->f->params.k; k++) {
        const size_t slot = adcgs_fmodel_slot(t->f, anchor, k);
        size_t at;
        if (t->pass->grads.weight[slot] > 0 ||
            adcgs_view_pixel(v, (const float[]){mean[0][slot], mean[1][slot], mean[2][slot]}, &at))
            return 1;
    }
    return 0;
}

static void add_stats(const adcgs_trainer *t, const adcgs_view *v, const adcgs_raster_grads *grads, adcgs_train_stats *stats)
{
    const size_t slots = t->pass->primitives.n;
    const float *weight = t->pass->grads.weight, *screen = grads->screen, *opacity = t->pass->primitives.opacity;
    /* Psi is counted in pixels of the full resolution. */
    const float area = (float)(t->views.divide * t->views.divide);
    for (size_t i = 0; i < slots; i++) {
        stats->weight[i] += area * weight[i];
        stats->opacity[i] += opacity[i];
    }
    for (size_t i = 0; screen && i < slots; i++)
        stats->significance[i] += area * weight[i] * screen[i];
    for (uint32_t i = 0; i < t->f->n; i++) {
        const float presence = adcgs_fmodel_presence(t->f, i, t->pass->t);
        stats->presence[i] += presence;
        stats->in_view[i] += is_in_view(t, v, i) ? presence : 0;
    }
    stats->n++;
}

/** Renders the view, and computes the gradients of its image loss with respect to the primitives. */
static adcgs_status look_at_picture(adcgs_trainer *t, double progress, uint32_t number, const adcgs_raster_grads *grads,
                                    adcgs_view_result *result, adcgs_error *error)
{
    const uint32_t picked = adcgs_view_pick(t, number), n = t->config.batch;
    const adcgs_view *v = &t->views.list[picked].view;
    adcgs_raster_grads all = *grads;
    adcgs_loss_value value;
    const float *target;
    ADCGS_TRY(adcgs_view_render(t, v, picked, t->image, 1, error));
    ADCGS_TRY(adcgs_trainer_target(t, picked, follows_exposure(t, progress) ? &result->sums : NULL, &target, error));
    adcgs_image_store_prefetch(t->views.store, adcgs_view_pick(t, number + (PICTURES_AHEAD + n - 1) / n * n));
    ADCGS_TRY(adcgs_trainer_loss(t, picked, target, &value, error));
    result->loss = value.loss;
    result->mse = value.mse;
    return adcgs_view_backward(t, v, picked, &all, error);
}

/** Adds the penalties of primitives and of their motion. */
static void add_prices(adcgs_trainer *t, double progress, adcgs_deform deform, adcgs_raster_grads *grads)
{
    const adcgs_train_config *c = &t->config;
    if (c->scale_reg_weight > 0 && adcgs_stage_has_begun(c, ADCGS_STAGE_SCALE_REG, progress))
        adcgs_scale_penalty(&t->pass->primitives, &t->viewpoints, c->scale_reg_weight, grads->scale);
    t->pass->pull = NULL;
    if (c->rigidity_weight > 0 && deform && t->f->mlp[ADCGS_P_OMEGA].n) {
        adcgs_rigidity_pull(&t->rigid, t->pass, t->f, c->rigidity_weight);
        t->pass->pull = t->rigid.pull;
    }
}

adcgs_status adcgs_view_pass(adcgs_trainer *t, double progress, uint32_t number, adcgs_train_stats *stats,
                             adcgs_view_result *result, adcgs_error *error)
{
    const adcgs_train_config *c = &t->config;
    const uint32_t picked = adcgs_view_pick(t, number);
    const adcgs_train_view *v = &t->views.list[picked];
    const adcgs_pass_mode mode = mode_of(t, progress, number);
    const int rated = adcgs_view_pass_has_rate(t, progress);
    /* A rounding pass updates the means of the groups that it measures, so all passes of an iteration use the same groups. */
    const uint32_t turn = mode.quant == ADCGS_QUANT_ROUND ? t->run.iteration : number;
    adcgs_raster_grads grads = t->pass->grads;
    if (progress >= adcgs_stage_end(c, ADCGS_STAGE_DENSIFY)) /* only growth needs it */
        grads.screen = NULL;
    adcgs_pass_forward(t->pass, t->f, v->t, &mode);
    ADCGS_TRY(look_at_picture(t, progress, number, &grads, result, error));
    add_stats(t, &v->view, &grads, stats);
    add_prices(t, progress, mode.deform, &grads);
    adcgs_rate rate = {.total = 0};
    adcgs_pass_backward(t->pass, t->f, mode.deform, rated ? (float)adcgs_cost_of_bit(t) : 0, c->rate_period,
                        (int)(turn % (uint32_t)c->rate_period), rated ? &rate : NULL);
    memcpy(result->bits, rate.bits, sizeof result->bits);
    return adcgs_tiers_train(t, picked, &mode, error);
}

void adcgs_view_pass_apply(adcgs_trainer *t, double progress, uint32_t number, const adcgs_view_result *result)
{
    if (follows_exposure(t, progress))
        adcgs_exposure_follow(&t->exposure, adcgs_view_pick(t, number), &result->sums);
}

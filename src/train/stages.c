/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The order of a run's stages. */
#include "train/stages.h"

#include "train/density/densify.h"
#include "train/density/floaters.h"
#include "train/density/freeze.h"
#include "train/density/unfreeze.h"
#include "train/exposure/black_level.h"
#include "train/exposure/brightness.h"
#include "train/exposure/contrast.h"
#include "train/rate/levels.h"
#include "train/rate/rate_control.h"
#include "train/rate/rate_search.h"
#include "train/rate/rate_target.h"
#include "train/rate/tier_assignment.h"
#include "train/rate/weight_steps.h"
#include "train/stage_table.h"
#include "train/static/prune_and_fix.h"
#include "train/static/unit_prune.h"
#include "train/train_views.h"

/* Origin, unless a line states one: chosen by hand, not measured. */
enum {
    WEIGH_AFTER = 300, /* minimum iterations before motion is tested; it is not trained enough before */
    MEANS_EVERY = 100  /* iterations between exact updates of the means for rounding */
};

static adcgs_status round_values(adcgs_trainer *t, adcgs_error *error)
{
    adcgs_drop_floaters(t);
    ADCGS_TRY(adcgs_weight_steps_choose(t, error));
    t->stage.rounding = 1;
    adcgs_trainer_prepare_networks(t);
    return ADCGS_OK;
}

/** Replaces the parameters by their average over the last iterations. */
static void take_average(adcgs_trainer *t)
{
    adcgs_weight_average_take(&t->average, t->f);
    adcgs_trainer_prepare_networks(t);
}

/** The last stages: values are rounded, then frozen. */
static adcgs_status round_and_freeze(adcgs_trainer *t, double progress, adcgs_error *error)
{
    const adcgs_train_config *c = &t->config;
    const adcgs_quantise_options means = {.cpu = t->cpu, .mu = t->pass->mu, .factor = t->pass->factor};
    if (!t->stage.rounding && adcgs_stage_has_begun(c, ADCGS_STAGE_ROUND, progress)) {
        ADCGS_TRY(round_values(t, error));
        adcgs_level_bits(t);
        ADCGS_TRY(t->quantise(t->f, &means, error));
        ADCGS_TRY(adcgs_rate_target_steps(t, 1, error));
    } else if (t->stage.rounding && !t->stage.frozen && t->run.iteration % MEANS_EVERY == 0) {
        ADCGS_TRY(t->quantise(t->f, &means, error));
    }
    if (t->stage.frozen || !t->stage.rounding || !adcgs_stage_has_begun(c, ADCGS_STAGE_FREEZE, progress))
        return ADCGS_OK;
    take_average(t);
    ADCGS_TRY(adcgs_rate_target_steps(t, 0, error));
    ADCGS_TRY(adcgs_freeze(t, error));
    ADCGS_TRY(adcgs_tiers_fit(t, error));
    return adcgs_rate_target_frozen(t, error);
}

static adcgs_status enter_stages(adcgs_trainer *t, double progress, adcgs_error *error)
{
    const adcgs_train_config *c = &t->config;
    if (progress >= adcgs_train_lambda_from(c))
        t->rate.lambda_used = 1;
    if (!t->stage.fixed_unchanging && adcgs_stage_has_begun(c, ADCGS_STAGE_STATIC_ANCHORS, progress)) {
        t->stage.fixed_unchanging = 1;
        ADCGS_TRY(adcgs_fix_unchanging(t, error));
    }
    if (!t->stage.motion_tested && adcgs_stage_has_begun(c, ADCGS_STAGE_MOTION_TEST, progress)) { /* motion is found late */
        t->stage.motion_tested = 1;
        if (t->run.iteration >= WEIGH_AFTER)
            ADCGS_TRY(adcgs_test_motion_gain(t, error));
    }
    const adcgs_stage units = t->stage.units_pruned ? ADCGS_STAGE_PRUNE_UNITS_AGAIN : ADCGS_STAGE_PRUNE_UNITS;
    if (t->stage.units_pruned < 2 && adcgs_stage_has_begun(c, units, progress)) {
        t->stage.units_pruned++;
        adcgs_drop_floaters(t);
        if (t->run.iteration >= ADCGS_UNITS_AFTER)
            ADCGS_TRY(adcgs_prune_units(t, error));
    }
    if (!t->stage.pruned && adcgs_stage_has_begun(c, ADCGS_STAGE_PRUNE, progress)) {
        t->stage.pruned = 1;
        ADCGS_TRY(adcgs_prune_and_fix(t, error));
    }
    if (!t->stage.tiered && adcgs_stage_has_begun(c, ADCGS_STAGE_TIERS, progress) && !t->f->follows) {
        t->stage.tiered = 1;
        ADCGS_TRY(adcgs_tiers_assign(t, error));
    }
    return t->quantise ? round_and_freeze(t, progress, error) : ADCGS_OK;
}

int adcgs_stages_divide(const adcgs_trainer *t, double progress)
{
    /* Frozen anchors were trained at full size and fit no other. */
    return t->config.scale * (t->f->follows ? 1 : adcgs_coarse_divide(&t->config, progress));
}

/** Fraction of the views in training, in order of their distance from the start of the curriculum. */
static double window_of(const adcgs_train_config *c, double progress)
{
    return progress < c->curriculum_until ? c->curriculum_begin + (1 - c->curriculum_begin) * progress / c->curriculum_until : 1;
}

/** Loads images at the current size. */
static adcgs_status load_views(adcgs_trainer *t, double progress, adcgs_error *error)
{
    const double begin = adcgs_seconds();
    const int first = !t->views.divide && !t->rate.lambda_used; /* also for a restored run: until lambda is used, it may differ */
    if (adcgs_stages_divide(t, progress) == t->views.divide)
        return ADCGS_OK;
    ADCGS_TRY(adcgs_trainer_load_views(t, adcgs_stages_divide(t, progress), error));
    if (first)
        ADCGS_TRY(adcgs_contrast_lambda(t, error));
    if (!t->run.iteration) {
        ADCGS_TRY(adcgs_black_levels(t, error));
        ADCGS_TRY(adcgs_bound_gains(t, error));
    }
    t->run.left.load = adcgs_seconds() - begin;
    return ADCGS_OK;
}

adcgs_status adcgs_stages_before(adcgs_trainer *t, double progress, adcgs_error *error)
{
    const adcgs_train_config *c = &t->config;
    ADCGS_TRY(load_views(t, progress, error));
    t->run.torn = 1;
    adcgs_curriculum_grow(&t->curriculum, window_of(c, progress), t->f);
    ADCGS_TRY(adcgs_unfreeze_step(t, progress, error));
    const int grows =
        t->run.iteration && t->run.iteration % c->densify_interval == 0 && adcgs_stage_lasts(c, ADCGS_STAGE_DENSIFY, progress);
    if (grows)
        ADCGS_TRY(adcgs_densify(t, progress, error));
    ADCGS_TRY(enter_stages(t, progress, error));
    if (!(t->rate.next_lambda > 0))
        ADCGS_TRY(adcgs_rate_is_sought(t) ? adcgs_rate_search_step(t, progress, error)
                                          : adcgs_rate_control_step(t, progress, error));
    t->run.torn = grows; /* a run continued from this state would grow again */
    return ADCGS_OK;
}

adcgs_status adcgs_stages_skip(adcgs_trainer *t, adcgs_error *error)
{
    adcgs_buffer_clear(&t->rate.begin);
    ADCGS_TRY(load_views(t, 1, error));
    adcgs_curriculum_grow(&t->curriculum, 1, t->f);
    return enter_stages(t, 1, error);
}

adcgs_status adcgs_stages_finish(adcgs_trainer *t, adcgs_error *error)
{
    take_average(t);
    if (t->config.target == ADCGS_TARGET_NONE)
        return ADCGS_OK;
    if (!t->stage.rounding)
        ADCGS_TRY(round_values(t, error));
    if (!t->stage.frozen)
        ADCGS_TRY(adcgs_freeze(t, error));
    return adcgs_rate_target_finish(t, error);
}

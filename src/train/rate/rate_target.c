/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Meeting a target: the strength of RDOQ at which a frozen run meets it. */
#include "train/rate/rate_target.h"

#include "train/density/prune.h"
#include "train/density/sample.h"
#include "train/rate/levels.h"
#include "train/rate/rate_search.h"
#include "train/train_views.h"

#include <math.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
enum {
    TRIES = 16,    /* evaluations of a search */
    PRUNINGS = 16, /* maximum number of prunings */
    REACH = 8      /* factor between tried strengths while only one bound is known */
};
#define STRENGTH_FIRST 1.0      /* RDOQ strength tried first: the bits' price by lambda itself */
#define STRENGTH_MOST_SIZE 64.0 /* beyond it, RDOQ discards far more than it saves, and pruning anchors is better */
#define STRENGTH_MOST_PSNR 1e6  /* the same for a target PSNR, which has no other means */
#define PRUNE_LEAST 0.5         /* minimum share of the anchors that one pruning keeps */
#define PRUNE_MOST 0.98         /* maximum share of the anchors that one pruning keeps */
#define SIZE_MARGIN 0.01        /* share of the size left free at the freeze; networks are still trained and may grow */
#define PSNR_GAIN 0.1           /* dB: approximate gain of the networks after the freeze */
#define PSNR_NEAR 0.03          /* dB: tolerance of the target */
#define STEPS_REACH 1.4         /* maximum |log of the factor| by which steps become finer */
#define STEPS_FIRST 0.2         /* the first one tried */
enum { STEPS_TRIES = 8 };       /* evaluations of the search for finer steps */

/** The accepted range of values [low, high]. A higher strength gives lower values, of bytes and of dB. */
typedef struct window {
    double low, high;
} window;

/**
 * Quantises with a strength and stores the bits. Starts from the nearest levels, so earlier choices have no effect.
 */
static adcgs_status settle(adcgs_trainer *t, double strength, adcgs_error *error)
{
    ADCGS_TRY(adcgs_level_choose(t, 0, error));
    adcgs_level_bits(t);
    if (strength > 0) {
        ADCGS_TRY(adcgs_level_choose(t, strength, error));
        adcgs_level_bits(t);
    }
    return ADCGS_OK;
}

/** The current bytes or PSNR of the run. */
static adcgs_status value_now(adcgs_trainer *t, double *value, adcgs_error *error)
{
    adcgs_bytes bytes;
    if (t->config.target == ADCGS_TARGET_PSNR)
        return adcgs_sample_psnr(t, UINT32_MAX, value, error);
    ADCGS_TRY(t->rate.measure(t->rate.measure_user, t, &bytes, error));
    *value = (double)bytes.total;
    return ADCGS_OK;
}

static adcgs_status try_strength(adcgs_trainer *t, double strength, double *value, adcgs_error *error)
{
    ADCGS_TRY(settle(t, strength, error));
    return value_now(t, value, error);
}

/**
 * Finds the strength whose value lies in the window, or as close below it as the tries allow. *value: its value, which is above
 * the window if no strength reaches it.
 */
static adcgs_status seek(adcgs_trainer *t, const window *w, double *strength, double *value, adcgs_error *error)
{
    const double most = t->config.target == ADCGS_TARGET_SIZE ? STRENGTH_MOST_SIZE : STRENGTH_MOST_PSNR;
    double weak = 0, strong = 0, next = STRENGTH_FIRST, v; /* weak: value too high; strong: the weakest known that suffices */
    *strength = 0;
    ADCGS_TRY(try_strength(t, 0, value, error));
    if (*value <= w->high)
        return ADCGS_OK;
    for (int i = 0; i < TRIES && next <= most && (*value > w->high || *value < w->low); i++) {
        ADCGS_TRY(try_strength(t, next, &v, error));
        if (v <= w->high || !strong) {
            *strength = next;
            *value = v;
        }
        if (v <= w->high)
            strong = next;
        else
            weak = next;
        next = !strong ? next * REACH : weak > 0 ? sqrt(weak * strong) : strong / REACH;
    }
    return settle(t, *strength, error);
}

/** Drops the least visible anchors, as many as the size requires if bytes are proportional to anchors. */
static adcgs_status prune(adcgs_trainer *t, const window *w, double bytes, adcgs_error *error)
{
    const double fixed = ADCGS_MIN(t->rate.control.fixed, w->high), share = (w->high - fixed) / (bytes - fixed);
    return adcgs_prune_anchors(t, (uint32_t)(t->f->n * fmin(fmax(share, PRUNE_LEAST), PRUNE_MOST)), error);
}

/** Meets the window. If RDOQ alone cannot reach a size, prunes anchors. */
static adcgs_status land(adcgs_trainer *t, const window *w, adcgs_error *error)
{
    double strength, value;
    ADCGS_TRY(seek(t, w, &strength, &value, error));
    for (int i = 0; i < PRUNINGS && t->config.target == ADCGS_TARGET_SIZE && value > w->high && t->f->n > 1; i++) {
        ADCGS_TRY(prune(t, w, value, error));
        ADCGS_TRY(seek(t, w, &strength, &value, error));
    }
    return ADCGS_OK;
}

static void scale_steps(adcgs_trainer *t, double by)
{
    adcgs_param *steps = &t->f->param[ADCGS_P_STEP];
    for (size_t i = 0; i < steps->n; i++)
        steps->p[i] += (float)by;
    adcgs_fmodel_take_steps(t->f);
    adcgs_level_bits(t);
}

adcgs_status adcgs_rate_target_steps(adcgs_trainer *t, int first, adcgs_error *error)
{
    const double aim = (first ? 1 + SIZE_MARGIN : 1 - SIZE_MARGIN) * t->config.target_value;
    double low = -STEPS_REACH, high = 0, at = 0, bytes;
    if (t->config.target != ADCGS_TARGET_SIZE || t->f->params.adaptive_steps)
        return ADCGS_OK;
    ADCGS_TRY(value_now(t, &bytes, error));
    for (int i = 0; i < STEPS_TRIES && (i ? fabs(bytes / aim - 1) > SIZE_MARGIN : bytes < aim); i++) {
        *(bytes < aim ? &high : &low) = at;
        const double next = i ? (low + high) / 2 : -STEPS_FIRST;
        scale_steps(t, next - at);
        at = next;
        ADCGS_TRY(value_now(t, &bytes, error));
    }
    return ADCGS_OK;
}

adcgs_status adcgs_rate_target_frozen(adcgs_trainer *t, adcgs_error *error)
{
    const double target = t->config.target_value;
    if (t->config.target == ADCGS_TARGET_SIZE)
        return land(t, &(window){(1 - 2 * SIZE_MARGIN) * target, (1 - SIZE_MARGIN) * target}, error);
    if (t->config.target == ADCGS_TARGET_NONE)
        return ADCGS_OK;
    ADCGS_TRY(adcgs_trainer_load_views(t, 1, error));
    const double aim = target - PSNR_GAIN;
    if (t->rate.begin.size) {
        double value;
        ADCGS_TRY(value_now(t, &value, error));
        adcgs_rate_search_end(t, aim - PSNR_NEAR - value);
        if (t->rate.next_lambda > 0)
            return ADCGS_OK;
    }
    return land(t, &(window){aim - PSNR_NEAR, aim + PSNR_NEAR}, error);
}

adcgs_status adcgs_rate_target_finish(adcgs_trainer *t, adcgs_error *error)
{
    const double target = t->config.target_value;
    window w = {(1 - 2 * SIZE_MARGIN) * target, target};
    double now;
    if (t->config.target == ADCGS_TARGET_NONE)
        return ADCGS_OK;
    if (t->config.target == ADCGS_TARGET_PSNR) {
        w = (window){target - PSNR_NEAR, target + PSNR_NEAR};
        if (t->views.divide != 1)
            ADCGS_TRY(adcgs_trainer_load_views(t, 1, error));
    }
    ADCGS_TRY(value_now(t, &now, error));
    return now > w.high || now < w.low ? land(t, &w, error) : ADCGS_OK;
}

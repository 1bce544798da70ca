/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Steering lambda to a size or to a quality. */
#include "train/rate_control.h"

#include "metric/metric.h"
#include "train/densify.h"
#include "train/prune.h"
#include "train/sample.h"
#include "train/weight_steps.h"

#include <math.h>

/** STEP_EVERY, in iterations; lambda stays within so many times of where it began, both ways. */
enum { STEP_EVERY = 10, SAMPLE_VIEWS = 24, LAMBDA_REACH = 100 };
#define MEASURE_EVERY 0.03 /* of the run */
/**
 * Bytes to aim at while values are only rounded: the choice of levels takes the rest, at less loss than lambda would.
 * PSNR to aim at: so that there is something to choose from.
 */
#define SIZE_LEAD 1.03
#define PSNR_LEAD 0.1
/** What is left of the networks' bytes when lattices are final, and when hidden units have gone, the first time and again. */
#define LATTICES_LEAVE 0.8
#define UNITS_LEAVE 0.4
#define UNITS_LEAVE_AGAIN 0.75
/** Error that anchors are pruned for, and the least share of them that stays; iterations to know them by. */
#define PRUNE_FROM 0.05
#define PRUNE_LEAST 0.8
enum { PRUNE_AFTER = 50 };
/**
 * Gains of the feedback, on the error's change, which at first is all of it, and on the error itself over the whole run. Bytes go
 * with about the -0.3rd power of lambda, and take a tenth of the run to get there.
 */
#define GAIN_CHANGE 3.0
#define GAIN_ERROR 30.0
#define GAIN_PSNR 0.3 /* of a dB as an error */
#define PSNR_AHEAD 5.0 /* dB that views of full size would gain in a whole run */

/** Bytes of features, as estimated lately. */
static double estimate(const adcgs_trainer *t)
{
    double bits = 0;
    for (int i = 0; i < ADCGS_GROUPS; i++)
        bits += t->mean_bits[i];
    return bits / 8;
}

/** Share of the networks' bytes that will be left in the end. */
static double networks_left(const adcgs_trainer *t)
{
    const adcgs_train_config *c = &t->config;
    const double again = (double)c->prune_units_again, first = (double)c->prune_units_at * c->iterations;
    double left = t->rounding ? 1 : LATTICES_LEAVE;
    if (t->slimmed < 2 && again < (double)c->round_from && adcgs_train_prunes_units(c))
        left *= t->slimmed && first >= ADCGS_UNITS_AFTER ? UNITS_LEAVE_AGAIN : UNITS_LEAVE;
    return left;
}

static adcgs_status measure_size(adcgs_trainer *t, adcgs_error *error)
{
    adcgs_bytes b;
    if (!t->rounding)
        adcgs_weight_steps_nominal(t);
    ADCGS_TRY(t->measure(t->measure_user, t, &b, error));
    const uint64_t features = b.layer[0] + b.layer[1] + b.layer[2] + b.layer[3] + b.layer[4];
    t->rate_control.fixed = (double)(b.total - features) - (1 - networks_left(t)) * (double)b.networks;
    t->rate_control.ratio = (double)features / estimate(t);
    return ADCGS_OK;
}

/** Anchors there will be over anchors there are: growth goes on where it has kept up with its budget so far. */
static double growth_ahead(const adcgs_trainer *t, double progress)
{
    const double budget = adcgs_densify_budget(&t->config, progress);
    const double whole = t->config.max_anchors;
    return progress < t->config.densify_until && t->f->n > 0.9 * budget ? fmax(1, whole / t->f->n) : 1;
}

/** Log of the bytes that features take over those they may take. */
static double size_error(const adcgs_trainer *t, double progress)
{
    const double aim = SIZE_LEAD * t->config.target_value, room = fmax(aim - t->rate_control.fixed, 0.05 * aim);
    return log(fmax(estimate(t) * t->rate_control.ratio * growth_ahead(t, progress), 1) / room);
}

double adcgs_rate_bounded(const adcgs_trainer *t, double lambda)
{
    return fmin(fmax(lambda, (double)t->config.lambda / LAMBDA_REACH), (double)t->config.lambda * LAMBDA_REACH);
}

/** What a run will end with, about: while views are drawn smaller than they are, what they have there. */
static adcgs_status foresee_psnr(adcgs_trainer *t, double progress, double *psnr, adcgs_error *error)
{
    if (t->divide > t->config.scale) {
        *psnr = adcgs_psnr_from_mse(t->mean_mse);
        return ADCGS_OK;
    }
    ADCGS_TRY(adcgs_sample_psnr(t, SAMPLE_VIEWS, psnr, error));
    *psnr += PSNR_AHEAD * (1 - progress);
    return ADCGS_OK;
}

static double psnr_error(const adcgs_trainer *t)
{
    return GAIN_PSNR * (t->rate_control.psnr - t->config.target_value - PSNR_LEAD);
}

static adcgs_status measure(adcgs_trainer *t, double progress, adcgs_error *error)
{
    t->rate_control.measured = progress;
    if (t->config.target == ADCGS_TARGET_SIZE)
        return measure_size(t, error);
    return foresee_psnr(t, progress, &t->rate_control.psnr, error);
}

static double error_of(const adcgs_trainer *t, double progress)
{
    return t->config.target == ADCGS_TARGET_SIZE ? size_error(t, progress) : psnr_error(t);
}

adcgs_status adcgs_rate_measure(adcgs_trainer *t, double progress, double *off, adcgs_error *error)
{
    ADCGS_TRY(measure(t, progress, error));
    *off = error_of(t, progress);
    return ADCGS_OK;
}

/** Where lambda is as large as it may be and still too small, the anchors that show least go, some at a time. */
static adcgs_status prune(adcgs_trainer *t, adcgs_error *error)
{
    const adcgs_rate_control *s = &t->rate_control;
    if (t->rounding || t->lambda < (double)t->config.lambda * LAMBDA_REACH || s->error < PRUNE_FROM || t->stats.n < PRUNE_AFTER)
        return ADCGS_OK;
    const double before = t->f->n;
    ADCGS_TRY(adcgs_prune_anchors(t, (uint32_t)(before * fmax(exp(-0.5 * s->error), PRUNE_LEAST)), error));
    for (int i = 0; i < ADCGS_GROUPS; i++) /* a running mean, which would lag behind */
        t->mean_bits[i] *= t->f->n / before;
    return ADCGS_OK;
}

adcgs_status adcgs_rate_control_step(adcgs_trainer *t, double progress, adcgs_error *error)
{
    const adcgs_train_config *c = &t->config;
    adcgs_rate_control *s = &t->rate_control;
    const int waits = c->target == ADCGS_TARGET_PSNR && s->tries && !t->rounding; /* full size is seen, but not learnt yet */
    if (c->target == ADCGS_TARGET_NONE || progress < c->rate_from || t->frozen || waits || t->iteration % STEP_EVERY ||
        !(estimate(t) > 0))
        return ADCGS_OK;
    if (!s->measured || progress >= s->measured + MEASURE_EVERY) {
        ADCGS_TRY(prune(t, error));
        ADCGS_TRY(measure(t, progress, error));
    }
    const double now = error_of(t, progress);
    const double since = s->at > 0 ? progress - s->at : 0;
    t->lambda = adcgs_rate_bounded(t, t->lambda * exp(GAIN_CHANGE * (now - s->error) + GAIN_ERROR * now * since));
    s->error = now;
    s->at = progress;
    return ADCGS_OK;
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Control of lambda towards a size or a quality. */
#include "train/rate/rate_control.h"

#include "metric/metric.h"
#include "train/density/densify.h"
#include "train/density/prune.h"
#include "train/density/sample.h"
#include "train/rate/weight_steps.h"

#include <math.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
enum {
    STEP_EVERY = 10,   /* iterations between updates of lambda */
    SAMPLE_VIEWS = 24, /* training views of a PSNR measurement */
    LAMBDA_REACH = 100 /* maximum factor between lambda and its initial value, in both directions */
};
#define MEASURE_EVERY 0.03 /* fraction of the run between measurements */
/*
 * Size aimed at before the freeze / target size; calibrated on demo (doc/log/rate.md): RDOQ saves the rest at less loss than
 * lambda.
 */
#define SIZE_LEAD 1.03
#define PSNR_LEAD 0.1          /* dB above the target, so that RDOQ has a margin */
#define LATTICES_LEAVE 0.8     /* share of the networks' bytes that remains when lattices are final */
#define UNITS_LEAVE 0.4        /* share that remains after the first pruning of hidden units */
#define UNITS_LEAVE_AGAIN 0.75 /* share that remains after the second one */
#define PRUNE_FROM 0.05        /* log of bytes over room: minimum for pruning anchors */
#define PRUNE_LEAST 0.8        /* minimum share of the anchors that one pruning keeps */
/* Share of its budget from which the number of anchors is expected to keep growing. */
#define FOLLOWS 0.9
#define ROOM_LEAST 0.05    /* share of the target: minimum that the features are assumed to have */
enum { PRUNE_AFTER = 50 }; /* minimum iterations of statistics before pruning */
/*
 * Gains of the controller. Bytes vary with about the -0.3rd power of lambda, and need a tenth of the run to follow it; chosen by
 * hand, not measured.
 */
#define GAIN_CHANGE 3.0 /* on the change of the error, initially the whole error */
#define GAIN_ERROR 30.0 /* on the error integrated over the run */
#define GAIN_PSNR 0.3   /* error per dB */
#define PSNR_AHEAD 5.0  /* expected dB that views at full size gain in a whole run */

/** Estimated bytes of the features in recent iterations. */
static double estimate(const adcgs_trainer *t)
{
    double bits = 0;
    for (int i = 0; i < ADCGS_GROUPS; i++)
        bits += t->rate.mean_bits[i];
    return bits / 8;
}

/** Share of the networks' bytes that will remain at the end. */
static double networks_left(const adcgs_trainer *t)
{
    const adcgs_train_config *c = &t->config;
    const double again = (double)c->prune_units_again, first = (double)c->prune_units_at * c->iterations;
    double left = t->stage.rounding ? 1 : LATTICES_LEAVE;
    if (t->stage.units_pruned < 2 && again < (double)c->quant_round_start && adcgs_train_prunes_units(c))
        left *= t->stage.units_pruned && first >= ADCGS_UNITS_AFTER ? UNITS_LEAVE_AGAIN : UNITS_LEAVE;
    return left;
}

static adcgs_status measure_size(adcgs_trainer *t, adcgs_error *error)
{
    adcgs_bytes b;
    if (!t->stage.rounding)
        adcgs_weight_steps_nominal(t);
    ADCGS_TRY(t->rate.measure(t->rate.measure_user, t, &b, error));
    const uint64_t features = b.layer[0] + b.layer[1] + b.layer[2] + b.layer[3] + b.layer[4];
    t->rate.control.fixed = (double)(b.total - features) - (1 - networks_left(t)) * (double)b.networks;
    t->rate.control.ratio = (double)features / estimate(t);
    return ADCGS_OK;
}

/** Expected growth of the number of anchors. Growth is expected to continue if it has followed its budget so far. */
static double growth_ahead(const adcgs_trainer *t, double progress)
{
    const double budget = adcgs_densify_budget(&t->config, progress);
    const double whole = t->config.max_anchors;
    return progress < t->config.densify_until && t->f->n > FOLLOWS * budget ? fmax(1, whole / t->f->n) : 1;
}

/** Logarithm of the features' bytes over the bytes available for them. */
static double size_error(const adcgs_trainer *t, double progress)
{
    const double aim = SIZE_LEAD * t->config.target_value, room = fmax(aim - t->rate.control.fixed, ROOM_LEAST * aim);
    return log(fmax(estimate(t) * t->rate.control.ratio * growth_ahead(t, progress), 1) / room);
}

double adcgs_rate_bounded(const adcgs_trainer *t, double lambda)
{
    return fmin(fmax(lambda, (double)t->config.lambda / LAMBDA_REACH), (double)t->config.lambda * LAMBDA_REACH);
}

/** Predicts the final PSNR. While views are rendered at reduced size, it is the PSNR there. */
static adcgs_status foresee_psnr(adcgs_trainer *t, double progress, double *psnr, adcgs_error *error)
{
    if (t->views.divide > t->config.scale) {
        *psnr = adcgs_psnr_from_mse(t->run.mean_mse);
        return ADCGS_OK;
    }
    ADCGS_TRY(adcgs_sample_psnr(t, SAMPLE_VIEWS, psnr, error));
    *psnr += PSNR_AHEAD * (1 - progress);
    return ADCGS_OK;
}

static double psnr_error(const adcgs_trainer *t)
{
    return GAIN_PSNR * (t->rate.control.psnr - t->config.target_value - PSNR_LEAD);
}

static adcgs_status measure(adcgs_trainer *t, double progress, adcgs_error *error)
{
    t->rate.control.measured = progress;
    if (t->config.target == ADCGS_TARGET_SIZE)
        return measure_size(t, error);
    return foresee_psnr(t, progress, &t->rate.control.psnr, error);
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

/** If lambda is at its upper bound and still too small, prunes a part of the least visible anchors. */
static adcgs_status prune(adcgs_trainer *t, adcgs_error *error)
{
    const adcgs_rate_control *s = &t->rate.control;
    if (t->stage.rounding || t->rate.lambda < (double)t->config.lambda * LAMBDA_REACH || s->error < PRUNE_FROM ||
        t->stats.n < PRUNE_AFTER)
        return ADCGS_OK;
    const double before = t->f->n;
    ADCGS_TRY(adcgs_prune_anchors(t, (uint32_t)(before * fmax(exp(-0.5 * s->error), PRUNE_LEAST)), error));
    for (int i = 0; i < ADCGS_GROUPS; i++) /* a running mean would lag behind */
        t->rate.mean_bits[i] *= t->f->n / before;
    return ADCGS_OK;
}

adcgs_status adcgs_rate_control_step(adcgs_trainer *t, double progress, adcgs_error *error)
{
    const adcgs_train_config *c = &t->config;
    adcgs_rate_control *s = &t->rate.control;
    const int waits =
        c->target == ADCGS_TARGET_PSNR && s->tries && !t->stage.rounding; /* full size is rendered but not trained yet */
    if (c->target == ADCGS_TARGET_NONE || progress < c->rate_start || t->stage.frozen || waits || t->run.iteration % STEP_EVERY ||
        !(estimate(t) > 0))
        return ADCGS_OK;
    if (!s->measured || progress >= s->measured + MEASURE_EVERY) {
        ADCGS_TRY(prune(t, error));
        ADCGS_TRY(measure(t, progress, error));
    }
    const double now = error_of(t, progress);
    const double since = s->at > 0 ? progress - s->at : 0;
    t->rate.lambda = adcgs_rate_bounded(t, t->rate.lambda * exp(GAIN_CHANGE * (now - s->error) + GAIN_ERROR * now * since));
    s->error = now;
    s->at = progress;
    return ADCGS_OK;
}

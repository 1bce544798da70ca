/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Steering a run to a size or to a quality. */
#include "train/rate_control.h"

#include "grad/random.h"
#include "metric/metric.h"
#include "train/trainer.h"
#include "train/weight_steps.h"

#include <math.h>
#include <stdlib.h>

/* ---- What fits into a size ---- */

/** Bytes of headers, cameras and notes, at most about; a plausible share of networks; anchors as the coder leaves them. */
enum { OTHER_BYTES = 1700, ANCHOR_BITS = 220, ANCHORS_LEAST = 16, WIDTH_LEAST = 8 };
#define NETWORKS_SHARE 0.25
#define LAMBDA_FIRST 0.02f /* from where a target steers it */
#define ANCHORS_GROWTH 4 /* a large size may raise a preset's budget so many times */

/** Weights of all networks under a configuration. */
static adcgs_status count_weights(const adcgs_train_config *c, size_t *weights, adcgs_error *error)
{
    static const float origin[3];
    static const uint32_t place[1][3];
    adcgs_fmodel *f;
    *weights = 0;
    ADCGS_TRY(adcgs_fmodel_create(&f, &c->params, &c->shape, origin, 1, place, 1, 0, error));
    for (int i = 0; i < ADCGS_P_COUNT; i++)
        *weights += f->mlp[i].n;
    adcgs_fmodel_free(&f);
    return ADCGS_OK;
}

static int narrower(int width, double factor)
{
    const int scaled = 4 * (int)rint(width * factor / 4);
    return width ? ADCGS_MIN(width, ADCGS_MAX(scaled, WIDTH_LEAST)) : 0; /* 0: the network is left out */
}

/** The widest networks, of some fractions of the preset's width, that leave room for anchors. */
static adcgs_status plan_networks(adcgs_train_config *c, double *bytes, adcgs_error *error)
{
    const double share = NETWORKS_SHARE * c->target_value;
    const double room = c->own_anchors ? c->target_value - OTHER_BYTES - (double)c->max_anchors * ANCHOR_BITS / 8 : 0;
    static const double factors[] = { 1, 0.875, 0.75, 0.625, 0.5, 0.375, 0.25, 0.125 };
    const adcgs_shape wide = c->shape;
    for (size_t i = 0; i < ADCGS_COUNTOF(factors); i++) {
        size_t weights;
        c->shape.theta_width = narrower(wide.theta_width, factors[i]);
        c->shape.omega_width = narrower(wide.omega_width, factors[i]);
        c->shape.varpi_width = narrower(wide.varpi_width, factors[i]);
        c->shape.entropy_width = narrower(wide.entropy_width, factors[i]);
        ADCGS_TRY(count_weights(c, &weights, error));
        *bytes = (double)weights * ADCGS_WEIGHT_BITS / 8;
        if (c->own_networks || *bytes <= fmax(share, room))
            break;
    }
    return ADCGS_OK;
}

adcgs_status adcgs_control_plan(adcgs_train_config *c, adcgs_error *error)
{
    double networks;
    if (c->target != ADCGS_TARGET_NONE)
        c->lambda = LAMBDA_FIRST;
    if (c->target != ADCGS_TARGET_SIZE)
        return ADCGS_OK;
    c->keep_opacity = 0; /* the bytes are to be spent: on what is faint rather than not at all */
    ADCGS_TRY(plan_networks(c, &networks, error));
    const double anchors = floor((c->target_value - networks - OTHER_BYTES) * 8 / ANCHOR_BITS);
    if (anchors < ANCHORS_LEAST)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%.0f bytes are too few: networks, cameras and headers alone take about %.0f",
                          c->target_value, networks + OTHER_BYTES);
    if (!c->own_anchors)
        c->max_anchors = (uint32_t)fmin(anchors, fmin((double)c->max_anchors * ANCHORS_GROWTH, ADCGS_ANCHORS_MAX));
    c->start_anchors = ADCGS_MIN(c->start_anchors, c->max_anchors);
    return ADCGS_OK;
}

/* ---- Lambda ---- */

/** STEP_EVERY, in iterations; lambda stays within so many times of where it began, both ways. */
enum { STEP_EVERY = 10, SAMPLE_VIEWS = 24, LAMBDA_REACH = 100 };
#define MEASURE_EVERY 0.03 /* of the run */
/**
 * Bytes to aim at while values are only rounded: the choice of levels takes the rest, at less loss than lambda would.
 * PSNR to aim at: so that there is something to choose from.
 */
#define SIZE_LEAD 1.06
#define PSNR_LEAD 0.1
/** Of the networks' bytes, what their final lattices will take less than those from the weights' sizes, about. */
#define LATTICE_SAVES 0.2
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

/** Bytes of features, as estimated lately. */
static double estimate(const adcgs_trainer *t)
{
    double bits = 0;
    for (int i = 0; i < ADCGS_GROUPS; i++)
        bits += t->mean_bits[i];
    return bits / 8;
}

static adcgs_status measure_size(adcgs_trainer *t, adcgs_error *error)
{
    adcgs_bytes b;
    if (!t->rounding)
        adcgs_trainer_lattices(t);
    ADCGS_TRY(t->measure(t->measure_user, t, &b, error));
    const double saved = t->rounding ? 0 : LATTICE_SAVES * (double)b.networks;
    const uint64_t features = b.layer[0] + b.layer[1] + b.layer[2] + b.layer[3] + b.layer[4];
    t->control.fixed = (double)(b.total - features) - saved;
    t->control.ratio = (double)features / estimate(t);
    return ADCGS_OK;
}

/** Anchors there will be over anchors there are: growth goes on where it has kept up with its budget so far. */
static double growth_ahead(const adcgs_trainer *t, double progress)
{
    const double budget = adcgs_trainer_budget(&t->config, progress);
    const double whole = t->config.max_anchors;
    return progress < t->config.grow_until && t->f->n > 0.9 * budget ? fmax(1, whole / t->f->n) : 1;
}

/** Log of the bytes that features take over those they may take. */
static double size_error(const adcgs_trainer *t, double progress)
{
    const double aim = SIZE_LEAD * t->config.target_value, room = fmax(aim - t->control.fixed, 0.05 * aim);
    return log(fmax(estimate(t) * t->control.ratio * growth_ahead(t, progress), 1) / room);
}

/** PSNR of the picture of a view, as a player would round it, against the one taken. */
static adcgs_status picture_psnr(adcgs_trainer *t, const adcgs_view *view, const float *taken, float *image, double *psnr,
                                 adcgs_error *error)
{
    const size_t values = 3 * (size_t)view->width * (size_t)view->height;
    ADCGS_TRY(adcgs_raster_forward(t->raster, &t->pass->primitives, view, t->scene->background, 0.3f, image, 0, error));
    for (size_t i = 0; i < values; i++)
        image[i] = rintf(255 * fminf(fmaxf(image[i], 0), 1)) / 255;
    *psnr = adcgs_psnr(image, taken, values);
    return ADCGS_OK;
}

static adcgs_status loaded_psnr(adcgs_trainer *t, uint32_t index, double *psnr, adcgs_error *error)
{
    ADCGS_TRY(adcgs_pictures_get(t->pictures, index, t->taken, error));
    return picture_psnr(t, &t->views[index].view, t->taken, t->image, psnr, error);
}

/** The same of a view that is not loaded in full size. */
static adcgs_status full_psnr(adcgs_trainer *t, uint32_t index, double *psnr, adcgs_error *error)
{
    adcgs_camera camera;
    adcgs_view view;
    float *taken;
    ADCGS_TRY(adcgs_scene_load(t->scene, &t->scene->views[ADCGS_SPLIT_TRAIN][index], 1, &taken, &camera, error));
    float *image = malloc(3 * sizeof *image * (size_t)camera.width * (size_t)camera.height);
    adcgs_status status = image ? adcgs_view_init(&view, &camera, t->origin, t->scale, error)
                                : adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for a picture");
    if (status == ADCGS_OK)
        status = picture_psnr(t, &view, taken, image, psnr, error);
    free(image);
    free(taken);
    return status;
}

adcgs_status adcgs_control_psnr(adcgs_trainer *t, uint32_t most, double *psnr, adcgs_error *error)
{
    const uint32_t n = ADCGS_MIN(t->n_views, most);
    const adcgs_pass_mode mode = { .quant = t->frozen ? ADCGS_QUANT_NONE : t->rounding ? ADCGS_QUANT_ROUND : ADCGS_QUANT_NOISE,
                                   .deform = 1,
                                   .seed = (uint32_t)adcgs_random64(t->config.seed, 3001, 0) };
    *psnr = 0;
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t index = (uint32_t)((uint64_t)i * t->n_views / n);
        double one;
        adcgs_pass_forward(t->pass, t->f, t->views[index].t, &mode);
        ADCGS_TRY(t->divide == 1 ? loaded_psnr(t, index, &one, error) : full_psnr(t, index, &one, error));
        *psnr += one / n;
    }
    return ADCGS_OK;
}

/** What a run gains in PSNR from some progress to its end, about. */
static double psnr_ahead(double progress)
{
    return 3 * (1 - progress);
}

static double psnr_error(const adcgs_trainer *t, double progress)
{
    return GAIN_PSNR * (t->control.psnr + psnr_ahead(progress) - t->config.target_value - PSNR_LEAD);
}

static adcgs_status measure(adcgs_trainer *t, double progress, adcgs_error *error)
{
    t->control.measured = progress;
    if (t->config.target == ADCGS_TARGET_SIZE)
        return measure_size(t, error);
    return adcgs_control_psnr(t, SAMPLE_VIEWS, &t->control.psnr, error);
}

/** Where lambda is as large as it may be and still too small, the anchors that show least go, some at a time. */
static adcgs_status prune(adcgs_trainer *t, adcgs_error *error)
{
    const adcgs_control *s = &t->control;
    if (t->rounding || t->lambda < (double)t->config.lambda * LAMBDA_REACH || s->error < PRUNE_FROM || t->stats.n < PRUNE_AFTER)
        return ADCGS_OK;
    const double before = t->f->n;
    ADCGS_TRY(adcgs_trainer_prune(t, (uint32_t)(before * fmax(exp(-0.5 * s->error), PRUNE_LEAST)), error));
    for (int i = 0; i < ADCGS_GROUPS; i++) /* a running mean, which would lag behind */
        t->mean_bits[i] *= t->f->n / before;
    return ADCGS_OK;
}

adcgs_status adcgs_control_step(adcgs_trainer *t, double progress, adcgs_error *error)
{
    const adcgs_train_config *c = &t->config;
    adcgs_control *s = &t->control;
    if (c->target == ADCGS_TARGET_NONE || progress < c->rate_from || t->frozen || t->iteration % STEP_EVERY || !(estimate(t) > 0))
        return ADCGS_OK;
    if (!s->measured || progress >= s->measured + MEASURE_EVERY) {
        ADCGS_TRY(prune(t, error));
        ADCGS_TRY(measure(t, progress, error));
    }
    const double now = c->target == ADCGS_TARGET_SIZE ? size_error(t, progress) : psnr_error(t, progress);
    t->lambda *= exp(GAIN_CHANGE * (now - s->error) + (s->at > 0 ? GAIN_ERROR * now * (progress - s->at) : 0));
    t->lambda = fmin(fmax(t->lambda, (double)c->lambda / LAMBDA_REACH), (double)c->lambda * LAMBDA_REACH);
    s->error = now;
    s->at = progress;
    return ADCGS_OK;
}

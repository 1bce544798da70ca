/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Trials of mechanisms. */
#include "train/trial/trial.h"

#include "metric/metric.h"
#include "train/resolve.h"
#include "train/settings.h"
#include "train/start_points.h"
#include "train/train_views.h"
#include "train/trainer.h"
#include "train/trial/mechanisms.h"
#include "train/trial/trial_scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
enum {
    ITERATIONS_LEAST = 100, /* minimum iterations of a trial */
    ITERATIONS_MOST = 600   /* maximum iterations of a trial */
};
#define VIEWS_PER_FRAME 3 /* for densification from residuals, which needs as many views of a frame */
/* Approximate pixels of a trial's images; enough to see a motion of 1/100 of the image; chosen by hand, not measured. */
static const double PIXELS = 12000;
static const double
    /*
     * dB, mean over the held-out views, by which a mechanism must lose to be dropped. Runs that differ only in their seed lie
     * within 0.2 dB on the scenes at hand, on which this is calibrated.
     */
    LOSS = 0.3,
    /* Share of the held-out views that must agree; chosen by hand, not measured. */
    AGREE = 0.7;

/* ---- Where mechanisms apply ---- */

static int has_black_levels(const adcgs_trainer *t)
{
    for (uint32_t i = 0; i < t->exposure.n; i++)
        for (int c = 0; c < 3; c++)
            if (fabsf(t->exposure.cameras[i].black[c]) > 0)
                return 1;
    return 0;
}

static int has_retimed(const adcgs_trainer *t)
{
    for (uint32_t i = 0; i < t->views.n; i++)
        if (fabsf(t->views.list[i].t - adcgs_trainer_time(t, t->scene->views[ADCGS_SPLIT_TRAIN][i].time)) > 0)
            return 1;
    return 0;
}

/** True if a run with all mechanisms used this one. */
static int applies(const adcgs_trainer *t, int mechanism)
{
    switch (mechanism) {
    case ADCGS_MATCHING:
        return t->stereo.n_still > 0 || t->stereo.n_moving > 0;
    case ADCGS_GAINS:
        return t->exposure.n > 0;
    case ADCGS_BLACK_LEVELS:
        return has_black_levels(t);
    case ADCGS_LIFETIMES:
        return t->config.params.spans != 0;
    case ADCGS_BODIES:
        return t->stereo.n_bodies > 0;
    case ADCGS_RETIMING:
        return has_retimed(t);
    case ADCGS_RESIDUALS:
        return t->scene->points.n >= ADCGS_POINTS_LEAST && t->views.n >= VIEWS_PER_FRAME * t->scene->n_times;
    case ADCGS_FLOATERS:
        return t->stereo.maps != NULL;
    case ADCGS_STATIC_ANCHORS:
        return t->config.params.time_rows > 0;
    default:
        return 1;
    }
}

/* ---- One trial ---- */

/** PSNR of each held-out view after a trial. */
typedef struct score {
    double psnr[ADCGS_TRIAL_JUDGES];
    uint8_t applies[ADCGS_MECHANISMS];
    int fits; /* 1: gains apply, so images are compared after a fit of gains */
} score;

typedef struct trials {
    const adcgs_trials_options *o;
    const adcgs_train_config *config;
    const adcgs_scene *scene;
    adcgs_stereo matched; /* result of the first run, for the others */
    uint32_t details;     /* likewise */
    uint32_t done;
    score base[2]; /* with all mechanisms, for each seed */
    int has_second;
} trials;

/** Returns the factor by which a trial reduces the images at the end of its run; 0: they are small. */
static int find_reduction(const adcgs_train_config *c, const adcgs_scene *scene)
{
    const adcgs_camera *camera = &scene->views[ADCGS_SPLIT_TRAIN][0].camera;
    const double pixels = (double)camera->width * camera->height / ((double)c->scale * c->scale);
    return (int)(sqrt(pixels / PIXELS) / 2 + 0.4);
}

/** PSNR of a view, after a fit of gain and black level to the image if gains apply. */
static adcgs_status judge_view(adcgs_trainer *t, const adcgs_scene_view *v, int fits, double *psnr, adcgs_error *error)
{
    const adcgs_pass_mode mode = {.deform = ADCGS_DEFORM_ALL};
    adcgs_camera camera;
    adcgs_view view;
    float *taken;
    ADCGS_TRY(adcgs_scene_image(t->scene, v, t->views.divide, &taken, &camera, error));
    const size_t plane = (size_t)camera.width * (size_t)camera.height;
    float *const image = adcgs_alloc(NULL, 6 * plane, sizeof *image, error);
    adcgs_status status = image ? adcgs_view_init(&view, &camera, t->origin, t->scale, error) : adcgs_alloc_status(error);
    if (status == ADCGS_OK) {
        adcgs_pass_forward(t->pass, t->f, adcgs_trainer_time(t, v->time), &mode);
        status = adcgs_view_render(t, &view, ADCGS_MEAN_LIGHT, image, 0, error);
    }
    if (status == ADCGS_OK && fits)
        adcgs_fit_levels(image + 3 * plane, image, taken, plane);
    if (status == ADCGS_OK)
        *psnr = adcgs_psnr(fits ? image + 3 * plane : image, taken, 3 * plane);
    adcgs_free(NULL, image);
    free(taken);
    return status;
}

static adcgs_status judge(adcgs_trainer *t, int fits, score *out, adcgs_error *error)
{
    for (uint32_t i = 0; i < t->scene->n_views[ADCGS_SPLIT_VAL]; i++)
        ADCGS_TRY(judge_view(t, &t->scene->views[ADCGS_SPLIT_VAL][i], fits, &out->psnr[i], error));
    return ADCGS_OK;
}

/** first: the run that shows which mechanisms apply, and matches images for all. */
static adcgs_status run_trial(score *out, const adcgs_train_config *config, trials *r, int first, adcgs_error *error)
{
    adcgs_trainer *t;
    int stopped;
    /* Matching gives other results without lifetimes or bodies. */
    const int same = config->matching_frames && config->params.spans == r->config->params.spans &&
                     config->params.bodies == r->config->params.bodies;
    adcgs_stereo *const matched = first || !same ? NULL : &r->matched;
    const adcgs_trainer_input input = {.matched = matched, .details = r->details ? &r->details : NULL};
    ADCGS_TRY(adcgs_trainer_create_from(&t, r->scene, config, &input, r->o->cpu, r->o->pool, error));
    t->views.memory = r->o->memory;
    adcgs_status status = adcgs_trainer_run(t, NULL, NULL, &stopped, error);
    for (int i = 0; i < ADCGS_MECHANISMS; i++)
        out->applies[i] = (uint8_t)applies(t, i);
    out->fits = first ? applies(t, ADCGS_GAINS) : r->base[0].fits;
    memset(out->psnr, 0, sizeof out->psnr);
    if (t->run.diverged) /* 0 dB: the run without the mechanism wins unless it diverges, too */
        status = ADCGS_OK;
    else if (status == ADCGS_OK)
        status = judge(t, out->fits, out, error);
    if (first)
        r->details = t->decisions.details;
    if (first || matched) {
        r->matched = t->stereo;
        t->stereo = (adcgs_stereo){.n_still = 0};
    }
    adcgs_trainer_free(&t);
    return status;
}

/* ---- All trials ---- */

static uint32_t judges_of(const trials *r)
{
    return r->scene->n_views[ADCGS_SPLIT_VAL];
}

/** Runs without a mechanism (ADCGS_MECHANISM_NONE: with all), with the first or the second seed. */
static adcgs_status try_without(trials *r, int mechanism, int second, score *out, adcgs_error *error)
{
    const char *const name = mechanism == ADCGS_MECHANISM_NONE ? NULL : adcgs_mechanism_names[mechanism];
    const adcgs_trial_facts facts = {.without = mechanism,
                                     .iterations = adcgs_trial_length(r->config),
                                     .seed = r->config->seed + (uint64_t)second,
                                     .reduction = find_reduction(r->config, r->scene)};
    adcgs_train_config c = *r->config;
    if (r->o->progress && r->o->progress(r->o->user, name, r->done, ADCGS_MECHANISMS + 1))
        return adcgs_fail(error, ADCGS_ERR_IO, "interrupted during the trials of mechanisms");
    r->done++;
    adcgs_resolve_trial(&c, &facts);
    return run_trial(out, &c, r, !name && !second, error);
}

static double mean(const score *s, uint32_t n)
{
    double sum = 0;
    for (uint32_t i = 0; i < n; i++)
        sum += s->psnr[i] / n;
    return sum;
}

/** True if a run is clearly better than another, on average and in most views. */
static int is_better(const score *s, const score *than, uint32_t n)
{
    uint32_t better = 0;
    for (uint32_t i = 0; i < n; i++)
        better += s->psnr[i] > than->psnr[i];
    return mean(s, n) > mean(than, n) + LOSS && better >= AGREE * n;
}

static adcgs_status ask_again(trials *r, int mechanism, adcgs_trial *t, adcgs_error *error)
{
    const uint32_t n = judges_of(r);
    score without;
    if (!r->has_second)
        ADCGS_TRY(try_without(r, ADCGS_MECHANISM_NONE, 1, &r->base[1], error));
    r->has_second = 1;
    ADCGS_TRY(try_without(r, mechanism, 1, &without, error));
    t->dropped = is_better(&without, &r->base[1], n);
    t->with = 0.5 * (t->with + mean(&r->base[1], n));
    t->without = 0.5 * (t->without + mean(&without, n));
    return ADCGS_OK;
}

static int is_on(const adcgs_train_config *config, int mechanism)
{
    return adcgs_setting_get(adcgs_setting_find(adcgs_mechanism_settings[mechanism]), config) > 0;
}

static adcgs_status try_all(trials *r, adcgs_trials *out, adcgs_error *error)
{
    const uint32_t n = judges_of(r);
    ADCGS_TRY(try_without(r, ADCGS_MECHANISM_NONE, 0, &r->base[0], error));
    for (int m = 0; m < ADCGS_MECHANISMS; m++) {
        score without;
        if (!r->base[0].applies[m] || !is_on(r->config, m))
            continue;
        adcgs_trial *t = &out->of[out->n++];
        ADCGS_TRY(try_without(r, m, 0, &without, error));
        *t = (adcgs_trial){.mechanism = m, .with = mean(&r->base[0], n), .without = mean(&without, n)};
        if (is_better(&without, &r->base[0], n))
            ADCGS_TRY(ask_again(r, m, t, error));
    }
    return ADCGS_OK;
}

uint32_t adcgs_trial_length(const adcgs_train_config *config)
{
    const double n = (double)config->trial_share * config->iterations;
    return n < ITERATIONS_LEAST || config->time_limit > 0 ? 0 : (uint32_t)fmin(rint(n), ITERATIONS_MOST);
}

adcgs_status adcgs_trials_run(adcgs_trials *out, const adcgs_train_config *config, const adcgs_scene *scene,
                              const adcgs_trials_options *options, adcgs_error *error)
{
    adcgs_trial_scene held = {.scene = {.n_times = 0}};
    *out = (adcgs_trials){.iterations = adcgs_trial_length(config)};
    if (!out->iterations || scene->splats)
        return ADCGS_OK;
    ADCGS_TRY(adcgs_trial_scene_make(&held, scene, error));
    trials *r = adcgs_alloc(NULL, 1, sizeof *r, error);
    adcgs_status status = r ? ADCGS_OK : adcgs_alloc_status(error);
    if (status == ADCGS_OK && held.scene.n_views[ADCGS_SPLIT_VAL]) {
        *r = (trials){.o = options, .config = config, .scene = &held.scene};
        out->views = judges_of(r);
        status = try_all(r, out, error);
    }
    if (r)
        adcgs_stereo_clear(&r->matched);
    adcgs_free(NULL, r);
    adcgs_trial_scene_clear(&held);
    return status;
}

void adcgs_trials_dropped(const adcgs_trials *t, uint8_t dropped[ADCGS_MECHANISMS])
{
    memset(dropped, 0, ADCGS_MECHANISMS);
    for (uint32_t i = 0; i < t->n; i++)
        dropped[t->of[i].mechanism] |= t->of[i].dropped != 0;
}

void adcgs_trials_format(const adcgs_trials *t, char text[ADCGS_TRIALS_TEXT])
{
    size_t n = 0;
    text[0] = '\0';
    if (!t->n)
        return;
    n = (size_t)snprintf(text, ADCGS_TRIALS_TEXT, "views=%u iterations=%u", t->views, t->iterations);
    for (uint32_t i = 0; i < t->n; i++)
        n += (size_t)snprintf(text + n, ADCGS_TRIALS_TEXT - n, " %s=%.2f/%.2f", adcgs_mechanism_names[t->of[i].mechanism],
                              t->of[i].with, t->of[i].without);
    for (uint32_t i = 0, dropped = 0; i < t->n; i++)
        if (t->of[i].dropped)
            n += (size_t)snprintf(text + n, ADCGS_TRIALS_TEXT - n, "%s%s",
                                  dropped++ ? "," : " dropped=", adcgs_mechanism_names[t->of[i].mechanism]);
}

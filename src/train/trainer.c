/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The training loop. */
#include "train/trainer.h"

#include "fmodel/scale_penalty.h"
#include "fmodel/weight_rate.h"
#include "grad/random.h"
#include "metric/metric.h"
#include "train/initialise.h"
#include "train/unit_prune.h"
#include "train/weight_steps.h"

#include <math.h>
#include <stdlib.h>

/* WEIGH_AFTER, SLIM_AFTER: before that many iterations motion and networks have not had their chance. */
enum { WEIGH_AFTER = 300, SLIM_AFTER = 1000 };
enum { SNAPSHOT_EVERY = 500, CHECK_EVERY = 10, REPORT_EVERY = 10, MEANS_EVERY = 100, ROLLBACKS_MAX = 4 };

/* ---- Memory ---- */

adcgs_status adcgs_trainer_resize(adcgs_trainer *t, adcgs_error *error)
{
    const size_t slots = (size_t)t->f->groups * 64 * t->f->params.k;
    ADCGS_TRY(adcgs_pass_resize(t->pass, t->f, error));
    adcgs_free(NULL, t->stats.weight);
    t->stats.weight = adcgs_alloc(NULL, 3 * slots, sizeof(float), error);
    t->stats.significance = t->stats.weight + slots;
    t->stats.opacity = t->stats.weight + 2 * slots;
    t->stats.n = 0;
    if (!t->stats.weight)
        return ADCGS_ERR_MEMORY;
    return t->config.rigid_weight > 0 ? adcgs_rigid_build(&t->rigid, t->f, t->pool, error) : ADCGS_OK;
}

static adcgs_status create_views(adcgs_trainer *t, adcgs_error *error)
{
    const double duration = t->scene->duration;
    t->n_views = t->scene->n_views[ADCGS_SPLIT_TRAIN];
    t->views = calloc(t->n_views, sizeof *t->views);
    float *times = calloc(t->n_views, sizeof *times);
    adcgs_status status = ADCGS_OK;
    if (!t->views || !times)
        status = adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for %u views", t->n_views);
    for (uint32_t i = 0; status == ADCGS_OK && i < t->n_views; i++) {
        const double time = t->scene->views[ADCGS_SPLIT_TRAIN][i].time;
        times[i] = t->views[i].t = duration > 0 ? (float)fmin(fmax(time / duration, 0), 1) : 0;
    }
    if (status == ADCGS_OK)
        status = adcgs_window_create(&t->window, times, t->n_views, error);
    free(times);
    if (status == ADCGS_OK)
        status = adcgs_exposure_create(&t->exposure, t->scene->views[ADCGS_SPLIT_TRAIN], t->n_views, error);
    return status;
}

static adcgs_status create_viewpoints(adcgs_trainer *t, adcgs_error *error)
{
    float(*x)[3] = adcgs_alloc(NULL, t->n_views, sizeof *x, error);
    if (!x)
        return ADCGS_ERR_MEMORY;
    for (uint32_t i = 0; i < t->n_views; i++)
        for (int a = 0; a < 3; a++)
            x[i][a] = (float)((t->scene->views[ADCGS_SPLIT_TRAIN][i].camera.cam_to_world[4 * a + 3] - t->origin[a]) / t->scale);
    const adcgs_status status = adcgs_viewpoints_create(&t->viewpoints, (const float(*)[3])x, t->n_views, error);
    adcgs_free(NULL, x);
    return status;
}

static adcgs_status create_parts(adcgs_trainer *t, adcgs_error *error)
{
    adcgs_train_config *c = &t->config;
    const uint32_t times = t->scene->n_times;
    if (c->bf16)
        ADCGS_TRY(adcgs_bf16_check(t->cpu, error));
    if (c->without_coarse && c->without_fine)
        c->params.time_rows = 0;
    if (times <= 1)
        c->params.time_rows = 0;
    else if (c->params.time_rows > times)
        c->params.time_rows = (uint16_t)times;
    if (!c->params.time_rows)
        c->params.time_width = 0;
    /* A camera alone finds what moves with large primitives first, and by what neighbours do. Several tell from one moment. */
    const int several = t->scene->n_views[ADCGS_SPLIT_TRAIN] >= 2 * times;
    if (several && !c->own_rigid)
        c->rigid_weight = 0;
    if (several && !c->own_area)
        c->area_from = 0;
    if (c->without_coarse)
        c->shape.omega_width = 0;
    if (c->without_fine)
        c->shape.varpi_width = 0;
    ADCGS_TRY(adcgs_control_plan(c, error));
    adcgs_scene_frame(t->scene, t->origin, &t->scale);
    ADCGS_TRY(adcgs_train_start(&t->f, t->scene, c, error));
    adcgs_train_rates(t->f);
    ADCGS_TRY(adcgs_pass_create(&t->pass, t->f, t->cpu, t->pool, error));
    ADCGS_TRY(adcgs_raster_create(&t->raster, t->cpu, t->pool, NULL, error));
    ADCGS_TRY(adcgs_raster_back_create(&t->back, t->cpu, t->pool, error));
    ADCGS_TRY(adcgs_loss_create(&t->loss, t->cpu, t->pool, error));
    ADCGS_TRY(create_views(t, error));
    /* Points of its own say that a scene is filmed from within: where cameras stand is free, whatever others see behind. */
    if (several && t->scene->points.n >= ADCGS_POINTS_LEAST)
        ADCGS_TRY(create_viewpoints(t, error));
    return adcgs_trainer_resize(t, error);
}

adcgs_status adcgs_trainer_create(adcgs_trainer **out, const adcgs_scene *scene, const adcgs_train_config *config,
                                  adcgs_cpu_level cpu, adcgs_pool *pool, adcgs_error *error)
{
    adcgs_trainer *t = calloc(1, sizeof *t);
    *out = NULL;
    if (!t)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for the trainer");
    t->config = *config;
    t->scene = scene;
    t->cpu = cpu;
    t->pool = pool;
    t->lr_scale = 1;
    adcgs_buffer_init(&t->snapshot);
    const adcgs_status status = create_parts(t, error);
    t->lambda = (double)t->config.lambda;
    if (status != ADCGS_OK)
        adcgs_trainer_free(&t);
    *out = t;
    return status;
}

static void free_views(adcgs_trainer *t)
{
    adcgs_pictures_free(&t->pictures);
    adcgs_free(NULL, t->image);
    adcgs_free(NULL, t->grad);
    adcgs_free(NULL, t->taken);
    t->image = t->grad = t->taken = NULL;
}

void adcgs_trainer_free(adcgs_trainer **trainer)
{
    adcgs_trainer *t = *trainer;
    if (!t)
        return;
    free_views(t);
    free(t->views);
    adcgs_free(NULL, t->stats.weight);
    adcgs_fmodel_free(&t->f);
    adcgs_pass_free(&t->pass);
    adcgs_raster_free(&t->raster);
    adcgs_raster_back_free(&t->back);
    adcgs_loss_free(&t->loss);
    adcgs_rigid_clear(&t->rigid);
    adcgs_window_clear(&t->window);
    adcgs_exposure_clear(&t->exposure);
    adcgs_viewpoints_clear(&t->viewpoints);
    adcgs_average_clear(&t->average);
    adcgs_buffer_clear(&t->snapshot);
    free(t);
    *trainer = NULL;
}

/* ---- Views ---- */

adcgs_status adcgs_trainer_load_views(adcgs_trainer *t, int divide, adcgs_error *error)
{
    const adcgs_pictures_config config = { .split = ADCGS_SPLIT_TRAIN, .divide = divide, .memory = t->picture_memory,
                                           .progress = t->loading, .user = t->loading_user };
    size_t most = 0;
    free_views(t);
    ADCGS_TRY(adcgs_pictures_load(&t->pictures, t->scene, &config, t->pool, error));
    for (uint32_t i = 0; i < t->n_views; i++) {
        const adcgs_camera *camera = adcgs_pictures_camera(t->pictures, i);
        ADCGS_TRY(adcgs_view_init(&t->views[i].view, camera, t->origin, t->scale, error));
        most = ADCGS_MAX(most, (size_t)camera->width * (size_t)camera->height);
    }
    t->image = adcgs_alloc(NULL, most * 3, sizeof(float), error);
    t->grad = adcgs_alloc(NULL, most * 3, sizeof(float), error);
    t->taken = adcgs_alloc(NULL, most * 3, sizeof(float), error);
    t->divide = divide;
    return t->image && t->grad && t->taken ? ADCGS_OK : ADCGS_ERR_MEMORY;
}

/**
 * View of an iteration. Once all of time is trained on, every epoch visits all views once, in an order of its own (a Feistel walk
 * over the index).
 */
static uint32_t pick_view(const adcgs_trainer *t, uint32_t iteration)
{
    if (t->window.n < t->n_views)
        return adcgs_window_pick(&t->window, t->config.seed, iteration);
    const uint32_t n = t->n_views, epoch = iteration / n;
    int half = 1;
    while ((uint64_t)1 << (2 * half) < n)
        half++;
    const uint32_t mask = (1u << half) - 1;
    uint32_t x = iteration % n;
    do {
        uint32_t l = x >> half, r = x & mask;
        for (uint32_t round = 0; round < 4; round++) {
            const uint32_t next = l ^ ((uint32_t)adcgs_random64(t->config.seed, 2000 + round, (uint64_t)epoch << 32 | r) & mask);
            l = r;
            r = next;
        }
        x = l << half | r;
    } while (x >= n);
    return x;
}

/* ---- One iteration ---- */

static double progress_of(const adcgs_trainer *t)
{
    const double by_count = (double)t->iteration / t->config.iterations;
    return t->config.time_limit > 0 ? fmax(by_count, t->elapsed / t->config.time_limit) : by_count;
}

static int is_network(int group)
{
    return group >= ADCGS_P_ANCHOR;
}

static void prepare_networks(adcgs_trainer *t)
{
    for (int i = ADCGS_P_ANCHOR; i < ADCGS_P_COUNT; i++)
        if (t->f->mlp[i].n)
            adcgs_mlp_prepare(&t->f->mlp[i], t->f->param[i].p, t->rounding);
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
    return progress >= c->slim_at && !c->without_rate && !landed ? c->network_rate * (float)t->lambda * 0x1p-23f : 0;
}

/**
 * Values that are not coded, since all that is coded of their channel is the mean, go with the mean. Nothing else holds them,
 * and should bits be spent on the channel again, they would be far from where any are.
 */
static void follow_means(adcgs_trainer *t)
{
    for (int i = 0; i < ADCGS_P_ANCHOR; i++) {
        const size_t n = (size_t)adcgs_fmodel_rows(t->f, i) * t->f->groups * 64;
        const float *mu = t->pass->mu[i], *used = t->pass->used[i];
        float *p = t->f->param[i].p;
        for (size_t j = 0; j < n; j++)
            p[j] = adcgs_mean_alone(mu[j]) ? used[j] : p[j];
    }
}

static void update(adcgs_trainer *t, double progress)
{
    const float price = weight_price(t, progress);
    t->adam_steps++;
    const float c1 = 1 / (1 - powf(0.9f, (float)t->adam_steps)), c2 = 1 / (1 - powf(0.999f, (float)t->adam_steps));
    for (int i = 0; i < ADCGS_P_COUNT; i++) {
        adcgs_param *p = &t->f->param[i];
        const int entropy = i == ADCGS_P_ETA_PRIOR || i >= ADCGS_P_E_FV;
        if ((t->frozen && (!is_network(i) || entropy)) || (t->rounding && (i == ADCGS_P_STEP || i == ADCGS_P_E_STEPS))) {
            memset(p->g, 0, p->n * sizeof *p->g);
            continue;
        }
        if (t->f->mlp[i].n && price > 0)
            adcgs_weight_rate(t->f, i, price);
        const float lr = t->lr_scale * p->lr0 * powf(p->lr1 / p->lr0, (float)progress);
        adam_job job = { t, i, lr, c1, c2 };
        adcgs_pool_run(p->n > ADAM_PIECE ? t->pool : NULL, adam_piece, &job, (int)((p->n + ADAM_PIECE - 1) / ADAM_PIECE));
    }
    if (t->rounding && !t->frozen)
        follow_means(t);
    if (!t->rounding && t->iteration % CHECK_EVERY == 0)
        adcgs_fmodel_widen_steps(t->f);
    else
        adcgs_fmodel_take_steps(t->f);
    prepare_networks(t);
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

/** Go on from where the last iterations led in the mean. */
static void take_average(adcgs_trainer *t)
{
    adcgs_average_take(&t->average, t->f);
    prepare_networks(t);
}

/* Before, the pictures drawn say nothing of brightness. */
static const double EXPOSURE_FROM = 0.02;
/* Iterations for a picture to be read in the meantime. */
enum { PICTURES_AHEAD = 8 };

adcgs_status adcgs_trainer_target(adcgs_trainer *t, uint32_t view, const float *drawn, const float **target, adcgs_error *error)
{
    const adcgs_view *v = &t->views[view].view;
    const size_t plane = (size_t)v->width * (size_t)v->height;
    ADCGS_TRY(adcgs_pictures_get(t->pictures, view, t->taken, error));
    if (t->exposure.n && drawn)
        adcgs_exposure_follow(&t->exposure, view, drawn, t->taken, plane);
    if (t->exposure.n)
        adcgs_exposure_even(&t->exposure, view, t->taken, t->taken, plane);
    *target = t->taken;
    return ADCGS_OK;
}

static adcgs_status iterate(adcgs_trainer *t, double progress, adcgs_error *error)
{
    const adcgs_train_config *c = &t->config;
    const uint32_t picked = pick_view(t, t->iteration);
    const adcgs_train_view *v = &t->views[picked];
    const adcgs_quant quant = t->frozen ? ADCGS_QUANT_NONE : t->rounding ? ADCGS_QUANT_ROUND :
                              progress >= c->noise_from && !c->without_rate ? ADCGS_QUANT_NOISE : ADCGS_QUANT_NONE;
    const int rated = progress >= c->rate_from && !c->without_rate && !t->frozen;
    const adcgs_pass_mode mode = { .quant = quant,
                                   .deform = progress < c->deform_from ? ADCGS_DEFORM_NONE :
                                             progress < c->fine_from   ? ADCGS_DEFORM_COARSE : ADCGS_DEFORM_ALL,
                                   .bf16 = c->bf16,
                                   .dropout = progress >= c->round_from ? 0 : c->dropout,
                                   .seed = (uint32_t)adcgs_random64(c->seed, 3000, t->iteration) };
    adcgs_loss_value value;
    adcgs_raster_grads grads = t->pass->grads;
    if (progress >= c->grow_until) /* only growth asks for it */
        grads.screen = NULL;
    adcgs_pass_forward(t->pass, t->f, v->t, &mode);
    ADCGS_TRY(adcgs_raster_forward(t->raster, &t->pass->primitives, &v->view, t->scene->background, 0.3f, t->image, 1, error));
    const float *target;
    ADCGS_TRY(adcgs_trainer_target(t, picked, progress >= EXPOSURE_FROM ? t->image : NULL, &target, error));
    adcgs_pictures_expect(t->pictures, pick_view(t, t->iteration + PICTURES_AHEAD));
    ADCGS_TRY(adcgs_loss_image(t->loss, t->image, target, v->view.width, v->view.height, c->ssim_weight, t->grad, &value, error));
    ADCGS_TRY(adcgs_raster_backward(t->back, t->raster, &t->pass->primitives, &v->view, t->scene->background, 0.3f, t->image,
                                    t->grad, &grads, error));
    accumulate_stats(t, &grads);
    if (c->area_weight > 0 && progress >= c->area_from)
        adcgs_area_price(&t->pass->primitives, &t->viewpoints, c->area_weight, grads.scale);
    t->pass->pull = NULL;
    if (c->rigid_weight > 0 && mode.deform && t->f->mlp[ADCGS_P_OMEGA].n) {
        adcgs_rigid_pull(&t->rigid, t->pass, t->f, c->rigid_weight);
        t->pass->pull = t->rigid.pull;
    }
    adcgs_rate rate = { .total = 0 };
    /* Loss per bit: lambda per 2^23 bits. */
    adcgs_pass_backward(t->pass, t->f, mode.deform, rated ? (float)t->lambda * 0x1p-23f : 0, c->rate_period,
                        (int)(t->iteration % (uint32_t)c->rate_period), rated ? &rate : NULL);
    const double keep = t->iteration < 100 ? 0.9 : 0.99;
    t->mean_loss = t->iteration ? keep * t->mean_loss + (1 - keep) * value.loss : value.loss;
    t->mean_mse = t->iteration ? keep * t->mean_mse + (1 - keep) * value.mse : value.mse;
    for (int i = 0; rated && i < ADCGS_GROUPS; i++)
        t->mean_bits[i] = t->mean_bits[i] > 0 ? 0.95 * t->mean_bits[i] + 0.05 * rate.bits[i] : rate.bits[i];
    update(t, progress);
    t->iteration++;
    return averages(t, progress) ? adcgs_average_add(&t->average, t->f, error) : ADCGS_OK;
}

/* ---- Stages ---- */

adcgs_status adcgs_trainer_round(adcgs_trainer *t, adcgs_error *error)
{
    ADCGS_TRY(adcgs_trainer_choose_lattices(t, error));
    t->rounding = 1;
    prepare_networks(t);
    return ADCGS_OK;
}

static adcgs_status enter_stages(adcgs_trainer *t, double progress, adcgs_error *error)
{
    const adcgs_train_config *c = &t->config;
    if (progress >= adcgs_train_lambda_from(c))
        t->lambda_used = 1;
    if (!t->weighed && progress >= c->rate_from && !c->without_rate) {
        t->weighed = 1;
        if (t->iteration >= WEIGH_AFTER)
            ADCGS_TRY(adcgs_trainer_weigh(t, error));
    }
    if (t->slimmed < 2 && progress >= (t->slimmed ? c->slim_again : c->slim_at) && !c->without_rate) {
        t->slimmed++;
        if (t->iteration >= SLIM_AFTER)
            ADCGS_TRY(adcgs_trainer_slim(t, error));
    }
    if (!t->decided && progress >= c->decide_at) {
        t->decided = 1;
        if (!c->without_refinement)
            ADCGS_TRY(adcgs_trainer_decide(t, error));
    }
    if (!t->quantise || c->without_rounding)
        return ADCGS_OK;
    const adcgs_quantise_options means = { .cpu = t->cpu, .mu = t->pass->mu, .factor = t->pass->factor };
    if (!t->rounding && progress >= c->round_from) {
        ADCGS_TRY(adcgs_trainer_round(t, error));
        adcgs_trainer_densities(t);
        ADCGS_TRY(t->quantise(t->f, &means, error));
    } else if (t->rounding && !t->frozen && t->iteration % MEANS_EVERY == 0) {
        ADCGS_TRY(t->quantise(t->f, &means, error));
    }
    if (t->frozen || !t->rounding || progress < c->freeze_from)
        return ADCGS_OK;
    take_average(t);
    ADCGS_TRY(adcgs_trainer_freeze(t, error));
    return adcgs_control_frozen(t, error);
}

static int wanted_divide(const adcgs_trainer *t, double progress)
{
    return t->config.scale * (progress < t->config.quarter_until ? 4 : progress < t->config.half_until ? 2 : 1);
}

/** Fraction of the views, by their distance from the middle of time, that are trained on. */
static double window_of(const adcgs_train_config *c, double progress)
{
    return progress < c->window_until ? c->window_begin + (1 - c->window_begin) * progress / c->window_until : 1;
}

static adcgs_status before_iteration(adcgs_trainer *t, double progress, adcgs_error *error)
{
    const adcgs_train_config *c = &t->config;
    if (wanted_divide(t, progress) != t->divide)
        ADCGS_TRY(adcgs_trainer_load_views(t, wanted_divide(t, progress), error));
    adcgs_window_grow(&t->window, window_of(c, progress), t->f);
    if (!c->without_refinement && t->iteration && t->iteration % c->refine_every == 0 && progress >= c->grow_from &&
        progress < c->grow_until)
        ADCGS_TRY(adcgs_trainer_refine(t, progress, error));
    return enter_stages(t, progress, error);
}

/** Whether every parameter is a number. A splat that is none vanishes from the pictures, so the loss alone may not tell. */
static int is_finite(const adcgs_trainer *t)
{
    for (int i = 0; i < ADCGS_P_COUNT; i++) {
        const adcgs_param *p = &t->f->param[i];
        int bad = 0;
        for (size_t j = 0; j < p->n; j++)
            bad |= (adcgs_float_bits(p->p[j]) & 0x7f800000) == 0x7f800000;
        if (bad)
            return 0;
    }
    return 1;
}

static adcgs_status take_snapshot(adcgs_trainer *t, adcgs_error *error)
{
    t->snapshot.size = 0;
    return adcgs_trainer_store(t, &t->snapshot, error);
}

/** NaN, infinity, or a loss far above what it was: go back to the last good state with smaller steps. */
static adcgs_status guard(adcgs_trainer *t, double before, adcgs_error *error)
{
    const double progress = progress_of(t);
    /* Also before what follows from the parameters is fixed: at the end, and when the stage changes. */
    const int due = t->iteration % CHECK_EVERY == 0 || progress >= 1 ||
                    adcgs_train_stage(&t->config, progress) != adcgs_train_stage(&t->config, before);
    if (isfinite(t->mean_loss) && t->mean_loss <= 4 && (!due || is_finite(t)))
        return t->iteration % SNAPSHOT_EVERY == 0 ? take_snapshot(t, error) : ADCGS_OK;
    const uint32_t rollbacks = t->rollbacks + 1;
    const float lr = t->lr_scale * 0.5f;
    if (rollbacks > ROLLBACKS_MAX)
        return adcgs_fail(error, ADCGS_ERR_DATA,
                          "training diverged at iteration %u (loss %g) after %u rollbacks: check poses and exposure",
                          t->iteration, t->mean_loss, t->rollbacks);
    ADCGS_TRY(adcgs_trainer_restore(t, t->snapshot.data, t->snapshot.size, error));
    t->rollbacks = rollbacks;
    t->lr_scale = lr;
    return ADCGS_OK;
}

static void fill_report(const adcgs_trainer *t, double progress, double rate, adcgs_train_report *r)
{
    r->stage = adcgs_train_stage(&t->config, progress);
    r->iteration = t->iteration;
    r->iterations = t->config.iterations;
    r->anchors = t->f->n;
    r->divide = t->divide ? t->divide : wanted_divide(t, progress);
    r->loss = t->mean_loss;
    r->psnr = adcgs_psnr_from_mse(t->mean_mse);
    r->bytes = 0;
    for (int i = 0; i < ADCGS_GROUPS; i++)
        r->bytes += r->stream[i] = t->mean_bits[i] / 8;
    r->lambda = t->lambda;
    r->seconds = t->elapsed;
    r->rate = rate;
    r->left = progress > 0.02 ? t->elapsed * (1 - progress) / progress : 0;
    r->rollbacks = (int)t->rollbacks;
}

adcgs_status adcgs_trainer_run(adcgs_trainer *t, adcgs_train_observe observe, void *user, int *stopped, adcgs_error *error)
{
    const double begin = adcgs_seconds() - t->elapsed;
    double last = adcgs_seconds(), rate = 0;
    uint32_t reported = t->iteration;
    *stopped = 0;
    prepare_networks(t);
    ADCGS_TRY(take_snapshot(t, error));
    for (;;) {
        const double progress = progress_of(t);
        adcgs_train_report report;
        if (t->iteration % REPORT_EVERY == 0 || progress >= 1) {
            const double at = adcgs_seconds();
            const double lately = at > last && t->iteration > reported ? (t->iteration - reported) / (at - last) : rate;
            rate = rate > 0 ? 0.9 * rate + 0.1 * lately : lately;
            reported = t->iteration;
            last = at;
            fill_report(t, progress, rate, &report);
            if (observe && observe(user, &report)) {
                *stopped = progress < 1;
                return ADCGS_OK;
            }
        }
        if (progress >= 1) {
            take_average(t);
            return adcgs_control_finish(t, error);
        }
        if (t->until_lambda && progress >= adcgs_train_lambda_from(&t->config)) {
            *stopped = 1;
            return ADCGS_OK;
        }
        ADCGS_TRY(before_iteration(t, progress, error));
        ADCGS_TRY(adcgs_control_step(t, progress, error));
        ADCGS_TRY(iterate(t, progress, error));
        t->elapsed = adcgs_seconds() - begin;
        ADCGS_TRY(guard(t, progress, error));
    }
}

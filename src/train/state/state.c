/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Creation and release of a run's state. */
#include "train/state/state.h"

#include "fmodel/body_trajectories.h"
#include "scene/group_views.h"
#include "train/anchor_plan.h"
#include "train/continue_segment.h"
#include "train/initialise.h"
#include "train/resolve.h"
#include "train/scene_frame.h"
#include "train/start_points.h"

#include <math.h>

static size_t slots_of(const adcgs_fmodel *f)
{
    return (size_t)f->groups * ADCGS_LANES * f->params.k;
}

size_t adcgs_train_stats_size(const adcgs_fmodel *f)
{
    return 3 * slots_of(f) + 2 * (size_t)f->groups * ADCGS_LANES;
}

adcgs_train_stats adcgs_train_stats_at(float *numbers, const adcgs_fmodel *f)
{
    const size_t slots = slots_of(f), anchors = (size_t)f->groups * ADCGS_LANES;
    float *const of_anchors = numbers + 3 * slots;
    return (adcgs_train_stats){numbers, numbers + slots, numbers + 2 * slots, of_anchors, of_anchors + anchors, 0};
}

void adcgs_train_batch_forget(adcgs_train_batch *b)
{
    for (size_t i = 0; i < ADCGS_COUNTOF(b->sum); i++)
        adcgs_free(NULL, b->sum[i]);
    adcgs_free(NULL, b->means);
    adcgs_free(NULL, b->room);
    *b = (adcgs_train_batch){.results = b->results};
}

adcgs_status adcgs_trainer_resize(adcgs_trainer *t, adcgs_error *error)
{
    adcgs_bodies_recentre(t->f);
    ADCGS_TRY(adcgs_pass_resize(t->pass, t->f, error));
    adcgs_free(NULL, t->stats.weight);
    t->stats.weight = NULL;
    float *const numbers = adcgs_alloc(NULL, adcgs_train_stats_size(t->f), sizeof *numbers, error);
    if (!numbers)
        return adcgs_alloc_status(error);
    t->stats = adcgs_train_stats_at(numbers, t->f);
    return t->config.rigidity_weight > 0 ? adcgs_rigidity_build(&t->rigid, t->f, t->pool, error) : ADCGS_OK;
}

float adcgs_trainer_time(const adcgs_trainer *t, double seconds)
{
    const double duration = t->scene->duration;
    return duration > 0 ? (float)fmin(fmax(seconds / duration, 0), 1) : 0;
}

static adcgs_status create_views(adcgs_trainer *t, adcgs_error *error)
{
    t->views.n = t->scene->n_views[ADCGS_SPLIT_TRAIN];
    t->views.list = adcgs_alloc(NULL, t->views.n, sizeof *t->views.list, error);
    t->batch.results = adcgs_alloc(NULL, t->config.batch, sizeof *t->batch.results, error);
    float *times = adcgs_alloc(NULL, t->views.n, sizeof *times, error);
    adcgs_status status = t->views.list && t->batch.results && times ? ADCGS_OK : adcgs_alloc_status(error);
    for (uint32_t i = 0; status == ADCGS_OK && i < t->views.n; i++)
        times[i] = t->views.list[i].t = adcgs_trainer_time(t, t->scene->views[ADCGS_SPLIT_TRAIN][i].time);
    if (status == ADCGS_OK)
        status = adcgs_curriculum_create(&t->curriculum, times, t->views.n, t->f->follows, error);
    for (uint32_t b = 0; t->f->follows && b < t->stereo.n_bodies; b++)
        t->curriculum.known |= (uint16_t)((t->stereo.body[b].pose != NULL) << b);
    adcgs_free(NULL, times);
    if (status == ADCGS_OK)
        status =
            adcgs_exposure_create(&t->exposure, t->scene->views[ADCGS_SPLIT_TRAIN], t->views.n, t->scene->n_times <= 1, error);
    return status;
}

static adcgs_status create_viewpoints(adcgs_trainer *t, adcgs_error *error)
{
    float(*x)[3] = adcgs_alloc(NULL, t->views.n, sizeof *x, error);
    if (!x)
        return adcgs_alloc_status(error);
    for (uint32_t i = 0; i < t->views.n; i++)
        for (int a = 0; a < 3; a++)
            x[i][a] = (float)((t->scene->views[ADCGS_SPLIT_TRAIN][i].camera.cam_to_world[4 * a + 3] - t->origin[a]) / t->scale);
    const adcgs_status status = adcgs_viewpoints_create(&t->viewpoints, (const float(*)[3])x, t->views.n, error);
    adcgs_free(NULL, x);
    return status;
}

/** Continues the model of the previous segment. */
static adcgs_status follow(adcgs_trainer *t, const adcgs_model *before, adcgs_error *error)
{
    adcgs_resolve_previous(&t->config, &before->params);
    adcgs_model_digest(before, t->before);
    return adcgs_continue_segment(&t->f, before, &t->config, &t->stereo, t->scene->duration, t->cpu, error);
}

/** Finds the facts of the scene on which settings depend. */
static adcgs_status find_facts(adcgs_scene_facts *facts, const adcgs_scene *scene, adcgs_error *error)
{
    const adcgs_scene *whole = scene->whole ? scene->whole : scene;
    const uint32_t n = whole->n_views[ADCGS_SPLIT_TRAIN];
    uint32_t *of = adcgs_alloc(NULL, n, sizeof *of, error), cameras = 0;
    if (!of)
        return adcgs_alloc_status(error);
    const adcgs_status status = adcgs_group_views(whole->views[ADCGS_SPLIT_TRAIN], n, of, NULL, &cameras, error);
    adcgs_free(NULL, of);
    *facts = (adcgs_scene_facts){.times = scene->n_times,
                                 .is_shared = scene->n_views[ADCGS_SPLIT_TRAIN] >= 2 * scene->n_times,
                                 .is_sparse = !scene->splats && (uint64_t)2 * n < (uint64_t)cameras * whole->n_times};
    return status;
}

/** Resolves the settings that do not depend on matching. */
static adcgs_status resolve_begin(adcgs_trainer *t, const adcgs_trainer_input *input, const adcgs_scene_facts *facts,
                                  adcgs_error *error)
{
    adcgs_train_config *c = &t->config;
    uint32_t details = input->details ? *input->details : 0;
    adcgs_resolve_scene(c, facts);
    if (adcgs_resolve_wants_details(c)) {
        if (!input->details)
            ADCGS_TRY(adcgs_plan_details(t->scene->whole ? t->scene->whole : t->scene, c->scale, &details, error));
        adcgs_resolve_anchors(c, details);
        t->decisions.details = details;
    }
    return adcgs_resolve_target(c, error);
}

static adcgs_status create_parts(adcgs_trainer *t, const adcgs_trainer_input *input, adcgs_error *error)
{
    adcgs_train_config *c = &t->config;
    const unsigned how = (t->stereo.n_frames > 0 ? ADCGS_START_KNOWN : 0) | (input->judges_poses ? ADCGS_START_JUDGES : 0);
    adcgs_scene_facts facts;
    ADCGS_TRY(adcgs_train_check(c, error));
    if (c->bf16)
        ADCGS_TRY(adcgs_bf16_check(t->cpu, error));
    ADCGS_TRY(find_facts(&facts, t->scene, error));
    ADCGS_TRY(resolve_begin(t, input, &facts, error));
    ADCGS_TRY(adcgs_scene_frame(t->scene, t->origin, &t->scale, error));
    ADCGS_TRY(adcgs_start_match(&t->stereo, how, t->scene, c, t->pool, error));
    if (input->before)
        ADCGS_TRY(follow(t, input->before, error));
    else
        ADCGS_TRY(adcgs_initialise(&t->f, t->scene, c, &t->stereo, error));
    t->f->is_part = t->scene->whole != NULL;
    adcgs_train_rates(c, t->f);
    ADCGS_TRY(adcgs_pass_create(&t->pass, t->f, t->cpu, t->pool, error));
    ADCGS_TRY(adcgs_raster_create(&t->raster, t->cpu, t->pool, NULL, error));
    ADCGS_TRY(adcgs_raster_back_create(&t->back, t->cpu, t->pool, error));
    ADCGS_TRY(adcgs_loss_create(&t->loss, t->cpu, t->pool, error));
    ADCGS_TRY(create_views(t, error));
    /*
     * A scene with its own points is recorded from within: the space around cameras is empty, even if other cameras see something
     * behind it.
     */
    if (facts.is_shared && t->scene->points.n >= ADCGS_POINTS_LEAST)
        ADCGS_TRY(create_viewpoints(t, error));
    t->decisions.points = t->scene->points.n + (uint64_t)t->stereo.n_still + t->stereo.n_moving;
    t->decisions.allowed = c->max_anchors;
    t->decisions.began = t->decisions.most = t->f->n;
    return adcgs_trainer_resize(t, error);
}

adcgs_status adcgs_trainer_create(adcgs_trainer **out, const adcgs_scene *scene, const adcgs_train_config *config,
                                  adcgs_cpu_level cpu, adcgs_pool *pool, adcgs_error *error)
{
    return adcgs_trainer_create_from(out, scene, config, &(adcgs_trainer_input){.before = NULL}, cpu, pool, error);
}

adcgs_status adcgs_trainer_create_from(adcgs_trainer **out, const adcgs_scene *scene, const adcgs_train_config *config,
                                       const adcgs_trainer_input *input, adcgs_cpu_level cpu, adcgs_pool *pool,
                                       adcgs_error *error)
{
    adcgs_trainer *t = adcgs_alloc(NULL, 1, sizeof *t, error);
    *out = NULL;
    if (!t)
        return adcgs_alloc_status(error);
    t->config = *config;
    t->scene = scene;
    t->cpu = cpu;
    t->pool = pool;
    t->run.lr_scale = 1;
    adcgs_buffer_init(&t->run.snapshot);
    adcgs_buffer_init(&t->rate.begin);
    if (input->matched) {
        t->stereo = *input->matched;
        *input->matched = (adcgs_stereo){.n_still = 0};
    }
    const adcgs_status status = create_parts(t, input, error);
    t->rate.lambda = (double)t->config.lambda;
    if (status != ADCGS_OK)
        adcgs_trainer_free(&t);
    *out = t;
    return status;
}

void adcgs_views_unload(adcgs_trainer *t)
{
    adcgs_image_store_free(&t->views.store);
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
    adcgs_views_unload(t);
    adcgs_free(NULL, t->views.list);
    adcgs_free(NULL, t->stats.weight);
    adcgs_fmodel_free(&t->f);
    adcgs_pass_free(&t->pass);
    adcgs_raster_free(&t->raster);
    adcgs_raster_back_free(&t->back);
    adcgs_loss_free(&t->loss);
    adcgs_rigidity_clear(&t->rigid);
    adcgs_curriculum_clear(&t->curriculum);
    adcgs_exposure_clear(&t->exposure);
    adcgs_stereo_clear(&t->stereo);
    adcgs_viewpoints_clear(&t->viewpoints);
    adcgs_train_batch_forget(&t->batch);
    adcgs_free(NULL, t->batch.results);
    adcgs_weight_average_clear(&t->average);
    adcgs_run_state_clear(&t->run);
    adcgs_rate_state_clear(&t->rate);
    adcgs_free(NULL, t);
    *trainer = NULL;
}

double adcgs_trainer_progress(const adcgs_trainer *t)
{
    const double by_count = (double)t->run.iteration / t->config.iterations;
    return t->config.time_limit > 0 ? fmax(by_count, t->run.elapsed.clock / t->config.time_limit) : by_count;
}

void adcgs_trainer_prepare_networks(adcgs_trainer *t)
{
    for (int i = ADCGS_P_ANCHOR; i < ADCGS_P_COUNT; i++)
        if (t->f->mlp[i].n)
            adcgs_mlp_prepare(&t->f->mlp[i], t->f->param[i].p, t->stage.rounding);
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Pictures of the running player: jobs out, results back, window drawn. */
#include "config.h"

#include "play/player.h"

#include "camera/rotation.h"

#define HAND_SECONDS (1.0 / 30.0) /* that a picture may take while the camera is moved by hand */
#define BUDGET_MIN (1.0 / 60.0)   /* more pictures than that nobody sees */
#define BUDGET_MAX (1.0 / 15.0)   /* fewer are no film */
#define REST_SECONDS 0.5          /* without a picture, after which there is no rate of them */

/* ---- What should be drawn. ---- */

static adcgs_play_job wanted_job(const adcgs_player *p, int divider)
{
    const adcgs_play_state *const state = &p->state;
    adcgs_play_job job = {.time = adcgs_play_clock_time(&state->clock), .layers = state->layers, .divider = divider,
                          .number = adcgs_play_clock_frame(&state->clock), .seeks = p->seeks};
    adcgs_orbit_control_view(&state->control, state->width, state->height, &job.camera);
    job.tiers = adcgs_play_moving(state) && !*p->shot ? p->scale.tiers : p->scale.all;
    if (divider > 1)
        adcgs_camera_stretch(&job.camera, (state->width + divider - 1) / divider, (state->height + divider - 1) / divider);
    return job;
}

static int same_picture(const adcgs_play_job *a, const adcgs_play_job *b)
{
    const adcgs_camera *const c = &a->camera, *const d = &b->camera;
    return c->width == d->width && c->height == d->height && c->fx == d->fx && c->fy == d->fy && c->cx == d->cx &&
           c->cy == d->cy && c->near_plane == d->near_plane && a->time == b->time && a->number == b->number &&
           a->layers == b->layers && a->tiers == b->tiers && !memcmp(c->cam_to_world, d->cam_to_world, sizeof c->cam_to_world);
}

static int wanted_divider(const adcgs_player *p)
{
    return adcgs_play_moving(&p->state) ? ADCGS_MAX(p->least_divider, p->scale.divider) : p->least_divider;
}

int adcgs_player_settled(const adcgs_player *p)
{
    const adcgs_play_job wanted = wanted_job(p, wanted_divider(p));
    return !p->drawing && !*p->shot && !p->state.shot && !adcgs_play_moving(&p->state) && same_picture(&p->job, &wanted);
}

static double budget(const adcgs_player *p)
{
    const adcgs_play_clock *const clock = &p->state.clock;
    const double seconds = clock->playing ? 1.0 / (clock->rate * adcgs_play_clock_factor(clock)) : HAND_SECONDS;
    return ADCGS_MAX(BUDGET_MIN, ADCGS_MIN(seconds, BUDGET_MAX));
}

void adcgs_player_post(adcgs_player *p)
{
    adcgs_play_job job = wanted_job(p, *p->shot ? 1 : wanted_divider(p));
    if (p->drawing || (!*p->shot && same_picture(&job, &p->job)))
        return;
    memcpy(job.path, p->shot, sizeof job.path);
    p->drawing = adcgs_worker_post(p->worker, &job);
    if (p->drawing && !*p->shot)
        p->job = job;
}

/* ---- What was drawn. ---- */

static void take_shot(adcgs_player *p, const adcgs_play_result *result)
{
    p->shot_status = result->status;
    p->shot_error = result->error;
    if (result->status == ADCGS_OK)
        adcgs_play_say(&p->state, "%s", p->shot);
    else
        adcgs_play_say(&p->state, "%s", result->error.text);
    *p->shot = 0;
}

/** What cannot be drawn for lack of memory is drawn smaller; the player goes on in any case. */
static void take_failure(adcgs_player *p, const adcgs_play_result *result)
{
    const int too_large = result->status == ADCGS_ERR_LIMIT || result->status == ADCGS_ERR_MEMORY;
    if (too_large && result->job.divider < ADCGS_PLAY_DIVIDER_MAX)
        p->least_divider = result->job.divider + 1;
    else {
        p->failure = result->status;
        p->failure_error = result->error;
        adcgs_play_say(&p->state, "%s", result->error.text);
    }
}

static void count_picture(adcgs_player *p, const adcgs_play_result *result)
{
    adcgs_play_figures *const f = &p->figures;
    const double now = adcgs_seconds(), since = now - p->arrived;
    p->period = p->period > 0.0 ? 0.9 * p->period + 0.1 * since : since;
    if (!p->pictures || since > REST_SECONDS)
        p->period = 0.0;
    p->arrived = now;
    f->seconds = result->seconds;
    f->width = result->job.camera.width;
    f->height = result->job.camera.height;
    f->splats = result->splats;
    f->tiers = result->job.tiers;
    p->pictures++;
}

/** Frames left out on purpose, at a higher speed or by going elsewhere, do not count. */
static void count_dropped(adcgs_player *p, const adcgs_play_job *job)
{
    const adcgs_play_clock *const clock = &p->state.clock;
    if (clock->playing && clock->speed <= 0 && p->last_frame >= 0 && p->last_seeks == job->seeks)
        p->figures.dropped += adcgs_play_clock_dropped(clock, p->last_frame, job->number);
    p->last_frame = clock->playing ? job->number : -1;
    p->last_seeks = job->seeks;
}

static adcgs_status take_picture(adcgs_player *p, const adcgs_play_result *result, adcgs_error *error)
{
    const adcgs_camera *const camera = &result->job.camera;
    p->failure = ADCGS_OK;
    count_picture(p, result);
    count_dropped(p, &result->job);
    if (adcgs_play_moving(&p->state) && result->job.divider == p->scale.divider &&
        result->job.tiers == p->scale.tiers)
        adcgs_play_scale_took(&p->scale, result->seconds, budget(p));
    p->stale = 1;
    return p->sdl->picture(p->window, result->rgb, camera->width, camera->height, error);
}

adcgs_status adcgs_player_collect(adcgs_player *p, adcgs_error *error)
{
    const adcgs_play_result *const result = p->drawing ? adcgs_worker_result(p->worker) : NULL;
    adcgs_status status = ADCGS_OK;
    if (!result)
        return ADCGS_OK;
    p->drawing = 0;
    if (*result->job.path)
        take_shot(p, result);
    else if (result->status != ADCGS_OK)
        take_failure(p, result);
    else
        status = take_picture(p, result, error);
    adcgs_worker_release(p->worker);
    return status;
}

adcgs_status adcgs_player_show(adcgs_player *p, uint8_t *rgb, adcgs_error *error)
{
    p->stale = 0;
    p->shown = adcgs_seconds();
    p->figures.rate = p->period > 0.0 && p->shown - p->arrived < REST_SECONDS ? 1.0 / p->period : 0.0;
    adcgs_overlay_draw(p->panels, &p->state, &p->figures);
    return p->sdl->show(p->window, p->panels, rgb, error);
}

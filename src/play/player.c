/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Images of the running player: posts jobs, takes results, renders the window. */
#include "config.h"

#include "play/player.h"

#include "geometry/rotation.h"
#include "play/actions.h"
#include "play/by_hand.h"

#include <math.h>
#include <stdio.h>

/* Origin: chosen by hand, not measured. */
#define HAND_SECONDS (1.0 / 30.0) /* seconds, maximum time of an image while the user moves the camera */
#define BUDGET_MIN (1.0 / 60.0)   /* seconds; more images per second are invisible */
#define BUDGET_MAX (1.0 / 15.0)   /* seconds; fewer images per second are no film */
#define REST_SECONDS 0.5          /* without an image, after which the rate is unknown */

/* ---- Received data ---- */

void adcgs_player_has_all(adcgs_player *p)
{
    const adcgs_play_settings *const s = p->settings;
    p->come = (adcgs_come){.info = s->info, .bytes = s->source.bytes, .drawable = 1, .over = 1};
}

/** True if more has arrived than the worker has decoded. */
static int lags(const adcgs_player *p)
{
    adcgs_feed *const feed = p->settings->source.feed;
    int ended;
    return feed && !p->come.over && (adcgs_feed_bytes(feed, &ended) > p->come.bytes || ended);
}

/** Describes the received part for the user. */
static void describe(adcgs_player *p)
{
    const adcgs_info *const info = &p->come.info;
    const double bytes = (double)p->come.bytes;
    char segment[60] = "", tier[60] = "";
    const int number = info->segments + (info->tiers_received > 0);
    if (info->segments_total > 1)
        snprintf(segment, sizeof segment, "segment %d of %d, ", number, info->segments_total);
    if (info->tiers_received)
        snprintf(tier, sizeof tier, "tier %d of %d, ", info->tiers_received, info->tiers);
    snprintf(p->figures.coming, sizeof p->figures.coming, "%s%s%.*f %s", segment, tier, bytes < 1e6 ? 0 : 1,
             bytes / (bytes < 1e6 ? 1e3 : 1e6), bytes < 1e6 ? "KB" : "MB");
}

/** Sets the time range, and its available part. */
static void set_span(adcgs_player *p)
{
    const adcgs_info *const info = &p->come.info;
    adcgs_play_clock *const clock = &p->state.clock;
    const int promised = isfinite(info->time_end) && p->come.fault.status == ADCGS_OK;
    if (!p->settings->is_span)
        adcgs_play_clock_span(clock, info->time_start,
                              promised ? info->time_end : ADCGS_MAX(info->time_available, info->time_start));
    clock->available = p->come.over ? INFINITY : info->time_available - clock->begin;
}

static void take_come(adcgs_player *p, const adcgs_come *come)
{
    const int ends = come->over && !p->come.over;
    p->come = *come;
    p->stale = 1;
    *p->figures.coming = 0;
    if (!come->info.size)
        return; /* not even the header */
    set_span(p);
    if (come->info.tiers != p->scale.all)
        adcgs_play_scale_init(&p->scale, come->info.tiers);
    if (!come->over)
        describe(p);
    if (ends && come->fault.status != ADCGS_OK)
        adcgs_play_say(&p->state, "%s", come->fault.text);
    else if (ends && come->info.truncated)
        adcgs_play_say(&p->state, "the stream ends early");
}

/* ---- Jobs ---- */

/** True if a screenshot can be made. */
static int shoots(const adcgs_player *p)
{
    return *p->shot && p->come.drawable;
}

/** True if the next image is a frame of a video. */
static int records(const adcgs_player *p)
{
    return p->recording.sink && p->state.record && p->come.drawable && !*p->shot;
}

static adcgs_play_job wanted_job(const adcgs_player *p, int divider)
{
    const adcgs_play_state *const state = &p->state;
    adcgs_play_job job = {.time = adcgs_play_clock_time(&state->clock),
                          .layers = state->layers,
                          .divider = divider,
                          .number = adcgs_play_clock_frame(&state->clock),
                          .seeks = p->seeks};
    const int films = records(p), width = films ? p->recording.width : state->width;
    adcgs_orbit_control_view(&state->control, width, films ? p->recording.height : state->height, &job.camera);
    job.tiers = adcgs_play_moving(state) && !shoots(p) && !films ? p->scale.tiers : p->scale.all;
    if (p->pivots != state->pivots && p->come.drawable && !films)
        job.pivot = state->pivots;
    memcpy(job.pivot_at, state->pivot_at, sizeof job.pivot_at);
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
    if (records(p))
        return 1;
    return adcgs_play_moving(&p->state) ? ADCGS_MAX(p->least_divider, p->scale.divider) : p->least_divider;
}

int adcgs_player_settled(const adcgs_player *p)
{
    const adcgs_play_job wanted = wanted_job(p, wanted_divider(p));
    const int has_all = p->pictures > 0 || !p->settings->source.feed;
    const int waits = p->drawing || wanted.pivot || *p->shot || p->state.shot || p->state.record || adcgs_play_moving(&p->state);
    return !waits && same_picture(&p->job, &wanted) && has_all && !lags(p);
}

static double budget(const adcgs_player *p)
{
    const adcgs_play_clock *const clock = &p->state.clock;
    const double seconds = clock->playing ? 1.0 / (clock->rate * adcgs_play_clock_factor(clock)) : HAND_SECONDS;
    return ADCGS_MAX(BUDGET_MIN, ADCGS_MIN(seconds, BUDGET_MAX));
}

void adcgs_player_post(adcgs_player *p)
{
    const int shot = shoots(p), films = records(p);
    adcgs_play_job job = wanted_job(p, shot ? 1 : wanted_divider(p));
    const int same = !shot && !films && !job.pivot && same_picture(&job, &p->job);
    if (p->drawing || (same && !lags(p)) || (films && !adcgs_recording_due(&p->recording)))
        return;
    job.sink = films ? p->recording.sink : NULL;
    job.again = same;
    if (shot)
        memcpy(job.path, p->shot, sizeof job.path);
    p->drawing = adcgs_worker_post(p->worker, &job);
    if (p->drawing && job.pivot)
        p->pivots = job.pivot;
    if (p->drawing && films)
        adcgs_recording_posted(&p->recording);
    if (p->drawing && !shot)
        p->job = job;
}

/* ---- Results ---- */

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

/** Takes a frame of the video, or ends the video. \return nonzero if the image can be shown, too */
static int take_frame(adcgs_player *p, const adcgs_play_result *result)
{
    if (result->status == ADCGS_OK) {
        p->state.recorded = ++p->recording.frames;
        return 1;
    }
    adcgs_recording_fail(&p->recording, &result->error);
    p->state.record = 0;
    adcgs_play_say(&p->state, "%s", result->error.text);
    return 0;
}

/** Reduces the resolution after an allocation failure. The player continues in any case. */
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

/** Frames that are skipped on purpose, at a higher speed or by a jump, do not count. */
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
    if (adcgs_play_moving(&p->state) && result->job.divider == p->scale.divider && result->job.tiers == p->scale.tiers)
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
    if (p->settings->source.feed)
        take_come(p, &result->come);
    if (result->has_pivot)
        adcgs_play_pivot(&p->state, result->job.pivot, result->pivot);
    const int shows = !result->job.sink || take_frame(p, result);
    if (!shows)
        p->job.camera.width = 0; /* renders it again, for the window alone */
    else if (*result->job.path)
        take_shot(p, result);
    else if (result->status != ADCGS_OK)
        take_failure(p, result);
    else if (result->rgb)
        status = take_picture(p, result, error);
    adcgs_worker_release(p->worker);
    return status;
}

adcgs_status adcgs_player_show(adcgs_player *p, uint8_t *rgb, adcgs_error *error)
{
    p->stale = 0;
    p->shown = adcgs_seconds();
    p->figures.rate = p->period > 0.0 && p->shown - p->arrived < REST_SECONDS ? 1.0 / p->period : 0.0;
    adcgs_overlay_draw(&p->overlay, p->sdl->type(p->window), &p->state, &p->figures);
    return p->sdl->show(p->window, &p->overlay, rgb, error);
}

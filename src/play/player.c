/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The player's loop: events in, jobs out, pictures back, window drawn. */
#include "config.h"

#include "play/player.h"

#include "camera/rotation.h"
#include "play/panel.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#define HEIGHT_WANTED 480         /* of the first window; smaller cameras are enlarged by a whole number */
#define SIDE_MAX 4096             /* of the first window, whatever the camera */
#define HAND_SECONDS (1.0 / 30.0) /* that a picture may take while the camera is moved by hand */
#define BUDGET_MIN (1.0 / 60.0)   /* more pictures than that nobody sees */
#define BUDGET_MAX (1.0 / 15.0)   /* fewer are no film */
#define REFRESH_SECONDS 0.25      /* after which figures and messages are drawn anew */
#define REST_SECONDS 0.5          /* without a picture, after which there is no rate of them */
#define WAIT_MOVING 4             /* milliseconds to wait for events */
#define WAIT_STILL 100
#define SHOTS_MAX 999999

/* ---- What should be drawn. ---- */

static adcgs_play_job wanted_job(const adcgs_player *p, int divider)
{
    const adcgs_play_state *const state = &p->state;
    adcgs_play_job job = {.time = adcgs_play_clock_time(&state->clock), .layers = state->layers, .divider = divider,
                          .number = adcgs_play_clock_frame(&state->clock), .seeks = p->seeks};
    adcgs_play_rig_view(&state->rig, state->width, state->height, &job.camera);
    if (divider > 1)
        adcgs_camera_stretch(&job.camera, (state->width + divider - 1) / divider, (state->height + divider - 1) / divider);
    return job;
}

static int same_picture(const adcgs_play_job *a, const adcgs_play_job *b)
{
    const adcgs_camera *const c = &a->camera, *const d = &b->camera;
    return c->width == d->width && c->height == d->height && c->fx == d->fx && c->fy == d->fy && c->cx == d->cx &&
           c->cy == d->cy && c->near_plane == d->near_plane && a->time == b->time && a->number == b->number &&
           a->layers == b->layers && !memcmp(c->cam_to_world, d->cam_to_world, sizeof c->cam_to_world);
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

/** Give the worker something to do, if it has nothing and there is something. */
static void post(adcgs_player *p)
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

/** A name that no file has yet: the stream's, and a number. */
static void name_shot(adcgs_player *p, const char *extension)
{
    const char *const slash = strrchr(p->settings->path, '/'), *const name = slash ? slash + 1 : p->settings->path;
    const char *const dot = strrchr(name, '.');
    const int length = dot && dot > name ? (int)(dot - name) : (int)strlen(name);
    for (int i = 1; i <= SHOTS_MAX; i++) {
        snprintf(p->shot, sizeof p->shot, "%.*s-%06d.%s", length, name, i, extension);
        if (access(p->shot, F_OK))
            return;
    }
    *p->shot = 0;
    adcgs_play_say(&p->state, "no number is left for a screenshot");
}

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
    if (adcgs_play_moving(&p->state) && result->job.divider == p->scale.divider)
        adcgs_play_scale_took(&p->scale, result->seconds, budget(p));
    p->stale = 1;
    return p->sdl->picture(p->window, result->rgb, camera->width, camera->height, error);
}

static adcgs_status collect(adcgs_player *p, adcgs_error *error)
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

/* ---- The window. ---- */

adcgs_status adcgs_player_show(adcgs_player *p, uint8_t *rgb, adcgs_error *error)
{
    p->stale = 0;
    p->shown = adcgs_seconds();
    p->figures.rate = p->period > 0.0 && p->shown - p->arrived < REST_SECONDS ? 1.0 / p->period : 0.0;
    adcgs_overlay_draw(p->panels, &p->state, &p->figures);
    return p->sdl->show(p->window, p->panels, rgb, error);
}

static void measure_window(adcgs_player *p)
{
    int width, height;
    double density;
    p->sdl->size(p->window, &width, &height, &density);
    if (width != p->state.width || height != p->state.height)
        p->least_divider = 1;
    adcgs_play_resize(&p->state, width, height, density);
}

static void take_events(adcgs_player *p)
{
    const int moves = adcgs_play_moving(&p->state) || p->run.at < p->run.script.n;
    adcgs_event event;
    for (int wait = moves ? WAIT_MOVING : WAIT_STILL; p->sdl->event(p->window, wait, &event); wait = 0) {
        const int frame = adcgs_play_clock_frame(&p->state.clock);
        adcgs_play_event(&p->state, &event);
        p->seeks += adcgs_play_clock_frame(&p->state.clock) != frame;
        p->stale |= event.kind != ADCGS_EVENT_NONE;
        if (event.kind == ADCGS_EVENT_SIZE)
            measure_window(p);
    }
    if (p->captured != p->state.flying)
        p->sdl->capture(p->window, p->state.flying);
    p->captured = p->state.flying;
    if (p->state.shot && !*p->shot) {
        name_shot(p, p->state.shot == ADCGS_SHOT_EXR ? "exr" : "png");
        p->state.shot = ADCGS_SHOT_NONE;
    }
}

/** Screenshots that were asked for are made before the player leaves. */
static adcgs_status loop(adcgs_player *p, adcgs_error *error)
{
    while ((!p->state.quit || p->state.shot || *p->shot) && !p->settings->interrupted()) {
        take_events(p);
        adcgs_play_tick(&p->state, adcgs_seconds());
        ADCGS_TRY(collect(p, error));
        post(p);
        ADCGS_TRY(adcgs_script_go(p, error));
        if (p->stale || p->state.now - p->shown > REFRESH_SECONDS)
            ADCGS_TRY(adcgs_player_show(p, NULL, error));
    }
    return ADCGS_OK;
}

static void wake(void *arg)
{
    adcgs_player *const p = arg;
    p->sdl->wake(p->window);
}

static adcgs_status open_window(adcgs_player *p, adcgs_error *error)
{
    const adcgs_play_settings *const s = p->settings;
    const int times = (HEIGHT_WANTED + s->home.height - 1) / s->home.height;
    const int suits[2] = {ADCGS_MIN(times * s->home.width, SIDE_MAX), ADCGS_MIN(times * s->home.height, SIDE_MAX)};
    const int *const size = s->size[0] ? s->size : suits;
    ADCGS_TRY(adcgs_sdl_get(&p->sdl, s->path, error));
    ADCGS_TRY(p->sdl->open(&p->window, s->path, size[0], size[1], error));
    measure_window(p);
    return adcgs_worker_create(&p->worker, s->data, s->bytes, s->path, &s->config, wake, p, error);
}

static void init(adcgs_player *p, const adcgs_play_settings *s)
{
    *p = (adcgs_player){.settings = s, .least_divider = 1, .last_frame = -1, .stale = 1};
    adcgs_play_clock *const clock = &p->state.clock;
    adcgs_play_init(&p->state, &s->info, &s->home, s->cameras);
    adcgs_play_scale_init(&p->scale);
    if (s->config.layers)
        p->state.layers = ADCGS_MIN(s->config.layers, p->state.layers_max);
    adcgs_play_tick(&p->state, adcgs_seconds());
    adcgs_play_clock_init(clock, s->begin, s->end, s->info.frame_rate, p->state.now);
    if (clock->frames > 1)
        adcgs_play_clock_seek(clock, (s->start - s->begin) * clock->rate / (clock->frames - 1));
    if (!s->paused)
        adcgs_play_clock_toggle(clock);
    if (s->info.truncated)
        adcgs_play_say(&p->state, "the stream ends early");
}

adcgs_status adcgs_play_run(const adcgs_play_settings *settings, int *failed, adcgs_error *error)
{
    adcgs_player *p = malloc(sizeof *p);
    *failed = 0;
    if (!p)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for the player");
    init(p, settings);
    adcgs_status status = settings->script ? adcgs_script_read(&p->run.script, settings->script, error) : ADCGS_OK;
    if (status == ADCGS_OK)
        status = open_window(p, error);
    if (status == ADCGS_OK)
        status = loop(p, error);
    adcgs_worker_free(&p->worker); /* first, since it wakes the window */
    if (p->window)
        p->sdl->close(&p->window);
    for (int i = 0; i < ADCGS_PANELS; i++)
        adcgs_panel_free(&p->panels[i]);
    adcgs_script_clear(&p->run.script);
    *failed = status == ADCGS_OK && p->run.failed;
    free(p);
    return status;
}

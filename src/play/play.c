/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The player's loop: takes events and reacts to them. */
#include "config.h"

#include "cli/cli.h"
#include "play/actions.h"
#include "play/files.h"
#include "play/player.h"
#include "play/script_run.h"
#include "system/text.h"

#include <stdlib.h>

/* Origin: chosen by hand, not measured. */
#define HEIGHT_WANTED 480    /* pixels, of the first window; smaller cameras are enlarged by a whole number */
#define SIDE_MAX 4096        /* pixels, of the first window, for any camera */
#define REFRESH_SECONDS 0.25 /* interval at which figures and messages are rendered again */
#define WAIT_MOVING 4        /* milliseconds to wait for events, while the image moves, in recordings and scripts */
#define WAIT_STILL 100       /* the same otherwise */

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
    const int moves = adcgs_play_moving(&p->state) || p->state.record || p->run.at < p->run.script.n;
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
    if (p->full != p->state.full)
        p->sdl->fullscreen(p->window, p->state.full);
    p->full = p->state.full;
}

/* ---- Events that concern files ---- */

static void begin_shot(adcgs_player *p)
{
    if (!p->state.shot || *p->shot)
        return;
    if (!adcgs_play_free_name(p->shot, p->settings->source.path, p->state.shot == ADCGS_SOURCE_IMAGE_EXR ? "exr" : "png"))
        adcgs_play_say(&p->state, "no unused file name is left for a screenshot");
    p->state.shot = ADCGS_SOURCE_IMAGE_NONE;
}

static void set_key_frame(adcgs_player *p)
{
    const adcgs_play_settings *const s = p->settings;
    adcgs_play_state *const state = &p->state;
    const double time = adcgs_play_clock_time(&state->clock);
    adcgs_camera camera;
    adcgs_error error;
    if (!state->key_frame)
        return;
    adcgs_orbit_control_view(&state->control, state->width, state->height, &camera);
    const adcgs_status status = state->key_frame > 0
                                    ? adcgs_key_frames_add(&p->keys, &camera, time, s->source.path, &s->info, &error)
                                    : adcgs_key_frames_take_back(&p->keys, &s->info, &error);
    if (status != ADCGS_OK)
        adcgs_play_say(state, "%s", error.text);
    else if (p->keys.n)
        adcgs_play_say(state, "%d key frame%s: %s", p->keys.n, p->keys.n == 1 ? "" : "s", p->keys.path);
    else
        adcgs_play_say(state, "no key frames");
    state->key_frame = 0;
}

/** Begins or ends the video, while the worker does not use it. */
static void follow_recording(adcgs_player *p)
{
    adcgs_recording *const r = &p->recording;
    if (p->drawing || p->state.record == (r->sink != NULL))
        return;
    const adcgs_status status = r->sink ? adcgs_recording_end(r)
                                        : adcgs_recording_begin(r, p->settings->source.path, p->state.width, p->state.height,
                                                                p->settings->info.frame_rate);
    p->state.recorded = r->frames;
    if (status != ADCGS_OK) {
        p->state.record = 0;
        adcgs_play_say(&p->state, "%s", r->error.text);
    } else if (!r->sink) {
        adcgs_play_say(&p->state, "%s: %ld frame%s", r->path, r->frames, adcgs_s((uint64_t)r->frames));
        *r->path = 0; /* the next one gets another name */
    }
}

/** Requested screenshots are made before the player leaves. */
static adcgs_status loop(adcgs_player *p, adcgs_error *error)
{
    while ((!p->state.quit || p->state.shot || *p->shot) && !p->settings->interrupted()) {
        if (!p->come.drawable && (p->come.over || p->state.quit))
            return ADCGS_OK; /* there will never be an image */
        take_events(p);
        begin_shot(p);
        set_key_frame(p);
        ADCGS_TRY(adcgs_player_collect(p, error));
        follow_recording(p);
        adcgs_play_tick(&p->state, adcgs_recording_now(&p->recording)); /* a collected frame is a step of time */
        adcgs_player_post(p);
        ADCGS_TRY(adcgs_script_go(p, error));
        if (p->stale || adcgs_seconds() - p->shown > REFRESH_SECONDS)
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
    ADCGS_TRY(adcgs_sdl_get(&p->sdl, s->source.path, error));
    ADCGS_TRY(p->sdl->open(&p->window, s->source.path, size[0], size[1], error));
    measure_window(p);
    if (*p->sdl->plain(p->window))
        adcgs_cli_note(s->cli, "%s: the player uses plain letters", p->sdl->plain(p->window));
    ADCGS_TRY(adcgs_worker_create(&p->worker, &s->source, &s->config, wake, p, error));
    return s->source.feed ? adcgs_feed_start(s->source.feed, wake, p, error) : ADCGS_OK;
}

static void init(adcgs_player *p, const adcgs_play_settings *s)
{
    *p = (adcgs_player){.settings = s, .least_divider = 1, .last_frame = -1, .stale = 1};
    adcgs_play_clock *const clock = &p->state.clock;
    adcgs_play_init(&p->state, &s->info, &s->home, s->cameras, s->filmed);
    adcgs_play_scale_init(&p->scale, s->info.tiers);
    if (s->config.layers)
        p->state.layers = ADCGS_MIN(s->config.layers, p->state.layers_max);
    adcgs_play_tick(&p->state, adcgs_seconds());
    adcgs_play_clock_init(clock, s->begin, s->end, s->info.frame_rate, p->state.now);
    if (clock->frames > 1)
        adcgs_play_clock_seek(clock, (s->start - s->begin) * clock->rate / (clock->frames - 1));
    if (!s->paused)
        adcgs_play_clock_toggle(clock);
    if (!s->source.feed)
        adcgs_player_has_all(p);
    else
        clock->available = 0.0; /* nothing playable has arrived */
    if (s->info.truncated && !s->source.feed)
        adcgs_play_say(&p->state, "the stream ends early");
}

adcgs_status adcgs_play_run(const adcgs_play_settings *s, int *failed, adcgs_error *error)
{
    adcgs_player *p = malloc(sizeof *p);
    *failed = 0;
    if (!p)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for the player");
    init(p, s);
    adcgs_status status = s->script ? adcgs_script_read(&p->run.script, s->script, error) : ADCGS_OK;
    if (status == ADCGS_OK)
        status = open_window(p, error);
    if (status == ADCGS_OK)
        status = loop(p, error);
    if (s->source.feed)
        adcgs_feed_stop(s->source.feed); /* first, since they wake the window */
    adcgs_worker_free(&p->worker);
    if (adcgs_recording_end(&p->recording) != ADCGS_OK && status == ADCGS_OK) {
        *error = p->recording.error;
        status = error->status;
    }
    if (p->window)
        p->sdl->close(&p->window);
    adcgs_key_frames_clear(&p->keys);
    adcgs_script_clear(&p->run.script);
    *failed = status == ADCGS_OK && p->run.failed;
    if (status == ADCGS_OK && !*failed && p->come.fault.status != ADCGS_OK) {
        *error = p->come.fault;
        status = error->status;
    }
    free(p);
    return status;
}

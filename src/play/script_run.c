/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Executes a script. */
#include "config.h"

#include "play/script_run.h"

#include "media/image/image.h"
#include "play/by_hand.h"
#include "play/controls.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Origin: chosen by hand, not measured. */
#define DRAG_STEPS 8     /* movements of a drag */
#define SIZE_SECONDS 5.0 /* maximum time for a window to change its size */

/** State of a line: the next may follow when it is done. Some lines require that events are taken first. */
typedef enum outcome { AGAIN, DONE, DONE_TAKE_EVENTS } outcome;

static void push_key(adcgs_player *p, int key, int down)
{
    p->sdl->push(p->window, &(adcgs_event){.kind = ADCGS_EVENT_KEY, .key = key, .down = down});
}

static void press(adcgs_player *p, const adcgs_script_line *line)
{
    if (line->shift)
        push_key(p, ADCGS_KEY_SHIFT, 1);
    push_key(p, line->key, 1);
    push_key(p, line->key, 0);
    if (line->shift)
        push_key(p, ADCGS_KEY_SHIFT, 0);
}

static void drag(adcgs_player *p, const adcgs_script_line *line, int button, const double n[4])
{
    const double dx = (n[2] - n[0]) / DRAG_STEPS, dy = (n[3] - n[1]) / DRAG_STEPS;
    adcgs_event event = {.kind = ADCGS_EVENT_BUTTON, .button = button, .down = 1, .x = n[0], .y = n[1]};
    if (line->shift)
        push_key(p, ADCGS_KEY_SHIFT, 1);
    p->sdl->push(p->window, &event);
    for (int i = 1; i <= DRAG_STEPS; i++)
        p->sdl->push(p->window, &(adcgs_event){.kind = ADCGS_EVENT_MOTION,
                                               .x = n[0] + i * dx,
                                               .y = n[1] + i * dy,
                                               .dx = floor(i * dx) - floor((i - 1) * dx),
                                               .dy = floor(i * dy) - floor((i - 1) * dy)});
    event.down = 0;
    event.x = n[2];
    event.y = n[3];
    p->sdl->push(p->window, &event);
    if (line->shift)
        push_key(p, ADCGS_KEY_SHIFT, 0);
}

static adcgs_status wrong(const adcgs_player *p, const adcgs_script_line *line, adcgs_status status, const char *what,
                          adcgs_error *error)
{
    return adcgs_fail(error, status, "%.160s: line %d: %.160s", p->settings->script, line->line, what);
}

/** Ends the script after an expectation that does not hold. */
static void disappoint(adcgs_player *p, const adcgs_script_line *line, const char *what, adcgs_error *error)
{
    wrong(p, line, ADCGS_ERR_DATA, what, error);
    p->run.failed = 1;
    p->state.quit = 1;
}

/** Moves the pointer to a control, and presses it or drags along it. */
static void use_control(adcgs_player *p, const adcgs_script_line *line, adcgs_error *error)
{
    const int slides = line->kind == ADCGS_SCRIPT_SLIDE;
    adcgs_controls controls;
    adcgs_controls_place(&controls, &p->state);
    const adcgs_rect r = controls.place[slides ? (int)ADCGS_CONTROL_SLIDER : line->key];
    const double x = r.x + r.width / 2, y = r.y + r.height / 2;
    if (!r.width) {
        disappoint(p, line, "the window does not show this control", error);
        return;
    }
    if (slides)
        drag(p, line, 1, (double[4]){r.x + line->number[0] * (r.width - 1), y, r.x + line->number[1] * (r.width - 1), y});
    else
        p->sdl->push(p->window, &(adcgs_event){.kind = ADCGS_EVENT_MOTION, .x = x, .y = y});
    for (int down = 1; down >= 0 && line->kind == ADCGS_SCRIPT_CLICK; down--)
        p->sdl->push(p->window, &(adcgs_event){.kind = ADCGS_EVENT_BUTTON, .button = 1, .down = down, .x = x, .y = y});
}

static outcome wait_frames(const adcgs_player *p, const adcgs_script_line *line)
{
    return p->pictures - p->run.pictures >= line->number[0] || adcgs_player_settled(p) ? DONE : AGAIN;
}

/** True if this part of the stream has arrived and was decoded, or if the stream has ended. */
static outcome wait_stream(const adcgs_player *p, const adcgs_script_line *line)
{
    const adcgs_come *const come = &p->come;
    const double there = line->kind == ADCGS_SCRIPT_WAIT_BYTES      ? (double)come->bytes
                         : line->kind == ADCGS_SCRIPT_WAIT_TIERS    ? come->info.tiers_received
                         : line->kind == ADCGS_SCRIPT_WAIT_SEGMENTS ? come->info.segments
                                                                    : -1.0; /* the end */
    return come->over || there >= line->number[0] ? DONE : AGAIN;
}

static outcome wait_size(adcgs_player *p, const adcgs_script_line *line, adcgs_error *error)
{
    char text[100];
    if (p->state.width == (int)line->number[0] && p->state.height == (int)line->number[1])
        return adcgs_player_settled(p) || adcgs_play_moving(&p->state) ? DONE : AGAIN;
    if (p->state.now - p->run.since < SIZE_SECONDS)
        return AGAIN;
    snprintf(text, sizeof text, "the window's size is %dx%d, and does not change", p->state.width, p->state.height);
    disappoint(p, line, text, error);
    return DONE;
}

/** Finds a value that can be expected. \return 0 if there is no such name */
static int find_value(const adcgs_player *p, const char *name, double *value)
{
    const adcgs_play_state *const s = &p->state;
    adcgs_controls controls;
    adcgs_controls_place(&controls, s);
    const struct {
        const char *name;
        double value;
    } values[] = {
        {"time", adcgs_play_clock_time(&s->clock)},
        {"frame", adcgs_play_clock_frame(&s->clock)},
        {"speed", adcgs_play_clock_factor(&s->clock)},
        {"playing", s->clock.playing},
        {"loop", s->clock.loop},
        {"layers", s->layers},
        {"camera", s->jumped},
        {"flying", s->flying},
        {"following", s->filmed && s->filmed->following},
        {"outside", adcgs_play_outside(s)},
        {"help", s->help},
        {"statistics", s->statistics},
        {"bar", s->bar},
        {"controls", controls.back.width > 0},
        {"pointed", adcgs_play_pointed(s)},
        {"hint", adcgs_overlay_hints(s)},
        {"letters", controls.size},
        {"inside", adcgs_drawing_inside(&p->overlay, s->width, s->height)},
        {"full", s->full},
        {"keys", p->keys.n},
        {"recording", s->record},
        {"recorded", (double)s->recorded},
        {"distance", adcgs_orbit_control_distance(&s->control)},
        {"splats", p->figures.splats},
        {"divider", p->job.divider},
        {"tiers", p->job.tiers},
        {"bytes", (double)p->come.bytes},
        {"segments", p->come.info.segments},
        {"ended", p->come.over},
    };
    for (size_t i = 0; i < ADCGS_COUNTOF(values); i++)
        if (!strcmp(values[i].name, name)) {
            *value = values[i].value;
            return 1;
        }
    return 0;
}

static adcgs_status expect(adcgs_player *p, const adcgs_script_line *line, adcgs_error *error)
{
    const adcgs_play_state *const s = &p->state;
    const double *const n = line->number;
    char text[160] = "";
    double value;
    adcgs_overlay_draw(&p->overlay, p->sdl->type(p->window), s, &p->figures);
    if (!strcmp(line->text, "size")) {
        if (s->width != (int)n[0] || s->height != (int)n[1])
            snprintf(text, sizeof text, "size is %dx%d, expected %dx%d", s->width, s->height, (int)n[0], (int)n[1]);
    } else if (!find_value(p, line->text, &value))
        return wrong(p, line, ADCGS_ERR_USAGE, "no value of that name can be expected", error);
    else if (!(fabs(value - n[0]) <= n[1]))
        snprintf(text, sizeof text, "%.40s is %.9g, expected %.9g", line->text, value, n[0]);
    if (*text)
        disappoint(p, line, text, error);
    return ADCGS_OK;
}

static adcgs_status write_window(adcgs_player *p, const char *path, adcgs_error *error)
{
    adcgs_image image;
    ADCGS_TRY(adcgs_image_alloc(&image, p->state.width, p->state.height, 3, path, error));
    const size_t samples = 3 * (size_t)image.width * (size_t)image.height;
    uint8_t *const rgb = malloc(samples);
    adcgs_status status = rgb ? adcgs_player_show(p, rgb, error) : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    for (size_t i = 0; i < samples && status == ADCGS_OK; i++)
        image.data[i] = (float)rgb[i] / 255.0f;
    if (status == ADCGS_OK)
        status = adcgs_image_write(&image, path, 0, error);
    free(rgb);
    adcgs_image_free(&image);
    return status;
}

static void begin_shot(adcgs_player *p, const char *path)
{
    snprintf(p->shot, sizeof p->shot, "%s", path);
    p->shot_status = ADCGS_OK;
}

/** Executes the part of a line that is done once. */
static outcome begin(adcgs_player *p, const adcgs_script_line *line, adcgs_error *error)
{
    switch (line->kind) {
    case ADCGS_SCRIPT_POINT:
    case ADCGS_SCRIPT_CLICK:
    case ADCGS_SCRIPT_SLIDE:
        use_control(p, line, error);
        return DONE_TAKE_EVENTS;
    case ADCGS_SCRIPT_DRAG:
        drag(p, line, line->key, line->number);
        return DONE_TAKE_EVENTS;
    case ADCGS_SCRIPT_MOVE:
        p->sdl->push(p->window, &(adcgs_event){.kind = ADCGS_EVENT_MOTION, .dx = line->number[0], .dy = line->number[1]});
        return DONE_TAKE_EVENTS;
    case ADCGS_SCRIPT_WHEEL:
        p->sdl->push(p->window, &(adcgs_event){.kind = ADCGS_EVENT_WHEEL, .dy = line->number[0]});
        return DONE_TAKE_EVENTS;
    case ADCGS_SCRIPT_KEY:
        press(p, line);
        return DONE_TAKE_EVENTS;
    case ADCGS_SCRIPT_HOLD:
    case ADCGS_SCRIPT_RELEASE:
        push_key(p, line->key, line->kind == ADCGS_SCRIPT_HOLD);
        return DONE_TAKE_EVENTS;
    case ADCGS_SCRIPT_SIZE:
        p->sdl->resize(p->window, (int)line->number[0], (int)line->number[1]);
        return AGAIN;
    case ADCGS_SCRIPT_RECORD:
        if (!p->recording.sink)
            snprintf(p->recording.path, sizeof p->recording.path, "%s", line->text);
        p->state.record = 1;
        return AGAIN;
    case ADCGS_SCRIPT_QUIT:
        p->state.quit = 1;
        return DONE_TAKE_EVENTS;
    default:
        return AGAIN;
    }
}

/** Checks in each turn whether the line is done. */
static adcgs_status go_on(adcgs_player *p, const adcgs_script_line *line, outcome *how, adcgs_error *error)
{
    const int waits = line->kind == ADCGS_SCRIPT_WAIT_FRAMES || line->kind == ADCGS_SCRIPT_GRAB;
    if (waits && p->failure != ADCGS_OK && !p->drawing) /* there may never be an image */
        return wrong(p, line, p->failure, p->failure_error.text, error);
    switch (line->kind) {
    case ADCGS_SCRIPT_WAIT_FRAMES:
        *how = wait_frames(p, line);
        return ADCGS_OK;
    case ADCGS_SCRIPT_WAIT_SECONDS:
        *how = p->state.now - p->run.since >= line->number[0] ? DONE : AGAIN;
        return ADCGS_OK;
    case ADCGS_SCRIPT_WAIT_BYTES:
    case ADCGS_SCRIPT_WAIT_TIERS:
    case ADCGS_SCRIPT_WAIT_SEGMENTS:
    case ADCGS_SCRIPT_WAIT_END:
        *how = wait_stream(p, line);
        return ADCGS_OK;
    case ADCGS_SCRIPT_SIZE:
        *how = wait_size(p, line, error);
        return ADCGS_OK;
    case ADCGS_SCRIPT_SCREENSHOT:
        *how = *p->shot ? AGAIN : DONE;
        return *p->shot || p->shot_status == ADCGS_OK ? ADCGS_OK : wrong(p, line, p->shot_status, p->shot_error.text, error);
    case ADCGS_SCRIPT_RECORD:
        *how = p->recording.sink ? DONE : AGAIN;
        return p->state.record ? ADCGS_OK : wrong(p, line, p->recording.status, p->recording.error.text, error);
    case ADCGS_SCRIPT_GRAB:
        *how = adcgs_player_settled(p) || p->state.clock.playing || p->state.record || !p->come.drawable ? DONE : AGAIN;
        return *how == DONE ? write_window(p, line->text, error) : ADCGS_OK;
    case ADCGS_SCRIPT_EXPECT:
        *how = DONE;
        return expect(p, line, error);
    default:
        return ADCGS_OK;
    }
}

adcgs_status adcgs_script_go(adcgs_player *p, adcgs_error *error)
{
    adcgs_script_run *const run = &p->run;
    while (run->at < run->script.n && !p->state.quit) {
        const adcgs_script_line *const line = &run->script.lines[run->at];
        outcome how = AGAIN;
        if (!run->begun) {
            if (line->kind == ADCGS_SCRIPT_SCREENSHOT && *p->shot)
                return ADCGS_OK; /* a key's screenshot is still being made */
            run->begun = 1;
            run->since = p->state.now;
            run->pictures = p->pictures;
            if (line->kind == ADCGS_SCRIPT_SCREENSHOT)
                begin_shot(p, line->text);
            how = begin(p, line, error);
        }
        if (how == AGAIN)
            ADCGS_TRY(go_on(p, line, &how, error));
        if (how == AGAIN)
            return ADCGS_OK;
        run->begun = 0;
        run->at++;
        if (how == DONE_TAKE_EVENTS)
            return ADCGS_OK;
    }
    return ADCGS_OK;
}

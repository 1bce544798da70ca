/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Events and the player's state. */
#include "config.h"

#include "play/play_state.h"

#include "play/actions.h"
#include "play/font.h"

#include <math.h>

#define RADIANS_PER_HEIGHT 3.0 /* rotation by a drag over the window's height */
#define SPEED_STEP 1.25
#define SPEED_MIN 0.01 /* scene units per second */
#define SPEED_MAX 100.0
#define SHIFT_SPEED 4.0 /* factor of the speed with shift */
#define STILL_AFTER 0.2 /* seconds without a movement after which the image counts as still */
#define LARGE_WIDTH 512 /* size from which on letters are twice as large */
#define LARGE_HEIGHT 480

void adcgs_play_init(adcgs_play_state *state, const adcgs_info *info, const adcgs_camera *home, const adcgs_camera *stored)
{
    *state = (adcgs_play_state){
        .home = *home,
        .stored = stored,
        .cameras = info->cameras,
        .jumped = -1,
        .layers = info->layers,
        .layers_max = info->layers,
        .width = home->width,
        .height = home->height,
        .density = 1.0,
        .speed = 1.0,
        .bar = 1,
        .moved = -STILL_AFTER,
    };
    adcgs_orbit_control_init(&state->control, info, home);
    adcgs_play_clock_init(&state->clock, info->time_start, info->time_end, info->frame_rate, 0.0);
}

void adcgs_play_resize(adcgs_play_state *state, int width, int height, double density)
{
    state->width = width;
    state->height = height;
    state->density = density;
}

int adcgs_play_moving(const adcgs_play_state *state)
{
    return (state->clock.playing && !adcgs_play_clock_waits(&state->clock)) || state->now - state->moved < STILL_AFTER;
}

int adcgs_play_text_size(const adcgs_play_state *state)
{
    const int density = ADCGS_MAX(1, (int)(state->density + 0.5));
    const int large = state->width >= LARGE_WIDTH * density && state->height >= LARGE_HEIGHT * density;
    return density * (1 + large);
}

adcgs_rect adcgs_play_bar(const adcgs_play_state *state)
{
    const int size = adcgs_play_text_size(state);
    const int height = ADCGS_PLAY_BAR_HEIGHT * size, text = ADCGS_PLAY_BAR_COLUMNS * ADCGS_CELL_WIDTH * size;
    const int shown = state->bar && state->clock.frames > 1 && height < state->height;
    const int width = state->width - (state->width > 3 * text ? text : 0);
    return shown ? (adcgs_rect){0, state->height - height, width, height} : (adcgs_rect){0};
}

/* ---- Keys. ---- */

static void move_by_hand(adcgs_play_state *state)
{
    state->moved = state->now;
    state->jumped = -1;
    *state->control.camera.name = 0; /* it is no longer the stored camera */
}

/* Keys that fly while they are held, with the direction in the camera's axes. */
static const struct {
    char key;
    signed char right, down, forward;
} flights[] = {
    {'w', 0, 0, 1}, {'s', 0, 0, -1}, {'a', -1, 0, 0}, {'d', 1, 0, 0}, {'q', 0, 1, 0}, {'e', 0, -1, 0},
};

/** \return nonzero if the key is a flight key */
static int hold(adcgs_play_state *state, const adcgs_event *event)
{
    for (size_t i = 0; i < ADCGS_COUNTOF(flights) && state->flying; i++)
        if (flights[i].key == event->key) {
            state->held = event->down ? state->held | 1u << i : state->held & ~(1u << i);
            return 1;
        }
    return 0;
}

static void on_key(adcgs_play_state *state, const adcgs_event *event)
{
    if (event->key == ADCGS_KEY_SHIFT)
        state->shift = event->down;
    if (hold(state, event) || !event->down)
        return;
    adcgs_play_act(state, event->key, event->again);
}

/* ---- The mouse. ---- */

static void scrub(adcgs_play_state *state, double x)
{
    const adcgs_rect bar = adcgs_play_bar(state);
    state->moved = state->now;
    adcgs_play_clock_seek(&state->clock, (x - bar.x) / ADCGS_MAX(1, bar.width - 1));
}

static void on_button(adcgs_play_state *state, const adcgs_event *event)
{
    const adcgs_rect bar = adcgs_play_bar(state);
    state->drag = ADCGS_DRAG_NONE;
    if (!event->down || state->flying)
        return;
    if (event->button == 1 && bar.width && event->y >= bar.y) {
        state->drag = ADCGS_DRAG_BAR;
        scrub(state, event->x);
    } else if (event->button == 1 && !state->shift)
        state->drag = ADCGS_DRAG_ORBIT;
    else
        state->drag = ADCGS_DRAG_PAN;
}

static void on_motion(adcgs_play_state *state, const adcgs_event *event)
{
    const double turn = -RADIANS_PER_HEIGHT / state->height;
    adcgs_camera view;
    if (state->drag == ADCGS_DRAG_BAR)
        scrub(state, event->x);
    if (state->drag == ADCGS_DRAG_BAR || (!state->flying && state->drag == ADCGS_DRAG_NONE))
        return;
    move_by_hand(state);
    if (state->flying)
        adcgs_orbit_control_look(&state->control, turn * event->dx, turn * event->dy);
    else if (state->drag == ADCGS_DRAG_ORBIT)
        adcgs_orbit_control_orbit(&state->control, turn * event->dx, turn * event->dy);
    else {
        adcgs_orbit_control_view(&state->control, state->width, state->height, &view);
        adcgs_orbit_control_pan(&state->control, event->dx / view.fx, event->dy / view.fy);
    }
}

static void on_wheel(adcgs_play_state *state, const adcgs_event *event)
{
    if (state->flying) {
        state->speed = ADCGS_MAX(SPEED_MIN, ADCGS_MIN(state->speed * pow(SPEED_STEP, event->dy), SPEED_MAX));
        adcgs_play_say(state, "flying speed %.2f per second", state->speed);
        return;
    }
    move_by_hand(state);
    adcgs_orbit_control_zoom(&state->control, event->dy);
}

void adcgs_play_event(adcgs_play_state *state, const adcgs_event *event)
{
    switch (event->kind) {
    case ADCGS_EVENT_QUIT:
        state->quit = 1;
        break;
    case ADCGS_EVENT_KEY:
        on_key(state, event);
        break;
    case ADCGS_EVENT_BUTTON:
        on_button(state, event);
        break;
    case ADCGS_EVENT_MOTION:
        on_motion(state, event);
        break;
    case ADCGS_EVENT_WHEEL:
        on_wheel(state, event);
        break;
    case ADCGS_EVENT_LOST:
        state->held = 0;
        state->shift = 0;
        state->drag = ADCGS_DRAG_NONE;
        break;
    case ADCGS_EVENT_SIZE:
    case ADCGS_EVENT_NONE:
        break;
    }
}

void adcgs_play_tick(adcgs_play_state *state, double now)
{
    const double way = (now - state->now) * state->speed * (state->shift ? SHIFT_SPEED : 1.0);
    double by[3] = {0.0, 0.0, 0.0};
    state->now = now;
    adcgs_play_clock_tick(&state->clock, now);
    for (size_t i = 0; i < ADCGS_COUNTOF(flights); i++)
        if (state->held >> i & 1) {
            by[0] += way * flights[i].right;
            by[1] += way * flights[i].down;
            by[2] += way * flights[i].forward;
        }
    if (state->held) {
        move_by_hand(state);
        adcgs_orbit_control_fly(&state->control, by[0], by[1], by[2]);
    }
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Events and the player's state. */
#include "config.h"

#include "play/play_state.h"

#include "play/actions.h"
#include "play/controls.h"

#include <math.h>

#define RADIANS_PER_HEIGHT 3.0 /* rotation by a drag over the window's height */
#define SPEED_STEP 1.25
#define SPEED_MIN 0.01 /* scene units per second */
#define SPEED_MAX 100.0
#define SHIFT_SPEED 4.0 /* factor of the speed with shift */
#define STILL_AFTER 0.2 /* seconds without a movement after which the image counts as still */
#define HINT_SECONDS 8.0

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
        .pointer = {-1.0, -1.0},
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

adcgs_play_control adcgs_play_pointed(const adcgs_play_state *state)
{
    adcgs_controls controls;
    adcgs_controls_place(&controls, state);
    return state->flying ? ADCGS_CONTROL_NONE : adcgs_controls_at(&controls, state->pointer[0], state->pointer[1]);
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
    if (event->down)
        state->hint_end = state->now;
    if (hold(state, event) || !event->down)
        return;
    adcgs_play_act(state, event->key, event->again);
}

/* ---- The mouse. ---- */

static void point(adcgs_play_state *state, const adcgs_event *event)
{
    state->pointer[0] = event->x;
    state->pointer[1] = event->y;
    state->pointed = state->now;
}

static void scrub(adcgs_play_state *state, double x)
{
    adcgs_controls controls;
    adcgs_controls_place(&controls, state);
    state->moved = state->now;
    adcgs_play_clock_seek(&state->clock, adcgs_controls_part(&controls, x));
}

/** Presses a control. It acts if the button is released on it. */
static void press(adcgs_play_state *state, adcgs_play_control control, double x)
{
    state->pressed = control;
    if (control == ADCGS_CONTROL_SLIDER) {
        state->drag = ADCGS_DRAG_BAR;
        scrub(state, x);
    }
}

static void release(adcgs_play_state *state)
{
    const adcgs_play_control control = state->pressed;
    state->pressed = ADCGS_CONTROL_NONE;
    if (control != ADCGS_CONTROL_NONE && control == adcgs_play_pointed(state))
        adcgs_play_act(state, adcgs_controls_key(control), 0);
}

/** Controls that rest are not pressed: the user does not see them. */
static void on_button(adcgs_play_state *state, const adcgs_event *event)
{
    state->drag = ADCGS_DRAG_NONE;
    if (state->flying)
        return;
    state->pointer[0] = event->x;
    state->pointer[1] = event->y;
    const adcgs_play_control control = adcgs_play_pointed(state);
    state->pointed = state->now;
    if (!event->down)
        release(state);
    else if (state->help)
        state->help = 0; /* a press closes it, and has no other effect */
    else if (event->button == 1 && control != ADCGS_CONTROL_NONE)
        press(state, control, event->x);
    else if (event->button == 1 && !state->shift) {
        state->drag = ADCGS_DRAG_ORBIT;
        if (event->clicks == 2) {
            state->pivot = 1;
            state->pivot_at[0] = event->x;
            state->pivot_at[1] = event->y;
        }
    } else
        state->drag = ADCGS_DRAG_PAN;
}

static void on_motion(adcgs_play_state *state, const adcgs_event *event)
{
    const double turn = -RADIANS_PER_HEIGHT / state->height;
    adcgs_camera view;
    if (!state->flying)
        point(state, event);
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
        state->pressed = ADCGS_CONTROL_NONE;
        break;
    case ADCGS_EVENT_LEAVE:
        state->pointer[0] = state->pointer[1] = -1.0;
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
    if (!state->ticks) {
        state->ticks = 1;
        state->pointed = now;
        state->hint_end = now + HINT_SECONDS;
    }
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

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Events and the player's state. */
#include "config.h"

#include "play/play_state.h"

#include "play/actions.h"
#include "play/by_hand.h"
#include "play/controls.h"

#include <math.h>

/* Origin: chosen by hand, not measured. */
#define RADIANS_PER_HEIGHT 3.0 /* rotation by a drag over the window's height */
#define SPEED_STEP 1.25        /* factor of the speed per step of the wheel */
#define SPEED_MIN 0.01         /* scene units per second */
#define SPEED_MAX 100.0        /* scene units per second */
#define SHIFT_SPEED 4.0        /* factor of the speed with shift */
#define DOUBLE_SECONDS 0.4     /* between the two clicks of a double click, at most: the usual limit of desktops */
#define DOUBLE_PIXELS 16.0     /* between them, pixels of a desktop of usual density: fingers are not steadier */
#define POSE_WITHIN 1e-6       /* of elements of poses: paths are stored in binary32 */
#define STILL_AFTER 0.2        /* seconds without a movement after which the image counts as still */
#define HINT_SECONDS 8.0       /* for which hints are shown */

/** Equal except for rounding. */
static int same_pose(const double a[12], const double b[12])
{
    for (int i = 0; i < 12; i++)
        if (!(fabs(a[i] - b[i]) <= POSE_WITHIN * (1 + fabs(b[i]))))
            return 0;
    return 1;
}

void adcgs_play_init(adcgs_play_state *state, const adcgs_info *info, const adcgs_camera *home, const adcgs_filmed_camera *stored,
                     adcgs_filmed_view *filmed)
{
    *state = (adcgs_play_state){
        .home = *home,
        .stored = stored,
        .filmed = filmed,
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
        .click = {.time = -DOUBLE_SECONDS},
    };
    adcgs_orbit_control_init(&state->control, info, home);
    adcgs_play_clock_init(&state->clock, info->time_start, info->time_end, info->frame_rate, 0.0);
    if (filmed && adcgs_filmed_view_has_path(filmed)) {
        adcgs_filmed_view_start(filmed, &state->control, info->time_start);
        state->follows_home = same_pose(state->control.camera.cam_to_world, home->cam_to_world);
        if (!state->follows_home) {
            filmed->following = 0;
            adcgs_orbit_control_jump(&state->control, home);
        }
    }
    adcgs_play_placed(state);
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

/** True for a double click: the window counts clicks, or else it is the second one at its place within a short time. */
static int is_double(adcgs_play_state *state, const adcgs_event *event)
{
    if (event->clicks)
        return event->clicks == 2;
    const double near = DOUBLE_PIXELS * state->density;
    const int second = state->now - state->click.time <= DOUBLE_SECONDS && fabs(event->x - state->click.x) <= near &&
                       fabs(event->y - state->click.y) <= near;
    state->click.time = second ? -DOUBLE_SECONDS : state->now;
    state->click.x = event->x;
    state->click.y = event->y;
    return second;
}

/** The centre of an orbit is in the middle of the image, until the user sets another one. */
static void begin_orbit(adcgs_play_state *state)
{
    state->drag = ADCGS_DRAG_ORBIT;
    if (!state->pivot_chosen && state->filmed && state->filmed->following && !state->filmed->beside)
        adcgs_play_request_pivot(state, 0.5, 0.5);
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
    else if (event->button == 1 && !state->shift && is_double(state, event)) {
        state->pivot_chosen = 1;
        adcgs_play_request_pivot(state, event->x / state->width, event->y / state->height);
    } else if (event->button == 1 && !state->shift)
        begin_orbit(state);
    else
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
    state->click.time = -DOUBLE_SECONDS; /* a drag is no click */
    if (state->flying)
        adcgs_play_move(state, adcgs_hand_look, turn * event->dx, turn * event->dy, 0);
    else if (state->drag == ADCGS_DRAG_ORBIT)
        adcgs_play_move(state, adcgs_hand_orbit, turn * event->dx, turn * event->dy, 0);
    else {
        adcgs_orbit_control_view(&state->control, state->width, state->height, &view);
        adcgs_play_move(state, adcgs_hand_pan, event->dx / view.fx, event->dy / view.fy, 0);
    }
}

static void on_wheel(adcgs_play_state *state, const adcgs_event *event)
{
    if (state->flying) {
        state->speed = ADCGS_MAX(SPEED_MIN, ADCGS_MIN(state->speed * pow(SPEED_STEP, event->dy), SPEED_MAX));
        adcgs_play_say(state, "flying speed %.2f per second", state->speed);
        return;
    }
    adcgs_play_move(state, adcgs_hand_zoom, event->dy, 0, 0);
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
    const int alone = state->clock.playing && state->drag == ADCGS_DRAG_NONE && !state->held;
    const double seconds = alone ? now - state->now : 0.0;
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
    if (state->filmed)
        adcgs_filmed_view_tick(state->filmed, &state->control, &state->clock, seconds);
    if (state->held)
        adcgs_play_move(state, adcgs_hand_fly, by[0], by[1], by[2]);
}

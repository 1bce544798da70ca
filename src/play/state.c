/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Events and the player's state. */
#include "config.h"

#include "play/state.h"

#include "play/font.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

#define RADIANS_PER_HEIGHT 3.0 /* that a drag over the window's height turns */
#define SPEED_STEP 1.25
#define SPEED_MIN 0.01         /* scene units in a second */
#define SPEED_MAX 100.0
#define SHIFT_SPEED 4.0        /* times as fast with shift */
#define STILL_AFTER 0.2        /* seconds without a move after which the picture counts as still */
#define MESSAGE_SECONDS 3.0
#define LARGE_WIDTH 512        /* from this size on letters are twice as large */
#define LARGE_HEIGHT 420

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

void adcgs_play_say(adcgs_play_state *state, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(state->message, sizeof state->message, format, arguments);
    va_end(arguments);
    state->message_end = state->now + MESSAGE_SECONDS;
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

/* ---- Keys. The table is the help page too. ---- */

static void place_camera(adcgs_play_state *state, int index, const adcgs_camera *camera)
{
    state->jumped = index;
    state->flying = 0;
    adcgs_orbit_control_jump(&state->control, camera);
}

static void move_by_hand(adcgs_play_state *state)
{
    state->moved = state->now;
    state->jumped = -1;
    *state->control.camera.name = 0; /* it is no longer that one */
}

static void do_play(adcgs_play_state *state, int unused)
{
    adcgs_play_clock_toggle(&state->clock);
}

static void do_step(adcgs_play_state *state, int frames)
{
    adcgs_play_clock_step(&state->clock, frames);
}

static void do_seek(adcgs_play_state *state, int end)
{
    adcgs_play_clock_seek(&state->clock, end);
}

static void do_speed(adcgs_play_state *state, int steps)
{
    adcgs_play_clock_faster(&state->clock, steps);
    adcgs_play_say(state, "speed %gx", adcgs_play_clock_factor(&state->clock));
}

static void do_loop(adcgs_play_state *state, int unused)
{
    state->clock.loop = !state->clock.loop;
    adcgs_play_say(state, state->clock.loop ? "loop" : "no loop");
}

static void do_layers(adcgs_play_state *state, int more)
{
    state->layers = ADCGS_MAX(1, ADCGS_MIN(state->layers + more, state->layers_max));
    adcgs_play_say(state, "%d of %d layers", state->layers, state->layers_max);
}

static void do_camera(adcgs_play_state *state, int index)
{
    if (index >= state->cameras) {
        adcgs_play_say(state, "the stream stores %d camera%s", state->cameras, state->cameras == 1 ? "" : "s");
        return;
    }
    place_camera(state, index, &state->stored[index]);
    adcgs_play_say(state, "camera %d %s", index, state->stored[index].name);
}

static void do_next(adcgs_play_state *state, int step)
{
    const int from = state->jumped >= 0 ? state->jumped : step > 0 ? -1 : 0;
    do_camera(state, state->cameras ? (from + step + state->cameras) % state->cameras : 0);
}

static void do_reset(adcgs_play_state *state, int unused)
{
    place_camera(state, -1, &state->home);
}

static void do_fly(adcgs_play_state *state, int unused)
{
    state->flying = !state->flying;
    state->held = 0;
    state->drag = ADCGS_DRAG_NONE;
    if (!state->flying)
        adcgs_orbit_control_land(&state->control);
    adcgs_play_say(state, state->flying ? "fly: w a s d q e and the mouse; f to stop" : "orbit");
}

static void do_shot(adcgs_play_state *state, int unused)
{
    state->shot = state->shift ? ADCGS_SHOT_EXR : ADCGS_SHOT_PNG;
}

static void do_statistics(adcgs_play_state *state, int unused)
{
    state->statistics = !state->statistics;
}

static void do_bar(adcgs_play_state *state, int unused)
{
    state->bar = !state->bar;
}

static void do_help(adcgs_play_state *state, int unused)
{
    state->help = !state->help;
}

static void do_escape(adcgs_play_state *state, int unused)
{
    if (state->help)
        state->help = 0;
    else if (state->flying)
        do_fly(state, 0);
    else
        state->quit = 1;
}

static const struct action {
    int key, repeats;
    void (*act)(adcgs_play_state *state, int value);
    int value;
} actions[] = {
    {' ', 0, do_play, 0},
    {ADCGS_KEY_LEFT, 1, do_step, -1},
    {ADCGS_KEY_RIGHT, 1, do_step, 1},
    {ADCGS_KEY_HOME, 0, do_seek, 0},
    {ADCGS_KEY_END, 0, do_seek, 1},
    {',', 0, do_speed, -1},
    {'.', 0, do_speed, 1},
    {'l', 0, do_loop, 0},
    {'-', 0, do_layers, -1},
    {'+', 0, do_layers, 1},
    {'=', 0, do_layers, 1}, /* + without shift on many keyboards */
    {'[', 1, do_next, -1},
    {']', 1, do_next, 1},
    {ADCGS_KEY_PAGE_UP, 1, do_next, -1},
    {ADCGS_KEY_PAGE_DOWN, 1, do_next, 1},
    {'r', 0, do_reset, 0},
    {'f', 0, do_fly, 0},
    {'p', 0, do_shot, 0},
    {'i', 0, do_statistics, 0},
    {'b', 0, do_bar, 0},
    {'h', 0, do_help, 0},
    {ADCGS_KEY_F1, 0, do_help, 0},
    {ADCGS_KEY_ESCAPE, 0, do_escape, 0},
};

static const adcgs_play_help help_lines[] = {
    {"left drag", "orbit about the scene"},
    {"right drag", "pan; also shift and drag"},
    {"wheel", "nearer and farther"},
    {"f", "fly: w a s d q e, mouse looks"},
    {"r", "back to the first view"},
    {"0 .. 9", "a stored camera"},
    {"[ ]", "stored cameras in turn"},
    {"space", "play, pause"},
    {"left right", "a frame back, a frame on"},
    {"home end", "first frame, last frame"},
    {", .", "slower, faster"},
    {"l", "loop"},
    {"- +", "fewer layers, more layers"},
    {"p", "screenshot; with shift EXR"},
    {"i", "statistics"},
    {"b", "time bar"},
    {"h F1", "this page"},
    {"escape", "leave"},
};

const adcgs_play_help *adcgs_play_help_lines(int *n)
{
    *n = (int)ADCGS_COUNTOF(help_lines);
    return help_lines;
}

/* Keys that fly while they are held: where to, in the camera's axes. */
static const struct { char key; signed char right, down, forward; } flights[] = {
    {'w', 0, 0, 1}, {'s', 0, 0, -1}, {'a', -1, 0, 0}, {'d', 1, 0, 0}, {'q', 0, 1, 0}, {'e', 0, -1, 0},
};

/** \return whether the key is one of those that fly. */
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
    if (event->key >= '0' && event->key <= '9' && !event->again)
        do_camera(state, event->key - '0');
    for (size_t i = 0; i < ADCGS_COUNTOF(actions); i++)
        if (actions[i].key == event->key && (!event->again || actions[i].repeats))
            actions[i].act(state, actions[i].value);
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
        adcgs_play_say(state, "flying %.2f a second", state->speed);
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

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The effects of keys: a table, and the help page that describes it. */
#include "config.h"

#include "play/actions.h"

#include "play/by_hand.h"
#include "system/text.h"

#include <stdarg.h>
#include <stdio.h>

#define MESSAGE_SECONDS 3.0 /* for which a message is shown; chosen by hand, not measured */

void adcgs_play_say(adcgs_play_state *state, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(state->message, sizeof state->message, format, arguments);
    va_end(arguments);
    state->message_end = state->now + MESSAGE_SECONDS;
}

static void place_camera(adcgs_play_state *state, int index, const adcgs_camera *camera)
{
    state->jumped = index;
    state->flying = 0;
    if (state->filmed)
        state->filmed->following = 0;
    adcgs_orbit_control_jump(&state->control, camera);
    adcgs_play_placed(state);
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
    adcgs_play_say(state, "%d of %d layer%s", state->layers, state->layers_max, adcgs_s((uint64_t)state->layers_max));
}

static void do_camera(adcgs_play_state *state, int index)
{
    if (index >= state->cameras) {
        adcgs_play_say(state, "the stream stores %d camera%s", state->cameras, state->cameras == 1 ? "" : "s");
        return;
    }
    place_camera(state, index, &state->stored[index].camera);
    adcgs_play_say(state, "camera %d %s", index, state->stored[index].camera.name);
}

static void do_next(adcgs_play_state *state, int step)
{
    const int from = state->jumped >= 0 ? state->jumped : step > 0 ? -1 : 0;
    do_camera(state, state->cameras ? (from + step + state->cameras) % state->cameras : 0);
}

static void follow(adcgs_play_state *state)
{
    state->jumped = -1;
    state->flying = 0;
    adcgs_filmed_view_start(state->filmed, &state->control, adcgs_play_clock_time(&state->clock));
    adcgs_play_placed(state);
}

static void do_follow(adcgs_play_state *state, int unused)
{
    if (!state->filmed || !adcgs_filmed_view_has_path(state->filmed)) {
        adcgs_play_say(state, "the stream stores no filmed path");
        return;
    }
    if (state->filmed->following && !state->filmed->beside) {
        state->filmed->following = 0;
        adcgs_play_say(state, "the view stays here");
        return;
    }
    follow(state);
    adcgs_play_say(state, "the view follows the filmed path");
}

static void do_limit(adcgs_play_state *state, int unused)
{
    if (!state->filmed)
        return;
    state->filmed->unlimited = !state->filmed->unlimited;
    adcgs_play_say(state, state->filmed->unlimited ? "no limit: leave the filmed region" : "the view stays where it was filmed");
}

static void do_reset(adcgs_play_state *state, int unused)
{
    if (state->follows_home)
        follow(state);
    else
        place_camera(state, -1, &state->home);
}

static void do_fly(adcgs_play_state *state, int unused)
{
    state->flying = !state->flying;
    if (state->flying && state->filmed)
        state->filmed->following = 0;
    state->held = 0;
    state->drag = ADCGS_DRAG_NONE;
    if (!state->flying)
        adcgs_orbit_control_land(&state->control);
    adcgs_play_say(state, state->flying ? "fly: w a s d q e and the mouse; f to stop" : "orbit");
}

static void do_shot(adcgs_play_state *state, int unused)
{
    state->shot = state->shift ? ADCGS_SOURCE_IMAGE_EXR : ADCGS_SOURCE_IMAGE_PNG;
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
    else if (state->full)
        state->full = 0;
    else
        state->quit = 1;
}

static void do_quit(adcgs_play_state *state, int unused)
{
    state->quit = 1;
}

static void do_full(adcgs_play_state *state, int unused)
{
    state->full = !state->full;
}

static void do_key_frame(adcgs_play_state *state, int unused)
{
    state->key_frame = state->shift ? -1 : 1;
}

static void do_record(adcgs_play_state *state, int unused)
{
    state->record = !state->record;
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
    {'c', 0, do_follow, 0},
    {'x', 0, do_limit, 0},
    {'f', 0, do_fly, 0},
    {'p', 0, do_shot, 0},
    {'i', 0, do_statistics, 0},
    {'b', 0, do_bar, 0},
    {'h', 0, do_help, 0},
    {ADCGS_KEY_F1, 0, do_help, 0},
    {'k', 0, do_key_frame, 0},
    {'v', 0, do_record, 0},
    {ADCGS_KEY_F11, 0, do_full, 0},
    {'q', 0, do_quit, 0},
    {ADCGS_KEY_ESCAPE, 0, do_escape, 0},
};

static const adcgs_play_help help_lines[] = {
    {"left drag", "orbit around the scene", 0},
    {"2 clicks", "orbit around this", 0},
    {"right drag", "pan; also shift and drag", 0},
    {"wheel", "zoom", 0},
    {"click", "buttons; drag the time bar", 1},
    {"f", "fly: w a s d q e, mouse looks", 0},
    {"r", "first view", 0},
    {"c", "follow the film, stay", 0},
    {"x", "limit on, off", 0},
    {"0 .. 9 [ ]", "stored cameras", 0},
    {"space", "play, pause", 0},
    {"left right", "previous or next frame", 0},
    {"home end", "first frame, last frame", 0},
    {", . l", "slower, faster, loop", 0},
    {"- +", "fewer layers, more layers", 0},
    {"p", "screenshot; with shift EXR", 0},
    {"k", "key frame; shift: undo it", 1},
    {"v", "video: begin, end", 1},
    {"i b", "statistics, time bar", 0},
    {"F11", "full screen", 1},
    {"h F1", "this page", 0},
    {"escape q", "quit", 1},
};

const adcgs_play_help *adcgs_play_help_lines(int *n)
{
    *n = (int)ADCGS_COUNTOF(help_lines);
    return help_lines;
}

void adcgs_play_act(adcgs_play_state *state, int key, int again)
{
    if (key >= '0' && key <= '9' && !again)
        do_camera(state, key - '0');
    for (size_t i = 0; i < ADCGS_COUNTOF(actions); i++)
        if (actions[i].key == key && (!again || actions[i].repeats))
            actions[i].act(state, actions[i].value);
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The page's camera, clock and keys: the player's state, changed by events. One per instance. */
#include "config.h"

#include "geometry/rotation.h"
#include "play/actions.h"
#include "play/by_hand.h"
#include "play/scale.h"
#include "wasm/export.h"

#include <adcgs/view.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define HAND_SECONDS (1.0 / 30.0) /* seconds, maximum for an image while the camera is moved by hand */
#define BUDGET_MAX (1.0 / 8.0)    /* seconds, maximum while playing: at least 8 images/s; browsers are slower than the player */

static struct {
    adcgs_play_state state;
    double origin[3], unit; /* of the scene */
    adcgs_play_scale scale;
    adcgs_camera view;
    adcgs_filmed_camera *cameras;
    adcgs_filmed_view filmed;
    int pivots; /* number of the last request that was given away */
} page;

/** Set the time range to play, and its available part, from the current knowledge of the stream. */
void PAGE_EXPORT(view_span)(const adcgs_info *info, int over)
{
    adcgs_play_clock *const clock = &page.state.clock;
    adcgs_play_clock_span(clock, info->time_start,
                          isfinite(info->time_end) ? info->time_end : fmax(info->time_available, info->time_start));
    clock->available = over ? INFINITY : info->time_available - clock->begin;
    if (info->tiers != page.scale.all)
        adcgs_play_scale_init(&page.scale, info->tiers);
}

/** Open a scene with its first view and n stored cameras. \return 0, or less if there is no memory. */
int PAGE_EXPORT(view_open)(const adcgs_info *info, const adcgs_camera *home, const adcgs_filmed_camera *cameras, int over)
{
    const int statistics = page.state.statistics;
    free(page.cameras);
    page.cameras = calloc((size_t)info->cameras + 1, sizeof *page.cameras);
    if (!page.cameras)
        return -1;
    memcpy(page.cameras, cameras, (size_t)info->cameras * sizeof *cameras);
    adcgs_filmed_view_clear(&page.filmed);
    if (adcgs_filmed_view_init(&page.filmed, info, page.cameras, home, NULL) != ADCGS_OK)
        return -1;
    adcgs_play_init(&page.state, info, home, page.cameras, &page.filmed);
    page.pivots = 0;
    page.state.statistics = statistics;
    adcgs_play_scale_init(&page.scale, info->tiers);
    memcpy(page.origin, info->scene_origin, sizeof page.origin);
    page.unit = info->scene_scale;
    view_span(info, over);
    return 0;
}

void PAGE_EXPORT(view_resize)(int width, int height, double density)
{
    adcgs_play_resize(&page.state, width, height, density);
}

/** kind and key as in window.h. The page's time bar and help are not part of the image. */
void PAGE_EXPORT(view_event)(int kind, int key, int down, int again, int button, double x, double y, double dx, double dy)
{
    const adcgs_event event = {.kind = (adcgs_event_kind)kind,
                               .key = key,
                               .down = down,
                               .again = again,
                               .button = button,
                               .x = x,
                               .y = y,
                               .dx = dx,
                               .dy = dy};
    const int bar = page.state.bar, help = page.state.help;
    if (event.kind == ADCGS_EVENT_KEY) {
        adcgs_play_event(&page.state, &event);
        return;
    }
    page.state.bar = page.state.help = 0;
    adcgs_play_event(&page.state, &event);
    page.state.bar = bar;
    page.state.help = help;
}

/** Fingers have no buttons: they pan, in pixels, and zoom, in steps of the wheel. */
void PAGE_EXPORT(view_pinch)(double dx, double dy, double steps)
{
    adcgs_play_pinch(&page.state, dx, dy, steps);
}

void PAGE_EXPORT(view_tick)(double now)
{
    adcgs_play_tick(&page.state, now);
}

/** part: fraction of the duration, 0 to 1. */
void PAGE_EXPORT(view_seek)(double part)
{
    adcgs_play_clock_seek(&page.state.clock, part);
    page.state.moved = page.state.now;
}

/** Starts as the page is asked to: at a time in seconds, in a loop or once, playing or not. */
void PAGE_EXPORT(view_start)(double time, int loop, int playing)
{
    adcgs_play_clock *const clock = &page.state.clock;
    adcgs_play_clock_seek(clock, (time - clock->begin) * clock->rate / fmax(1, clock->frames - 1));
    clock->loop = loop;
    if (playing != clock->playing)
        adcgs_play_clock_toggle(clock);
}

/** Look through another camera. */
void PAGE_EXPORT(view_place)(const adcgs_camera *camera)
{
    page.state.flying = 0;
    page.state.jumped = -1;
    page.state.moved = page.state.now;
    page.filmed.following = 0;
    adcgs_orbit_control_jump(&page.state.control, camera);
    adcgs_play_placed(&page.state);
}

/** Gives away a new request for a pivot once. \return its number, or 0 if there is none */
int PAGE_EXPORT(view_pivot_wanted)(void)
{
    if (page.pivots == page.state.pivots)
        return 0;
    return page.pivots = page.state.pivots;
}
/** The requested place, 0 to 1 over width (axis 0) and height (axis 1). */
double PAGE_EXPORT(view_pivot_at)(int axis)
{
    return page.state.pivot_at[axis != 0];
}
/** Answers the request with this number. */
void PAGE_EXPORT(view_pivot)(int number, double x, double y, double z)
{
    const double point[3] = {x, y, z};
    adcgs_play_pivot(&page.state, number, point);
}
/** How far the view is outside of the filmed region, 0 to 1. */
double PAGE_EXPORT(view_outside)(void)
{
    return adcgs_play_outside(&page.state);
}
int PAGE_EXPORT(view_following)(void)
{
    return page.filmed.following ? 1 + page.filmed.beside : 0; /* 2: moved away from the path */
}
/** The share of the image's width (axis 0) or height (axis 1) at each of two sides that is next to the filmed view. */
double PAGE_EXPORT(view_inset)(int axis)
{
    return adcgs_orbit_control_inset(&page.state.control, page.state.width, page.state.height, axis != 0);
}

/** The camera for the image; a divider reduces its size. */
const adcgs_camera *PAGE_EXPORT(view_camera)(int divider)
{
    const int width = page.state.width, height = page.state.height;
    adcgs_orbit_control_view(&page.state.control, width, height, &page.view);
    if (divider > 1)
        adcgs_camera_stretch(&page.view, (width + divider - 1) / divider, (height + divider - 1) / divider);
    return &page.view;
}

/**
 * The same camera for a shader: rotation and translation from the scene's units, fx, fy, cx, cy, near plane, and four limits, 21
 * numbers in total; NULL if it cannot be rendered.
 */
const float *PAGE_EXPORT(view_uniforms)(int divider)
{
    static adcgs_view view;
    _Static_assert(sizeof view == 2 * sizeof(int32_t) + 21 * sizeof(float), "the shader's numbers lie in a row");
    return adcgs_view_init(&view, view_camera(divider), page.origin, page.unit, NULL) == ADCGS_OK ? view.rotation : NULL;
}

/** Report the time that an image took: the next ones may be coarser. */
void PAGE_EXPORT(view_took)(double seconds)
{
    const adcgs_play_clock *const clock = &page.state.clock;
    const double each = clock->playing ? 1.0 / (clock->rate * adcgs_play_clock_factor(clock)) : HAND_SECONDS;
    adcgs_play_scale_took(&page.scale, seconds, fmax(HAND_SECONDS, fmin(each, BUDGET_MAX)));
}

/* ---- Queries. ---- */

int PAGE_EXPORT(view_divider)(void)
{
    return page.scale.divider;
}
int PAGE_EXPORT(view_tiers)(void)
{
    return page.scale.tiers;
}
int PAGE_EXPORT(view_moving)(void)
{
    return adcgs_play_moving(&page.state) || page.state.held != 0;
}
int PAGE_EXPORT(view_playing)(void)
{
    return page.state.clock.playing;
}
int PAGE_EXPORT(view_waits)(void)
{
    return adcgs_play_clock_waits(&page.state.clock);
}
int PAGE_EXPORT(view_loop)(void)
{
    return page.state.clock.loop;
}
int PAGE_EXPORT(view_frame)(void)
{
    return adcgs_play_clock_frame(&page.state.clock);
}
int PAGE_EXPORT(view_frames)(void)
{
    return page.state.clock.frames;
}
double PAGE_EXPORT(view_time)(void)
{
    return adcgs_play_clock_time(&page.state.clock);
}
double PAGE_EXPORT(view_factor)(void)
{
    return adcgs_play_clock_factor(&page.state.clock);
}
int PAGE_EXPORT(view_layers)(void)
{
    return page.state.layers;
}
int PAGE_EXPORT(view_flying)(void)
{
    return page.state.flying;
}
int PAGE_EXPORT(view_statistics)(void)
{
    return page.state.statistics;
}
int PAGE_EXPORT(view_bar)(void)
{
    return page.state.bar;
}
int PAGE_EXPORT(view_help)(void)
{
    return page.state.help;
}

/** Whether a screenshot was requested; resets the request. */
int PAGE_EXPORT(view_shot)(void)
{
    const int shot = page.state.shot != ADCGS_SOURCE_IMAGE_NONE;
    page.state.shot = ADCGS_SOURCE_IMAGE_NONE;
    return shot;
}

/** Empty if there is none. */
const char *PAGE_EXPORT(view_message)(void)
{
    return page.state.now < page.state.message_end ? page.state.message : "";
}

/** Lines of the help page: keys and text, separated by a tab; each line ends with a line feed. */
const char *PAGE_EXPORT(view_help_lines)(void)
{
    static char text[2000];
    size_t used = 0;
    int n;
    const adcgs_play_help *const lines = adcgs_play_help_lines(&n);
    for (int i = 0; i < n && used < sizeof text; i++)
        if (!lines[i].window)
            used += (size_t)snprintf(text + used, sizeof text - used, "%s\t%s\n", lines[i].keys, lines[i].text);
    return text;
}

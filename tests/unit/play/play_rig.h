/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A stream's facts and cameras for the tests of the player. */
#ifndef ADCGS_TESTS_PLAY_RIG_H
#define ADCGS_TESTS_PLAY_RIG_H

#include "outside_files.h"

#include "camera/orbit_control.h"
#include "geometry/vector.h"
#include "play/play_state.h"

#include <math.h>

/** A stream of 10 frames from second 2 on. Its scene has a scale of 3 units about (1, 2, 3). */
static inline adcgs_info make_info(const char *axes)
{
    adcgs_info info = {.time_start = 2.0,
                       .time_end = 2.9,
                       .frame_rate = 10.0,
                       .scene_origin = {1.0, 2.0, 3.0},
                       .scene_scale = 3.0,
                       .layers = 5,
                       .cameras = 2};
    snprintf(info.axes, sizeof info.axes, "%s", axes);
    return info;
}

/** A camera at a distance of 6 from the centre, looking at it along +y, z up. */
static inline adcgs_camera make_camera(void)
{
    return (adcgs_camera){.width = 640,
                          .height = 480,
                          .fx = 500.0,
                          .fy = 510.0,
                          .cx = 300.0,
                          .cy = 250.0,
                          .near_plane = 0.03,
                          .cam_to_world = {1, 0, 0, 1.0, 0, 0, 1, -4.0, 0, -1, 0, 3.0},
                          .name = "first"};
}

static inline void column(const adcgs_orbit_control *control, int c, double v[3])
{
    for (int i = 0; i < 3; i++)
        v[i] = control->camera.cam_to_world[4 * i + c];
}

/** Cosine of the angle between the view and the direction to a point. */
static inline double looks_at(const adcgs_orbit_control *control, const double point[3])
{
    double forward[3], to[3];
    column(control, 2, forward);
    column(control, 3, to);
    for (int i = 0; i < 3; i++)
        to[i] = point[i] - to[i];
    return adcgs_v3_dot(forward, to) / sqrt(adcgs_v3_dot(to, to));
}

/** A player in a window of 640x480, at second 50 of the wall clock. */
#define TWO_CAMERAS                             \
    {                                           \
        {.camera = make_camera(), .path = -1},  \
        {                                       \
            .camera = make_camera(), .path = -1 \
        }                                       \
    }

static inline adcgs_play_state make_state(const adcgs_filmed_camera cameras[2])
{
    const adcgs_info info = make_info("right-handed, z up");
    const adcgs_camera home = make_camera();
    adcgs_play_state play;
    adcgs_play_init(&play, &info, &home, cameras, NULL);
    adcgs_play_resize(&play, 640, 480, 1.0);
    adcgs_play_tick(&play, 50.0);
    return play;
}

static inline void key(adcgs_play_state *play, int code)
{
    adcgs_play_event(play, &(adcgs_event){.kind = ADCGS_EVENT_KEY, .key = code, .down = 1});
    adcgs_play_event(play, &(adcgs_event){.kind = ADCGS_EVENT_KEY, .key = code});
}

static inline void button(adcgs_play_state *play, int which, int down, double x, double y)
{
    adcgs_play_event(play, &(adcgs_event){.kind = ADCGS_EVENT_BUTTON, .button = which, .down = down, .x = x, .y = y});
}

static inline void motion(adcgs_play_state *play, double x, double y, double dx, double dy)
{
    adcgs_play_event(play, &(adcgs_event){.kind = ADCGS_EVENT_MOTION, .x = x, .y = y, .dx = dx, .dy = dy});
}

#endif

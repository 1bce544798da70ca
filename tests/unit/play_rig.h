/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A stream's facts and cameras for the tests of the player. */
#ifndef ADCGS_TESTS_PLAY_RIG_H
#define ADCGS_TESTS_PLAY_RIG_H

#include "outside_files.h"

#include "camera/orbit_control.h"
#include "camera/vector.h"
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

#endif

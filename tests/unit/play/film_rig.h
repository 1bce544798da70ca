/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Cameras on a circle, as those of a film. */
#ifndef ADCGS_TESTS_FILM_RIG_H
#define ADCGS_TESTS_FILM_RIG_H

#include "play_rig.h"

#include "geometry/rotation.h"

#define TURN 6.283185307179586

/** A camera on a circle of radius 6 about the origin, looking at it. */
static inline adcgs_camera camera_at(double angle)
{
    const double eye[3] = {6.0 * cos(angle), 6.0 * sin(angle), 1.0}, target[3] = {0, 0, 0}, up[3] = {0, 0, 1};
    adcgs_camera camera = make_camera();
    adcgs_look_at(camera.cam_to_world, eye, target, up);
    return camera;
}

static inline double way(const adcgs_camera *a, const adcgs_camera *b)
{
    double most = 0;
    for (int i = 0; i < 12; i++)
        most = fmax(most, fabs(a->cam_to_world[i] - b->cam_to_world[i]));
    return most;
}

#endif

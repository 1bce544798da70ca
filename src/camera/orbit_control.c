/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Moving a camera by hand. */
#include "config.h"

#include "camera/orbit_control.h"

#include "base/base.h"
#include "camera/rotation.h"

#include <math.h>

#define HALF_TURN 3.141592653589793
#define POLE 0.01          /* radians that stay between the view and up or down */
#define NEAREST 1e-3       /* scene units between camera and target */
#define FARTHEST 1e5       /* scene units between camera and centre: still far within what a view may hold */
#define ZOOM_STEP 0.9

/** A column of the matrix: 0 right, 1 down, 2 forward, 3 position. */
static void get_column(const adcgs_play_rig *rig, int column, double v[3])
{
    for (int i = 0; i < 3; i++)
        v[i] = rig->camera.cam_to_world[4 * i + column];
}

static void set_column(adcgs_play_rig *rig, int column, const double v[3])
{
    for (int i = 0; i < 3; i++)
        rig->camera.cam_to_world[4 * i + column] = v[i];
}

void adcgs_play_rig_init(adcgs_play_rig *rig, const adcgs_info *info, const adcgs_camera *camera)
{
    double down[3];
    *rig = (adcgs_play_rig){.camera = *camera, .unit = info->scene_scale};
    memcpy(rig->centre, info->scene_origin, sizeof rig->centre);
    memcpy(rig->target, rig->centre, sizeof rig->target);
    get_column(rig, 1, down);
    if (!adcgs_find_up(info, rig->up))
        for (int i = 0; i < 3; i++)
            rig->up[i] = -down[i];
    adcgs_v3_normalise(rig->up);
}

void adcgs_play_rig_jump(adcgs_play_rig *rig, const adcgs_camera *camera)
{
    rig->camera = *camera;
    memcpy(rig->target, rig->centre, sizeof rig->target);
}

/** The target as seen from the camera, and its depth, which is at least NEAREST. */
static double depth_of_target(const adcgs_play_rig *rig)
{
    double forward[3], place[3], offset[3];
    get_column(rig, 2, forward);
    get_column(rig, 3, place);
    for (int i = 0; i < 3; i++)
        offset[i] = rig->target[i] - place[i];
    return ADCGS_MAX(adcgs_v3_dot(offset, forward), NEAREST * rig->unit);
}

/** Put the camera somewhere, unless that is out of this world. \return whether it is there now. */
static int move_to(adcgs_play_rig *rig, const double place[3])
{
    double offset[3];
    for (int i = 0; i < 3; i++)
        offset[i] = place[i] - rig->centre[i];
    if (!(sqrt(adcgs_v3_dot(offset, offset)) <= FARTHEST * rig->unit))
        return 0;
    set_column(rig, 3, place);
    return 1;
}

/** Many turns add up their rounding: make the axes orthonormal again. */
static void straighten(adcgs_play_rig *rig)
{
    double right[3], down[3], forward[3];
    get_column(rig, 0, right);
    get_column(rig, 2, forward);
    adcgs_v3_normalise(forward);
    adcgs_v3_cross(forward, right, down);
    adcgs_v3_normalise(down);
    adcgs_v3_cross(down, forward, right);
    set_column(rig, 0, right);
    set_column(rig, 1, down);
    set_column(rig, 2, forward);
}

static void turn_about(adcgs_play_rig *rig, const double axis[3], double angle, const double pivot[3])
{
    for (int column = 0; column < 4; column++) {
        double v[3];
        get_column(rig, column, v);
        for (int i = 0; i < 3 && column == 3; i++)
            v[i] -= pivot[i];
        adcgs_v3_turn(axis, angle, v);
        for (int i = 0; i < 3 && column == 3; i++)
            v[i] += pivot[i];
        set_column(rig, column, v);
    }
    straighten(rig);
}

/** As much of a pitch as does not bring the view nearer to a pole than POLE. */
static double limit_pitch(const adcgs_play_rig *rig, const double forward[3], double pitch)
{
    const double from_up = acos(ADCGS_MAX(-1.0, ADCGS_MIN(1.0, adcgs_v3_dot(forward, rig->up))));
    const double lowest = ADCGS_MIN(0.0, from_up - (HALF_TURN - POLE)), highest = ADCGS_MAX(0.0, from_up - POLE);
    return ADCGS_MAX(lowest, ADCGS_MIN(highest, pitch));
}

static void yaw_and_pitch(adcgs_play_rig *rig, double yaw, double pitch, const double pivot[3])
{
    double forward[3], horizontal[3];
    if (yaw != 0.0)
        turn_about(rig, rig->up, yaw, pivot);
    get_column(rig, 2, forward);
    adcgs_v3_cross(forward, rig->up, horizontal);
    if (adcgs_v3_dot(horizontal, horizontal) < 1e-12)
        get_column(rig, 0, horizontal); /* straight up or down: there is no other horizontal */
    adcgs_v3_normalise(horizontal);
    if (pitch != 0.0)
        turn_about(rig, horizontal, limit_pitch(rig, forward, pitch), pivot);
}

void adcgs_play_rig_orbit(adcgs_play_rig *rig, double yaw, double pitch)
{
    yaw_and_pitch(rig, yaw, pitch, rig->target);
}

void adcgs_play_rig_look(adcgs_play_rig *rig, double yaw, double pitch)
{
    double place[3];
    get_column(rig, 3, place);
    yaw_and_pitch(rig, yaw, pitch, place);
    set_column(rig, 3, place);
}

void adcgs_play_rig_pan(adcgs_play_rig *rig, double right, double down)
{
    const double depth = depth_of_target(rig);
    double axes[2][3], place[3], shift[3];
    get_column(rig, 0, axes[0]);
    get_column(rig, 1, axes[1]);
    get_column(rig, 3, place);
    for (int i = 0; i < 3; i++) {
        shift[i] = -depth * (right * axes[0][i] + down * axes[1][i]);
        place[i] += shift[i];
    }
    for (int i = 0; move_to(rig, place) && i < 3; i++)
        rig->target[i] += shift[i];
}

void adcgs_play_rig_zoom(adcgs_play_rig *rig, double steps)
{
    const double depth = depth_of_target(rig);
    const double left = ADCGS_MAX(depth * pow(ZOOM_STEP, steps), NEAREST * rig->unit);
    adcgs_play_rig_fly(rig, 0.0, 0.0, (depth - left) / rig->unit);
}

void adcgs_play_rig_fly(adcgs_play_rig *rig, double right, double down, double forward)
{
    const double by[3] = {right, down, forward};
    double place[3];
    get_column(rig, 3, place);
    for (int column = 0; column < 3; column++) {
        double axis[3];
        get_column(rig, column, axis);
        for (int i = 0; i < 3; i++)
            place[i] += by[column] * rig->unit * axis[i];
    }
    move_to(rig, place);
}

void adcgs_play_rig_land(adcgs_play_rig *rig)
{
    const double depth = depth_of_target(rig);
    double forward[3], place[3];
    get_column(rig, 2, forward);
    get_column(rig, 3, place);
    for (int i = 0; i < 3; i++)
        rig->target[i] = place[i] + depth * forward[i];
}

double adcgs_play_rig_distance(const adcgs_play_rig *rig)
{
    double place[3];
    get_column(rig, 3, place);
    for (int i = 0; i < 3; i++)
        place[i] -= rig->target[i];
    return sqrt(adcgs_v3_dot(place, place));
}

void adcgs_play_rig_view(const adcgs_play_rig *rig, int width, int height, adcgs_camera *out)
{
    *out = rig->camera;
    adcgs_camera_fit(out, width, height, 0);
}

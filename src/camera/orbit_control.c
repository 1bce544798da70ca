/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Moving a camera by hand. */
#include "config.h"

#include "camera/orbit_control.h"

#include "base/base.h"
#include "geometry/rotation.h"

#include <math.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define HALF_TURN 3.141592653589793 /* radians; definition */
#define POLE 0.01                   /* smallest angle [radians] between the view and up or down */
#define NEAREST 1e-3                /* smallest depth of the target [scene units] */
#define FARTHEST 1e5                /* largest distance from the centre [scene units], far below the limit of a view */
#define CROP_MOST 2.0               /* the camera's width or height, relative to the part of it that an image shows */
#define ZOOM_STEP 0.9               /* factor of the target's depth per step */

/** A column of the matrix: 0 right, 1 down, 2 forward, 3 position. */
static void get_column(const adcgs_orbit_control *control, int column, double v[3])
{
    for (int i = 0; i < 3; i++)
        v[i] = control->camera.cam_to_world[4 * i + column];
}

static void set_column(adcgs_orbit_control *control, int column, const double v[3])
{
    for (int i = 0; i < 3; i++)
        control->camera.cam_to_world[4 * i + column] = v[i];
}

void adcgs_orbit_control_init(adcgs_orbit_control *control, const adcgs_info *info, const adcgs_camera *camera)
{
    double down[3];
    *control = (adcgs_orbit_control){.camera = *camera, .unit = info->scene_scale};
    memcpy(control->centre, info->scene_origin, sizeof control->centre);
    memcpy(control->target, control->centre, sizeof control->target);
    get_column(control, 1, down);
    if (!adcgs_find_up(info, control->up))
        for (int i = 0; i < 3; i++)
            control->up[i] = -down[i];
    adcgs_v3_normalise(control->up);
}

void adcgs_orbit_control_jump(adcgs_orbit_control *control, const adcgs_camera *camera)
{
    control->camera = *camera;
    memcpy(control->target, control->centre, sizeof control->target);
}

void adcgs_orbit_control_pivot(adcgs_orbit_control *control, const double point[3])
{
    memcpy(control->target, point, sizeof control->target);
}

/** Depth of the target seen from the camera, at least NEAREST. */
static double depth_of_target(const adcgs_orbit_control *control)
{
    double forward[3], place[3], offset[3];
    get_column(control, 2, forward);
    get_column(control, 3, place);
    for (int i = 0; i < 3; i++)
        offset[i] = control->target[i] - place[i];
    return ADCGS_MAX(adcgs_v3_dot(offset, forward), NEAREST * control->unit);
}

/** Move the camera, except beyond FARTHEST. \return true if it was moved */
static int move_to(adcgs_orbit_control *control, const double place[3])
{
    double offset[3];
    for (int i = 0; i < 3; i++)
        offset[i] = place[i] - control->centre[i];
    if (!(sqrt(adcgs_v3_dot(offset, offset)) <= FARTHEST * control->unit))
        return 0;
    set_column(control, 3, place);
    return 1;
}

/** Make the axes orthonormal again, since rounding errors of many turns accumulate. */
static void straighten(adcgs_orbit_control *control)
{
    double right[3], down[3], forward[3];
    get_column(control, 0, right);
    get_column(control, 2, forward);
    adcgs_v3_normalise(forward);
    adcgs_v3_cross(forward, right, down);
    adcgs_v3_normalise(down);
    adcgs_v3_cross(down, forward, right);
    set_column(control, 0, right);
    set_column(control, 1, down);
    set_column(control, 2, forward);
}

static void turn_about(adcgs_orbit_control *control, const double axis[3], double angle, const double pivot[3])
{
    for (int column = 0; column < 4; column++) {
        double v[3];
        get_column(control, column, v);
        for (int i = 0; i < 3 && column == 3; i++)
            v[i] -= pivot[i];
        adcgs_rotate_about(axis, angle, v);
        for (int i = 0; i < 3 && column == 3; i++)
            v[i] += pivot[i];
        set_column(control, column, v);
    }
    straighten(control);
}

/** The part of a pitch that keeps the view at least POLE from a pole. */
static double limit_pitch(const adcgs_orbit_control *control, const double forward[3], double pitch)
{
    const double from_up = acos(ADCGS_MAX(-1.0, ADCGS_MIN(1.0, adcgs_v3_dot(forward, control->up))));
    const double lowest = ADCGS_MIN(0.0, from_up - (HALF_TURN - POLE)), highest = ADCGS_MAX(0.0, from_up - POLE);
    return ADCGS_MAX(lowest, ADCGS_MIN(highest, pitch));
}

static void yaw_and_pitch(adcgs_orbit_control *control, double yaw, double pitch, const double pivot[3])
{
    double forward[3], horizontal[3];
    if (yaw != 0.0)
        turn_about(control, control->up, yaw, pivot);
    get_column(control, 2, forward);
    adcgs_v3_cross(forward, control->up, horizontal);
    if (adcgs_v3_dot(horizontal, horizontal) < 1e-12)
        get_column(control, 0, horizontal); /* straight up or down there is no other horizontal */
    adcgs_v3_normalise(horizontal);
    if (pitch != 0.0)
        turn_about(control, horizontal, limit_pitch(control, forward, pitch), pivot);
}

void adcgs_orbit_control_orbit(adcgs_orbit_control *control, double yaw, double pitch)
{
    yaw_and_pitch(control, yaw, pitch, control->target);
}

void adcgs_orbit_control_look(adcgs_orbit_control *control, double yaw, double pitch)
{
    double place[3];
    get_column(control, 3, place);
    yaw_and_pitch(control, yaw, pitch, place);
    set_column(control, 3, place);
}

void adcgs_orbit_control_pan(adcgs_orbit_control *control, double right, double down)
{
    const double depth = depth_of_target(control);
    double axes[2][3], place[3], shift[3];
    get_column(control, 0, axes[0]);
    get_column(control, 1, axes[1]);
    get_column(control, 3, place);
    for (int i = 0; i < 3; i++) {
        shift[i] = -depth * (right * axes[0][i] + down * axes[1][i]);
        place[i] += shift[i];
    }
    for (int i = 0; move_to(control, place) && i < 3; i++)
        control->target[i] += shift[i];
}

void adcgs_orbit_control_zoom(adcgs_orbit_control *control, double steps)
{
    const double depth = depth_of_target(control);
    const double left = ADCGS_MAX(depth * pow(ZOOM_STEP, steps), NEAREST * control->unit);
    adcgs_orbit_control_fly(control, 0.0, 0.0, (depth - left) / control->unit);
}

void adcgs_orbit_control_fly(adcgs_orbit_control *control, double right, double down, double forward)
{
    const double by[3] = {right, down, forward};
    double place[3];
    get_column(control, 3, place);
    for (int column = 0; column < 3; column++) {
        double axis[3];
        get_column(control, column, axis);
        for (int i = 0; i < 3; i++)
            place[i] += by[column] * control->unit * axis[i];
    }
    move_to(control, place);
}

void adcgs_orbit_control_land(adcgs_orbit_control *control)
{
    const double depth = depth_of_target(control);
    double forward[3], place[3];
    get_column(control, 2, forward);
    get_column(control, 3, place);
    for (int i = 0; i < 3; i++)
        control->target[i] = place[i] + depth * forward[i];
}

double adcgs_orbit_control_distance(const adcgs_orbit_control *control)
{
    double place[3];
    get_column(control, 3, place);
    for (int i = 0; i < 3; i++)
        place[i] -= control->target[i];
    return sqrt(adcgs_v3_dot(place, place));
}

/** The shape of the part of the camera's view that fills an image of a size: width over height. */
static double shape_of(const adcgs_orbit_control *control, int width, int height)
{
    const double filmed = (double)control->camera.width / control->camera.height;
    return ADCGS_MAX(filmed / CROP_MOST, ADCGS_MIN((double)width / height, filmed * CROP_MOST));
}

double adcgs_orbit_control_inset(const adcgs_orbit_control *control, int width, int height, int axis)
{
    const double part = shape_of(control, width, height) * height / width;
    return 0.5 * ADCGS_MAX(0, 1 - (axis ? 1 / part : part));
}

void adcgs_orbit_control_view(const adcgs_orbit_control *control, int width, int height, adcgs_camera *out)
{
    const double shape = shape_of(control, width, height);
    *out = control->camera;
    /* First a part of the view with the window's shape, as far as half of the view remains; then more at two sides. */
    adcgs_camera_fit(out, ADCGS_MAX(1, (int)rint(height * shape)), height, 1);
    if (out->width != width)
        adcgs_camera_fit(out, width, height, 0);
}

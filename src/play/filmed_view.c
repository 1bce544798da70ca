/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The view and the cameras that filmed. */
#include "config.h"

#include "play/filmed_view.h"

#include "base/base.h"
#include "geometry/pose_product.h"
#include "geometry/rotation.h"

#include <math.h>

/* Origin: chosen by hand, not measured. */
#define RETURN_SECONDS 0.3 /* in which a view outside goes most of its way back, while it plays */
#define LOOP_SECONDS 0.8   /* of the scene, from the path's end to its start; at most half of the scene */
#define PART_STEPS 12      /* halvings: 1/4096 of an offset is invisible */

static void transform(const double pose[12], const double point[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = pose[4 * i] * point[0] + pose[4 * i + 1] * point[1] + pose[4 * i + 2] * point[2] + pose[4 * i + 3];
}

/** Distance from a camera to the scene's centre, as a first guess of that to the pivot. */
static double distance_to_centre(const adcgs_info *info, const adcgs_camera *camera)
{
    double sum = 0;
    for (int i = 0; i < 3; i++)
        sum += pow(camera->cam_to_world[4 * i + 3] - info->scene_origin[i], 2);
    return sqrt(sum);
}

adcgs_status adcgs_filmed_view_init(adcgs_filmed_view *view, const adcgs_info *info, const adcgs_filmed_camera *cameras,
                                    const adcgs_camera *home, adcgs_error *error)
{
    double up[3];
    const int has_up = adcgs_find_up(info, up);
    *view = (adcgs_filmed_view){.following = 0};
    ADCGS_TRY(adcgs_follow_init(&view->follow, cameras, info->cameras, 0, error));
    return adcgs_view_limit_init(&view->limit, cameras, info->cameras, &view->follow, has_up ? up : NULL,
                                 distance_to_centre(info, home), error);
}

void adcgs_filmed_view_clear(adcgs_filmed_view *view)
{
    adcgs_follow_clear(&view->follow);
    adcgs_view_limit_clear(&view->limit);
}

int adcgs_filmed_view_has_path(const adcgs_filmed_view *view)
{
    return view->follow.spline.n > 0;
}

void adcgs_filmed_view_start(adcgs_filmed_view *view, adcgs_orbit_control *control, double time)
{
    adcgs_camera camera;
    adcgs_follow_at(&view->follow, time, &camera);
    adcgs_orbit_control_jump(control, &camera);
    memcpy(view->base, camera.cam_to_world, sizeof view->base);
    adcgs_filmed_view_moved(view, control);
    view->following = 1;
    view->beside = view->returning = 0;
}

/** The pose of a part of an offset from a base: of its turn about the target in the base's axes, and of the rest of the way. */
static void place_part(const double base[12], const double offset[12], const double target[3], double part, double pose[12])
{
    double none[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}, from[4], to[4], turn[3], whole[3], turned[3];
    adcgs_rotation_from_pose(none, from);
    adcgs_rotation_from_pose(offset, to);
    adcgs_rotation_between(from, to, turn);
    adcgs_rotation_exp(turn, part, to);
    adcgs_rotation_to_pose(to, none);
    transform(offset, target, whole);
    transform(none, target, turned);
    for (int i = 0; i < 3; i++)
        none[4 * i + 3] = target[i] - turned[i] + part * (whole[i] - target[i]);
    adcgs_pose_product(base, none, pose);
}

static void place_beside(const adcgs_filmed_view *view, double part, double pose[12])
{
    place_part(view->base, view->offset, view->target, part, pose);
}

/** Moves the base from the path's end, where it was at the turn of a loop, to the path's camera. */
static void return_to_start(adcgs_filmed_view *view, const adcgs_play_clock *clock)
{
    const double seconds = fmin(LOOP_SECONDS, 0.5 * clock->frames / clock->rate);
    const double part = (adcgs_play_clock_time(clock) - clock->begin) / seconds;
    double offset[12], pose[12];
    view->returning = view->returning && clock->turns > 0 && part < 1;
    if (!view->returning)
        return;
    memcpy(offset, view->base, sizeof offset);
    adcgs_pose_invert(offset);
    adcgs_pose_product(offset, view->end, offset);
    place_part(view->base, offset, view->target, 1 - part * part * (3 - 2 * part), pose);
    memcpy(view->base, pose, sizeof view->base);
}

/** The largest part of the offset that is inside of the filmed region. */
static double part_inside(const adcgs_filmed_view *view)
{
    double pose[12], low = 0, high = 1;
    place_beside(view, 1, pose);
    if (view->unlimited || adcgs_view_limit_at(&view->limit, pose) <= 1)
        return 1;
    for (int i = 0; i < PART_STEPS; i++) {
        const double middle = 0.5 * (low + high);
        place_beside(view, middle, pose);
        if (adcgs_view_limit_at(&view->limit, pose) <= 1)
            low = middle;
        else
            high = middle;
    }
    return low;
}

void adcgs_filmed_view_tick(adcgs_filmed_view *view, adcgs_orbit_control *control, const adcgs_play_clock *clock, double seconds)
{
    adcgs_camera camera;
    if (clock->turns > view->turns) {
        memcpy(view->end, view->base, sizeof view->end);
        view->returning = 1;
    }
    view->turns = clock->turns;
    if (!view->following)
        return;
    adcgs_follow_at(&view->follow, adcgs_play_clock_time(clock), &camera);
    memcpy(view->base, camera.cam_to_world, sizeof view->base);
    return_to_start(view, clock);
    if (view->beside && seconds > 0 && !view->returning)
        view->part += (part_inside(view) - view->part) * (1 - exp(-seconds / RETURN_SECONDS));
    memcpy(camera.cam_to_world, view->base, sizeof view->base);
    if (view->beside)
        place_beside(view, view->part, camera.cam_to_world);
    control->camera = camera;
    transform(view->base, view->target, control->target);
}

void adcgs_filmed_view_moved(adcgs_filmed_view *view, const adcgs_orbit_control *control)
{
    double inverse[12];
    memcpy(inverse, view->base, sizeof inverse);
    adcgs_pose_invert(inverse);
    adcgs_pose_product(inverse, control->camera.cam_to_world, view->offset);
    transform(inverse, control->target, view->target);
    view->beside = 1;
    view->part = 1;
}

static double limit_at(const adcgs_filmed_view *view, const adcgs_orbit_control *control)
{
    return adcgs_view_limit_at(&view->limit, control->camera.cam_to_world);
}

double adcgs_filmed_view_outside(const adcgs_filmed_view *view, const adcgs_orbit_control *control)
{
    return view->unlimited || view->returning ? 0 : fmax(0, fmin(limit_at(view, control) - 1, 1));
}

double adcgs_filmed_view_share(const adcgs_filmed_view *view, const adcgs_orbit_control *before, const adcgs_orbit_control *after)
{
    const double from = limit_at(view, before), to = limit_at(view, after);
    if (view->unlimited || to <= 1 || to <= from)
        return 1;
    /* Full inside, and down to nothing at the limit, with the square of the rest of the way. */
    const double rest = fmax(0, fmin(2 - fmax(from, 1), 1)), share = rest * rest;
    return fmin(share, fmax(0, (2 - from) / (to - from)));
}

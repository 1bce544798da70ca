/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The paths of cameras, from basic arithmetic only, like all code of the scenes. */
#include "synthetic/scene_views.h"

#include "synthetic/sine.h"

#include <math.h>

/* The scenes' own shape; chosen by hand, except for the geometry of GOLDEN. Other values make other scenes. */
#define GOLDEN 0.3819660112501051 /* turns between consecutive cameras of a sphere: (3 - sqrt 5) / 2 */
#define LOWEST (-0.35)            /* sine of the elevation of its lowest camera */
#define HIGHEST 0.95              /* and of its highest camera */
#define DRIVEN 8.0                /* units that the car drives in a clip */
#define FRONT_ARC 0.083           /* turns of the arc of cameras in front of the target */
#define SWEPT 2.0                 /* units that the camera sweeps along x */
#define BEHIND 10.0               /* units behind its path, the point where all optical axes meet */

/*
 * By split: validation and test views lie between the training cameras; test views also lie between their times. Steps from one
 * camera, or time, to the next; chosen by hand.
 */
static const double between[ADCGS_SPLITS] = {0.0, 0.3, 0.5}, later[ADCGS_SPLITS] = {0.0, 0.0, 0.5};

int adcgs_scenes_split_size(const adcgs_scenes_entry *scene, int split)
{
    return split == ADCGS_SPLIT_TRAIN ? scene->cameras / scene->turns * scene->times
           : split == ADCGS_SPLIT_VAL ? scene->n_val
                                      : scene->n_test;
}

static double focal_of(const adcgs_scenes_entry *scene, int width)
{
    return 0.5 * width * (scene->is_wide ? ADCGS_SCENES_WIDE : ADCGS_SCENES_FOCAL);
}

void adcgs_scenes_place(adcgs_trace_camera *camera, const adcgs_scenes_entry *scene, double azimuth, double elevation, int width)
{
    const double flat = scene->distance * adcgs_trace_cos(elevation);
    const double eye[3] = {scene->target[0] + flat * adcgs_trace_sin(azimuth), scene->target[1] - flat * adcgs_trace_cos(azimuth),
                           scene->target[2] + scene->distance * adcgs_trace_sin(elevation)};
    camera->focal = focal_of(scene, width);
    adcgs_trace_look(camera, eye, scene->target);
}

/*
 * A hand-held camera: back and forth on an arc of 50 degrees, and up and down. Validation and test views are offset sideways by
 * a hand's breadth or two, as if from a second lens. The times of test views lie between the camera's times.
 */
static adcgs_scenes_view filmed_at(const adcgs_scenes_entry *scene, int split, int i, int width)
{
    static const double beside[ADCGS_SPLITS] = {0.0, -0.008, 0.010};
    const int steps = scene->times - 1, count = adcgs_scenes_split_size(scene, split);
    const int moment = split == ADCGS_SPLIT_TRAIN ? i : (int)((double)i / count * steps);
    adcgs_scenes_view v = {.time = (moment + later[split]) / steps};
    const double phase = scene->swings * v.time;
    adcgs_scenes_place(&v.camera, scene, 0.07 * adcgs_trace_sin(phase) + beside[split],
                       0.085 + 0.025 * adcgs_trace_sin(2.3 * phase + 0.1), width);
    return v;
}

/* Camera and time of training image i: cameras take turns, so some of them see each time. */
static void take_turns(const adcgs_scenes_entry *scene, int i, adcgs_scenes_view *v)
{
    const int each = scene->cameras / scene->turns, moment = i / each, steps = scene->times - 1;
    v->number = i % each * scene->turns + moment % scene->turns;
    v->time = steps > 0 ? (double)moment / steps : 0.0;
}

/* Time of view i of another split. 7 is coprime to the counts in use, so that place and time are not correlated. */
static double scattered_time(const adcgs_scenes_entry *scene, int split, int i)
{
    const int steps = scene->times - 1, count = adcgs_scenes_split_size(scene, split);
    const double moment = (double)(i * 7 % count) / count * steps;
    return steps > 0 ? ((double)(int)moment + later[split]) / steps : 0.0;
}

/* Place 0..1 and time of view i of a split: training cameras from end to end, the others between them. */
static double spread(const adcgs_scenes_entry *scene, int split, int i, adcgs_scenes_view *v)
{
    if (split == ADCGS_SPLIT_TRAIN) {
        take_turns(scene, i, v);
        return scene->cameras > 1 ? (double)v->number / (scene->cameras - 1) : 0.5;
    }
    v->time = scattered_time(scene, split, i);
    return (i + between[split]) / adcgs_scenes_split_size(scene, split);
}

/* Training cameras stand at three heights. */
static adcgs_scenes_view view_on_arc(const adcgs_scenes_entry *scene, int split, int i, int width)
{
    static const double heights[3] = {0.050, 0.120, 0.085};
    adcgs_scenes_view v = {.time = 0.0};
    const double along = spread(scene, split, i, &v) - 0.5;
    const int c = v.number;
    if (split == ADCGS_SPLIT_TRAIN)
        adcgs_scenes_place(&v.camera, scene, ADCGS_SCENES_ARC * along, heights[(c + c / 3) % 3], width);
    else
        adcgs_scenes_place(&v.camera, scene, 0.36 * along, 0.065 + 0.040 * (double)(i * 3 % 5) / 4.0, width);
    return v;
}

/* Evenly over the sphere: each camera is a golden angle further around than the one below it. */
static adcgs_scenes_view view_around(const adcgs_scenes_entry *scene, int split, int i, int width)
{
    adcgs_scenes_view v = {.time = 0.0, .camera.focal = focal_of(scene, width)};
    (void)spread(scene, split, i, &v);
    const int n = split == ADCGS_SPLIT_TRAIN ? scene->cameras : adcgs_scenes_split_size(scene, split);
    const int k = split == ADCGS_SPLIT_TRAIN ? v.number : i;
    const double sine = LOWEST + (HIGHEST - LOWEST) * (k + 0.5) / n, flat = scene->distance * sqrt(1.0 - sine * sine);
    const double azimuth = GOLDEN * k + between[split], *const to = scene->target;
    const double eye[3] = {to[0] + flat * adcgs_trace_sin(azimuth), to[1] - flat * adcgs_trace_cos(azimuth),
                           to[2] + scene->distance * sine};
    adcgs_trace_look(&v.camera, eye, to);
    return v;
}

/* Progress 0..1 of a camera along its path: from its time, or in a static scene from the image's number. */
static double gone(const adcgs_scenes_entry *scene, int split, int i, adcgs_scenes_view *v)
{
    const int count = adcgs_scenes_split_size(scene, split), steps = scene->times - 1;
    if (split == ADCGS_SPLIT_TRAIN)
        take_turns(scene, i, v);
    else if (steps > 0)
        v->time = ((double)(int)((double)i / count * steps) + later[split]) / steps;
    return steps > 0 ? v->time : split == ADCGS_SPLIT_TRAIN ? (double)v->number / scene->cameras : (i + between[split]) / count;
}

/* Once around. The steps of the training camera are uneven. Test cameras walk slightly inside or outside of its path. */
static adcgs_scenes_view view_walking(const adcgs_scenes_entry *scene, int split, int i, int width)
{
    adcgs_scenes_view v = {.time = 0.0, .camera.focal = focal_of(scene, width)};
    const double along = gone(scene, split, i, &v), sine = adcgs_trace_sin(along), cosine = adcgs_trace_cos(along);
    const double radius = scene->distance * (split == ADCGS_SPLIT_TRAIN ? 1.0 + 0.08 * adcgs_trace_sin(9.0 * along)
                                                                        : 0.92 + 0.08 * (double)(i % 3));
    const double *const to = scene->target, height = to[2] + 0.06 * adcgs_trace_sin(5.0 * along);
    const double eye[3] = {to[0] + radius * sine, to[1] + radius * cosine, height};
    const double ahead[3] = {eye[0] + sine, eye[1] + cosine, height - 0.08 * adcgs_trace_sin(3.0 * along)};
    adcgs_trace_look(&v.camera, eye, ahead);
    return v;
}

/* Training cameras look ahead and to both sides by 25 degrees; test cameras look between them. */
static adcgs_scenes_view view_driving(const adcgs_scenes_entry *scene, int split, int i, int width)
{
    adcgs_scenes_view v = {.time = 0.0, .camera.focal = focal_of(scene, width)};
    const double along = gone(scene, split, i, &v);
    const double side = split == ADCGS_SPLIT_TRAIN ? (scene->cameras > 1 ? 2.0 * v.number / (scene->cameras - 1) - 1.0 : 0.0)
                                                   : (i % 2 ? 0.4 : -0.4);
    const double *const to = scene->target, yaw = 0.07 * side;
    const double eye[3] = {to[0] + 0.5 * side, to[1] + DRIVEN * along, to[2] + 0.03 * adcgs_trace_sin(4.0 * along)};
    const double ahead[3] = {eye[0] + adcgs_trace_sin(yaw), eye[1] + adcgs_trace_cos(yaw), eye[2] + 0.05};
    adcgs_trace_look(&v.camera, eye, ahead);
    return v;
}

static adcgs_scenes_view view_in_front(const adcgs_scenes_entry *scene, int split, int i, int width)
{
    adcgs_scenes_view v = {.time = 0.0};
    const double along = spread(scene, split, i, &v) - 0.5, inside = split == ADCGS_SPLIT_TRAIN ? 1.0 : 0.8;
    const int k = split == ADCGS_SPLIT_TRAIN ? v.number : i;
    adcgs_scenes_place(&v.camera, scene, inside * FRONT_ARC * along, 0.012 + inside * 0.018 * ((double)(k * 2 % 5) - 2.0) / 2.0,
                       width);
    return v;
}

static adcgs_scenes_view view_from_tripod(const adcgs_scenes_entry *scene, int split, int i, int width)
{
    adcgs_scenes_view v = {.time = 0.0};
    (void)gone(scene, split, i, &v);
    adcgs_scenes_place(&v.camera, scene, 0.0, 0.085, width);
    return v;
}

static adcgs_scenes_view view_sweeping(const adcgs_scenes_entry *scene, int split, int i, int width)
{
    adcgs_scenes_view v = {.time = 0.0, .camera.focal = focal_of(scene, width)};
    const double along = spread(scene, split, i, &v) - 0.5, *const to = scene->target;
    const int k = split == ADCGS_SPLIT_TRAIN ? v.number : i;
    const double eye[3] = {to[0] + SWEPT * along, to[1] - scene->distance, to[2] + 0.12 * ((double)(k * 2 % 5) - 2.0)};
    const double ahead[3] = {eye[0] + SWEPT * along, eye[1] + BEHIND, 2.0 * eye[2] - to[2]};
    adcgs_trace_look(&v.camera, eye, ahead);
    return v;
}

adcgs_scenes_view adcgs_scenes_view_at(const adcgs_scenes_entry *scene, int split, int i, int width)
{
    switch (scene->path) {
    case ADCGS_PATH_HAND:
        return filmed_at(scene, split, i, width);
    case ADCGS_PATH_ROUND:
        return view_around(scene, split, i, width);
    case ADCGS_PATH_WALK:
        return view_walking(scene, split, i, width);
    case ADCGS_PATH_DRIVE:
        return view_driving(scene, split, i, width);
    case ADCGS_PATH_FRONT:
        return view_in_front(scene, split, i, width);
    case ADCGS_PATH_TRIPOD:
        return view_from_tripod(scene, split, i, width);
    case ADCGS_PATH_SWEEP:
        return view_sweeping(scene, split, i, width);
    default:
        return view_on_arc(scene, split, i, width);
    }
}

/* Evenly spaced exposures in a scattered order: the camera's number times a step that is coprime to n, modulo n. */
double adcgs_scenes_stops(const adcgs_scenes_entry *scene, int camera)
{
    const int n = scene->cameras;
    int step = n / 3 + 1, a = 0;
    if (n < 2)
        return 0.0;
    do {
        int b = n;
        for (a = ++step; b;) {
            const int rest = a % b;
            a = b;
            b = rest;
        }
    } while (a != 1);
    return scene->stops * (2.0 * (double)(int)((int64_t)camera * step % n) / (n - 1) - 1.0);
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Camera paths around the stored cameras. */
#include "config.h"

#include "camera/spline.h"
#include "geometry/rotation.h"

#include <adcgs/decoder.h>

#include <math.h>
#include <stdlib.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define FULL_TURN 6.283185307179586 /* radians; definition */
#define SPIRAL_TURNS 2.0            /* turns of the path; literature: LLFF, 2019 (path.h) */
#define SPIRAL_LEAST 0.1            /* radius over the distance to the focus, for cameras without a spread of their own */
#define SPIRAL_MOST 0.5             /* upper bound of the radius over the distance to the focus */
#define LOOK_TOGETHER 0.5           /* smallest length of the mean viewing direction for which cameras have a mean pose */
#define RING_GAP 2.0                /* largest gap within a closed ring, in mean gaps */

/** Mean of a column of the cameras' matrices: 0 right, 1 down, 2 forward, 3 position. */
static void mean_column(const adcgs_rig *rig, int column, double out[3])
{
    for (int i = 0; i < 3; i++) {
        out[i] = 0.0;
        for (int c = 0; c < rig->n; c++)
            out[i] += rig->cameras[c].cam_to_world[4 * i + column] / rig->n;
    }
}

/** Mean depth of the focus over the cameras that have it in front of them; 0 if none has. */
static double mean_distance(const adcgs_rig *rig)
{
    double sum = 0.0;
    int n = 0;
    for (int c = 0; c < rig->n; c++) {
        const double *m = rig->cameras[c].cam_to_world;
        double ahead = 0.0;
        for (int i = 0; i < 3; i++)
            ahead += (rig->focus[i] - m[4 * i + 3]) * m[4 * i + 2];
        if (ahead > 0.0) {
            sum += ahead;
            n++;
        }
    }
    return n ? sum / n : 0.0;
}

adcgs_status adcgs_rig_init(adcgs_rig *rig, const adcgs_decoder *decoder, const adcgs_info *info, const double up[3],
                            adcgs_error *error)
{
    *rig = (adcgs_rig){.n = info->cameras ? info->cameras : 1};
    rig->cameras = malloc((size_t)rig->n * sizeof *rig->cameras);
    if (!rig->cameras)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for %d cameras", rig->n);
    if (!info->cameras)
        adcgs_camera_path_default(&rig->cameras[0], info, up);
    for (int c = 0; c < info->cameras; c++) {
        ADCGS_TRY(adcgs_get_camera(decoder, c, &rig->cameras[c], error));
        adcgs_camera_fit(&rig->cameras[c], rig->cameras[0].width, rig->cameras[0].height, 0);
    }
    memcpy(rig->focus, info->scene_origin, sizeof rig->focus);
    rig->distance = mean_distance(rig);
    if (!(rig->distance > 1e-3 * info->scene_scale))
        rig->distance = info->scene_scale;
    mean_column(rig, 1, rig->up);
    for (int i = 0; i < 3; i++)
        rig->up[i] = -rig->up[i];
    if (adcgs_v3_normalise(rig->up) < 1e-3)
        memcpy(rig->up, up, sizeof rig->up);
    return ADCGS_OK;
}

void adcgs_rig_clear(adcgs_rig *rig)
{
    free(rig->cameras);
    *rig = (adcgs_rig){0};
}

/* ---- Spiral ---- */

/** The mean pose, and the spread of the cameras along its axes; without a mean pose the first camera, and a default spread. */
static void spiral_frame(const adcgs_rig *rig, double pose[12], double radius[3])
{
    double eye[3], ahead[3], target[3];
    mean_column(rig, 3, eye);
    mean_column(rig, 2, ahead);
    const int together = adcgs_v3_normalise(ahead) > LOOK_TOGETHER;
    for (int i = 0; i < 3; i++)
        target[i] = eye[i] + ahead[i];
    if (together)
        adcgs_look_at(pose, eye, target, rig->up);
    else
        memcpy(pose, rig->cameras[0].cam_to_world, 12 * sizeof *pose);
    for (int k = 0; k < 3; k++) {
        double sum = 0.0;
        for (int c = 0; c < rig->n; c++) {
            double along = 0.0;
            for (int i = 0; i < 3; i++)
                along += (rig->cameras[c].cam_to_world[4 * i + 3] - pose[4 * i + 3]) * pose[4 * i + k];
            sum += along * along / rig->n;
        }
        const int spread = together && rig->n >= 3;
        radius[k] = spread ? fmin(sqrt(sum), SPIRAL_MOST * rig->distance) : SPIRAL_LEAST * rig->distance;
    }
}

void adcgs_rig_spiral(const adcgs_rig *rig, adcgs_camera_path *frames)
{
    double pose[12], radius[3], focus[3], up[3];
    spiral_frame(rig, pose, radius);
    for (int i = 0; i < 3; i++) {
        focus[i] = pose[4 * i + 3] + rig->distance * pose[4 * i + 2];
        up[i] = -pose[4 * i + 1];
    }
    for (int s = 0; s < frames->n; s++) {
        const double angle = SPIRAL_TURNS * FULL_TURN * s / frames->n;
        /* one cycle forward and back during two turns */
        const double offset[3] = {radius[0] * cos(angle), radius[1] * sin(angle), radius[2] * sin(angle / SPIRAL_TURNS)};
        double eye[3];
        for (int i = 0; i < 3; i++)
            eye[i] = pose[4 * i + 3] + offset[0] * pose[4 * i] + offset[1] * pose[4 * i + 1] + offset[2] * pose[4 * i + 2];
        frames->frame[s].camera = rig->cameras[0];
        adcgs_look_at(frames->frame[s].camera.cam_to_world, eye, focus, up);
    }
}

/* ---- Bullet time ---- */

typedef struct place {
    double angle; /* around the focus, seen from above */
    int camera;
} place;

static int compare_places(const void *a, const void *b)
{
    const place *x = a, *y = b;
    return x->angle != y->angle ? (x->angle < y->angle ? -1 : 1) : x->camera - y->camera;
}

/** Sort the cameras by angle, beginning after the largest gap. \return that gap */
static double order_places(const adcgs_rig *rig, place *places)
{
    double side[3], ahead[3] = {0.0, 0.0, 0.0};
    int least = 0, begin = 0;
    for (int i = 1; i < 3; i++)
        least = fabs(rig->up[i]) < fabs(rig->up[least]) ? i : least;
    ahead[least] = 1.0;
    adcgs_v3_cross(rig->up, ahead, side);
    adcgs_v3_normalise(side);
    adcgs_v3_cross(side, rig->up, ahead);
    for (int c = 0; c < rig->n; c++) {
        const double *m = rig->cameras[c].cam_to_world;
        const double from[3] = {m[3] - rig->focus[0], m[7] - rig->focus[1], m[11] - rig->focus[2]};
        places[c] = (place){atan2(adcgs_v3_dot(from, side), adcgs_v3_dot(from, ahead)), c};
    }
    qsort(places, (size_t)rig->n, sizeof *places, compare_places);
    double gap = places[0].angle + FULL_TURN - places[rig->n - 1].angle;
    for (int c = 1; c < rig->n; c++)
        if (places[c].angle - places[c - 1].angle > gap) {
            gap = places[c].angle - places[c - 1].angle;
            begin = c;
        }
    for (int c = 0; c < begin; c++)
        places[c].angle += FULL_TURN;
    qsort(places, (size_t)rig->n, sizeof *places, compare_places);
    return gap;
}

static double distance_between(const adcgs_camera *a, const adcgs_camera *b)
{
    double sum = 0.0;
    for (int i = 3; i < 12; i += 4)
        sum += (a->cam_to_world[i] - b->cam_to_world[i]) * (a->cam_to_world[i] - b->cam_to_world[i]);
    return sqrt(sum);
}

/** A key for each camera, positioned by path length; cameras at the same position give one key. \return the number of keys */
static int make_keys(const adcgs_rig *rig, const place *places, int closed, adcgs_camera_key *keys)
{
    int n = 0;
    for (int c = 0; c < rig->n + (closed != 0); c++) {
        const adcgs_camera *camera = &rig->cameras[places[c % rig->n].camera];
        const double way = n ? distance_between(camera, &keys[n - 1].frame.camera) : 0.0;
        if (n && way <= 1e-6 * rig->distance)
            continue;
        keys[n] = (adcgs_camera_key){.at = n ? keys[n - 1].at + way : 0.0, .frame.camera = *camera};
        n++;
    }
    return n;
}

adcgs_status adcgs_rig_bullet(const adcgs_rig *rig, adcgs_camera_path *frames, adcgs_error *error)
{
    place *places = malloc((size_t)rig->n * sizeof *places);
    adcgs_camera_key *keys = malloc(((size_t)rig->n + 1) * sizeof *keys);
    adcgs_camera_spline spline = {0};
    adcgs_status status = places && keys ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for %d cameras", rig->n);
    if (status == ADCGS_OK) {
        const int closed = order_places(rig, places) <= RING_GAP * FULL_TURN / rig->n;
        const int n = make_keys(rig, places, closed, keys);
        status = adcgs_camera_spline_init(&spline, keys, n, 0, closed, error);
        const double whole = keys[n - 1].at, last = closed || frames->n < 2 ? frames->n : frames->n - 1;
        for (int s = 0; s < frames->n && status == ADCGS_OK; s++) {
            const double time = frames->frame[s].time;
            adcgs_camera_spline_at(&spline, whole * s / last, &frames->frame[s]);
            frames->frame[s].time = time;
        }
    }
    adcgs_camera_spline_clear(&spline);
    free(places);
    free(keys);
    return status;
}

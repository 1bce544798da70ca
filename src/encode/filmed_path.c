/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Choice of a filmed path's keys. */
#include "config.h"

#include "encode/filmed_path.h"

#include "camera/spline.h"
#include "geometry/rotation.h"

#include <math.h>

/*
 * Origin, unless a line states one: chosen by hand, not measured. Paths as a whole: 17 keys for the 48 images of nrnerf_hand,
 * within 1.5 % of the width.
 */
#define KEYS_LEAST 2    /* keys of a path; geometry: its two ends */
#define KEYS_FEW 8      /* maximum number of keys of a short film; a longer one has VIEWS_PER_KEY views to each further key */
#define VIEWS_PER_KEY 8 /* with fewer views, a key is hardly smaller than the poses that it replaces */
#define KEYS_MOST 64    /* 3.5 KB */
#define ERROR_AIM 0.01  /* image widths: a deviation that nobody sees in a moving image */
#define ERROR_MOST 0.05 /* image widths, mean over the views: cameras beyond are no smooth path, but single photographs */

/** Deviation of a camera from a view's, in image widths: by rotation, and by translation at a distance of one scene unit. */
static double deviation(const adcgs_camera *a, const adcgs_camera *b, double scale)
{
    double p[4], q[4], turn[3], moved = 0;
    adcgs_rotation_from_pose(a->cam_to_world, p);
    adcgs_rotation_from_pose(b->cam_to_world, q);
    adcgs_rotation_between(p, q, turn);
    for (int i = 0; i < 3; i++) {
        const double d = (a->cam_to_world[4 * i + 3] - b->cam_to_world[4 * i + 3]) / scale;
        moved += d * d;
    }
    return (2 * sqrt(adcgs_v3_dot(turn, turn)) + sqrt(moved)) * b->fx / b->width;
}

static void make_key(adcgs_camera_key *key, const adcgs_scene_view *view)
{
    *key = (adcgs_camera_key){.at = view->time, .frame = {.camera = view->camera, .time = view->time}};
    for (int i = 0; i < 12; i++)
        key->frame.camera.cam_to_world[i] = (double)(float)view->camera.cam_to_world[i];
}

/** Deviations of the spline through the keys: returns their mean; *worst: the view with the largest one, *most. */
static adcgs_status measure(const adcgs_filmed_path *path, const adcgs_scene_view *views, uint32_t n, double scale, double *mean,
                            double *most, uint32_t *worst, adcgs_error *error)
{
    adcgs_camera_spline spline;
    adcgs_camera_frame frame;
    *mean = *most = 0;
    ADCGS_TRY(adcgs_camera_spline_init(&spline, path->keys, path->n, 0, 0, error));
    for (uint32_t i = 0; i < n; i++) {
        adcgs_camera_spline_at(&spline, views[i].time, &frame);
        const double d = deviation(&frame.camera, &views[i].camera, scale);
        *mean += d / n;
        if (d > *most) {
            *most = d;
            *worst = i;
        }
    }
    adcgs_camera_spline_clear(&spline);
    return ADCGS_OK;
}

static void insert(adcgs_filmed_path *path, const adcgs_scene_view *view)
{
    int i = path->n++;
    for (; i > 0 && path->keys[i - 1].at > view->time; i--)
        path->keys[i] = path->keys[i - 1];
    make_key(&path->keys[i], view);
}

static int is_key(const adcgs_filmed_path *path, const adcgs_scene_view *view)
{
    for (int i = 0; i < path->n; i++)
        if (!(path->keys[i].at < view->time) && !(path->keys[i].at > view->time))
            return 1;
    return 0;
}

adcgs_status adcgs_filmed_path_make(adcgs_filmed_path *path, const adcgs_scene_view *views, uint32_t n, double scale,
                                    adcgs_error *error)
{
    const uint32_t most = ADCGS_MIN(KEYS_FEW + n / VIEWS_PER_KEY, KEYS_MOST);
    double mean = 0, error_most = 0;
    uint32_t worst = 0;
    *path = (adcgs_filmed_path){.n = 0};
    if (n < KEYS_LEAST)
        return ADCGS_OK;
    path->keys = adcgs_alloc(NULL, most, sizeof *path->keys, error);
    if (!path->keys)
        return adcgs_alloc_status(error);
    insert(path, &views[0]);
    insert(path, &views[n - 1]);
    for (;;) {
        const adcgs_status status = measure(path, views, n, scale, &mean, &error_most, &worst, error);
        if (status != ADCGS_OK) {
            adcgs_filmed_path_clear(path);
            return status;
        }
        if (error_most <= ERROR_AIM || path->n == (int)ADCGS_MIN(most, n) || is_key(path, &views[worst]))
            break;
        insert(path, &views[worst]);
    }
    if (mean > ERROR_MOST)
        adcgs_filmed_path_clear(path);
    return ADCGS_OK;
}

void adcgs_filmed_path_clear(adcgs_filmed_path *path)
{
    adcgs_free(NULL, path->keys);
    *path = (adcgs_filmed_path){.n = 0};
}

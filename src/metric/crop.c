/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Quality of a part of an image. */
#include "config.h"

#include "metric/crop.h"

#include "metric/metric.h"
#include "system/sort_values.h"

#include <math.h>
#include <stdlib.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define CORNERS 8  /* of a box; geometry */
#define FENCE 1.5  /* distances of the quartiles; literature: Tukey, 1977 */
#define GROWTH 1.1 /* factor of the box's edges */

/**
 * Tukey's fences: a point further from the quartiles than FENCE times their distance is an outlier. values: memory for all
 * points.
 */
static void find_fences(const adcgs_scene_points *points, double *values, adcgs_box *fences)
{
    for (int a = 0; a < 3; a++) {
        for (uint32_t i = 0; i < points->n; i++)
            values[i] = points->position[i][a];
        adcgs_sort(values, points->n);
        const double low = values[points->n / 4], high = values[points->n - 1 - points->n / 4];
        fences->low[a] = low - FENCE * (high - low);
        fences->high[a] = high + FENCE * (high - low);
    }
}

static int is_inside(const adcgs_box *box, const double position[3])
{
    int inside = 1;
    for (int a = 0; a < 3; a++)
        inside &= position[a] >= box->low[a] && position[a] <= box->high[a];
    return inside;
}

adcgs_status adcgs_box_of_points(adcgs_box *box, const adcgs_scene *scene, adcgs_error *error)
{
    const adcgs_scene_points *points = &scene->points;
    double *values = malloc(((size_t)points->n + 1) * sizeof *values);
    adcgs_box fences;
    uint32_t inside = 0;
    if (!values)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %u points", scene->directory, points->n);
    if (points->n)
        find_fences(points, values, &fences);
    free(values);
    *box = (adcgs_box){{HUGE_VAL, HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}};
    for (uint32_t i = 0; i < points->n; i++) {
        if (!is_inside(&fences, points->position[i]))
            continue;
        for (int a = 0; a < 3; a++) {
            box->low[a] = fmin(box->low[a], points->position[i][a]);
            box->high[a] = fmax(box->high[a], points->position[i][a]);
        }
        inside++;
    }
    if (!inside)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: the scene has no points to find a box from", scene->directory);
    for (int a = 0; a < 3; a++) {
        const double grow = 0.5 * (GROWTH - 1.0) * (box->high[a] - box->low[a]);
        box->low[a] -= grow;
        box->high[a] += grow;
    }
    return ADCGS_OK;
}

/** Corner i has the higher coordinate along each axis whose bit is set in i. In camera coordinates. */
static void find_corners(const adcgs_box *box, const adcgs_camera *camera, double corners[CORNERS][3])
{
    const double *m = camera->cam_to_world;
    for (int i = 0; i < CORNERS; i++)
        for (int a = 0; a < 3; a++) {
            corners[i][a] = 0.0;
            for (int b = 0; b < 3; b++)
                corners[i][a] += m[4 * b + a] * ((i & 1 << b ? box->high[b] : box->low[b]) - m[4 * b + 3]);
        }
}

/** Widen bounds (left, top, right, bottom) by the projection of a point in front of the camera. */
static void project(const adcgs_camera *camera, const double p[3], double bounds[4])
{
    const double x = camera->fx * p[0] / p[2] + camera->cx, y = camera->fy * p[1] / p[2] + camera->cy;
    bounds[0] = fmin(bounds[0], x);
    bounds[1] = fmin(bounds[1], y);
    bounds[2] = fmax(bounds[2], x);
    bounds[3] = fmax(bounds[3], y);
}

/** Widen bounds by the intersection of an edge of the box with the near plane, if there is one. */
static void project_cut(const adcgs_camera *camera, const double a[3], const double b[3], double bounds[4])
{
    const double near_plane = camera->near_plane;
    if ((a[2] < near_plane) == (b[2] < near_plane))
        return;
    const double t = (near_plane - a[2]) / (b[2] - a[2]);
    const double p[3] = {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), near_plane};
    project(camera, p, bounds);
}

int adcgs_box_rectangle(const adcgs_box *box, const adcgs_camera *camera, int rectangle[4])
{
    double corners[CORNERS][3], bounds[4] = {HUGE_VAL, HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    find_corners(box, camera, corners);
    for (int i = 0; i < CORNERS; i++) {
        if (corners[i][2] >= camera->near_plane)
            project(camera, corners[i], bounds);
        for (int axis = 1; axis < CORNERS; axis <<= 1)
            if (!(i & axis))
                project_cut(camera, corners[i], corners[i | axis], bounds);
    }
    if (!(bounds[0] < camera->width && bounds[1] < camera->height && bounds[2] > 0.0 && bounds[3] > 0.0))
        return 0;
    rectangle[0] = (int)fmax(0.0, floor(bounds[0]));
    rectangle[1] = (int)fmax(0.0, floor(bounds[1]));
    rectangle[2] = ADCGS_MAX(rectangle[0] + 1, (int)fmin(camera->width, ceil(bounds[2])));
    rectangle[3] = ADCGS_MAX(rectangle[1] + 1, (int)fmin(camera->height, ceil(bounds[3])));
    return 1;
}

/** Copy the rectangle out of a planar image. */
static void cut(const float *picture, int width, int height, const int rectangle[4], float *out)
{
    const size_t row = (size_t)(rectangle[2] - rectangle[0]);
    for (size_t c = 0; c < 3; c++)
        for (int y = rectangle[1]; y < rectangle[3]; y++, out += row)
            memcpy(out, picture + (c * (size_t)height + (size_t)y) * (size_t)width + rectangle[0], row * sizeof *out);
}

adcgs_status adcgs_crop_measure(adcgs_crop *out, const adcgs_box *box, const adcgs_view_score *score, adcgs_error *error)
{
    int *const r = out->rectangle;
    out->visible = adcgs_box_rectangle(box, score->seen, r);
    if (!out->visible)
        return ADCGS_OK;
    const int width = r[2] - r[0], height = r[3] - r[1];
    const size_t n = (size_t)width * (size_t)height * 3;
    float *decoded = malloc(n * sizeof *decoded), *truth = malloc(n * sizeof *truth);
    adcgs_status status = ADCGS_ERR_MEMORY;
    if (decoded && truth) {
        cut(score->decoded, score->width, score->height, r, decoded);
        cut(score->truth, score->width, score->height, r, truth);
        out->psnr = adcgs_psnr(decoded, truth, n);
        status = adcgs_ssim(decoded, truth, width, height, &out->ssim, error);
    } else {
        adcgs_fail(error, status, "out of memory for an image of %d x %d", width, height);
    }
    free(decoded);
    free(truth);
    return status;
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Splats as a scene: the cameras around them. */
#include "config.h"

#include "scene/layouts/splat_file.h"

#include "geometry/rotation.h"
#include "scene/splat_views.h"
#include "system/sort_values.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define OPACITY_MAX 0.99f              /* largest opacity of a primitive; definition of the bitstream */
#define OPACITY_LEAST (1.0f / 255.0f)  /* fainter splats are not rendered; definition of the bitstream */
#define POINT_OPACITY 0.1f             /* least opacity of a splat that becomes a point */
#define INSIDE 0.95                    /* share of the splats within the radius */
#define HALF_FIELD 0.4363323129985824  /* radians: 25 degrees, between the optical axis and the middle of an edge of the view */
#define SHELLS 2                       /* distances of cameras */
#define GOLDEN_ANGLE 2.399963229728653 /* radians, pi (3 - sqrt(5)); geometry */
#define RADIUS_MIN 1e-9                /* world units */
#define RADIUS_MAX 1e9                 /* world units */

/* Cameras for training, validation and testing; chosen by hand, not measured. */
static const uint32_t n_views[ADCGS_SPLITS] = {100, 10, 20};

/* ---- Region of the splats ---- */

/** Distance of a splat from the centre, plus its own size. */
static double reach(const adcgs_splats *s, uint32_t i, const double centre[3])
{
    double square = 0.0, size = 0.0;
    for (int a = 0; a < 3; a++) {
        square += pow((double)s->mean[a][i] - centre[a], 2);
        size = fmax(size, (double)s->scale[a][i]);
    }
    return sqrt(square) + size;
}

/** Uses medians, so that a few distant splats do not matter. values: [n], scratch. */
static adcgs_status find_region(adcgs_splat_scene *s, double *values, const char *path, adcgs_error *error)
{
    const adcgs_splats *splats = &s->splats;
    size_t n = 0;
    for (int a = 0; a < 3; a++) {
        n = 0;
        for (uint32_t i = 0; i < splats->n; i++)
            if (splats->opacity[i] >= OPACITY_LEAST)
                values[n++] = (double)splats->mean[a][i];
        if (!n)
            return adcgs_fail(error, ADCGS_ERR_DATA, "%s: no splat is visible: none has an opacity of at least 1/255", path);
        adcgs_sort(values, n);
        s->centre[a] = values[n / 2];
    }
    n = 0;
    for (uint32_t i = 0; i < splats->n; i++)
        if (splats->opacity[i] >= OPACITY_LEAST)
            values[n++] = reach(splats, i, s->centre);
    adcgs_sort(values, n);
    s->radius = values[(size_t)(INSIDE * (double)(n - 1))];
    if (!(s->radius >= RADIUS_MIN && s->radius <= RADIUS_MAX))
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: the splats lie within %g units, expected 1e-9 to 1e9", path, s->radius);
    return ADCGS_OK;
}

/** Converts world units to those of the region, and limits values to a primitive's range. */
static void normalise(adcgs_splat_scene *s)
{
    adcgs_splats *splats = &s->splats;
    for (uint32_t i = 0; i < splats->n; i++) {
        if (!splats->antialiased) /* else the limit applies in each view */
            splats->opacity[i] = fminf(splats->opacity[i], OPACITY_MAX);
        for (int a = 0; a < 3; a++) {
            splats->mean[a][i] = (float)(((double)splats->mean[a][i] - s->centre[a]) / s->radius);
            splats->scale[a][i] = (float)((double)splats->scale[a][i] / s->radius);
            if (!splats->degree)
                splats->colour[a][i] = fmaxf(splats->colour[a][i], 0.0f);
        }
    }
}

/* ---- Cameras ---- */

/**
 * Aims a camera at the centre from `distance` in the direction `out`. y points down in its image, or up if the splats' y axis
 * is up.
 */
static void aim(adcgs_camera *camera, const adcgs_splat_scene *s, const double out[3], double distance)
{
    const double up[3] = {0.0, s->splats.axes == ADCGS_SPLATS_Y_UP ? 1.0 : -1.0, 0.0}; /* never parallel to a viewing direction */
    double eye[3], forward[3];
    for (int i = 0; i < 3; i++) {
        eye[i] = s->centre[i] + distance * out[i];
        forward[i] = -out[i];
    }
    adcgs_look_along(camera->cam_to_world, eye, forward, up);
    camera->width = camera->height = ADCGS_SPLAT_SCENE_SIZE;
    camera->cx = camera->cy = 0.5 * ADCGS_SPLAT_SCENE_SIZE;
    camera->fx = camera->fy = 0.5 * ADCGS_SPLAT_SCENE_SIZE / tan(HALF_FIELD);
}

/** Places directions on a spiral of uniform density; each split's spiral is rotated against the others. */
static void spread(double out[3], uint32_t i, uint32_t n, int split)
{
    const double height = 1.0 - (2.0 * i + 1.0) / n, angle = GOLDEN_ANGLE * i + 2.0 * split;
    const double flat = sqrt(1.0 - height * height);
    out[0] = flat * cos(angle);
    out[1] = height;
    out[2] = flat * sin(angle);
}

static adcgs_status add_views(adcgs_scene *scene, int split, const char *path, adcgs_error *error)
{
    static const double shells[SHELLS] = {1.0, 0.7};
    const uint32_t n = n_views[split];
    scene->views[split] = calloc(n, sizeof *scene->views[split]);
    for (uint32_t i = 0; scene->views[split] && i < n; i++) {
        adcgs_scene_view *view = &scene->views[split][i];
        double out[3];
        spread(out, i, n, split);
        aim(&view->camera, scene->splats, out, shells[i % SHELLS] * scene->splats->radius / sin(HALF_FIELD));
        snprintf(view->camera.name, sizeof view->camera.name, "%s_%03u", adcgs_split_name((adcgs_split)split), i);
        view->path = strdup(path);
        if (!view->path)
            break;
        scene->n_views[split] = i + 1;
    }
    return scene->n_views[split] == n ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
}

/* ---- The scene ---- */

static uint8_t to_byte(float value)
{
    return (uint8_t)(fminf(fmaxf(value, 0.0f), 1.0f) * 255.0f + 0.5f);
}

/** Call it before normalise(), while points are in world units. */
static adcgs_status take_points(adcgs_points *out, const adcgs_splats *s, const char *path, adcgs_error *error)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < s->n; i++)
        n += s->opacity[i] >= POINT_OPACITY;
    ADCGS_TRY(adcgs_points_alloc(out, n, path, error));
    out->coloured = 1;
    n = 0;
    for (uint32_t i = 0; i < s->n; i++) {
        if (s->opacity[i] < POINT_OPACITY)
            continue;
        for (int a = 0; a < 3; a++) {
            out->position[n][a] = s->offset[a] + (double)s->mean[a][i];
            out->colour[n][a] = to_byte(s->colour[a][i]);
        }
        n++;
    }
    return ADCGS_OK;
}

adcgs_status adcgs_splat_scene_read(adcgs_scene *scene, int want_points, const char *path, adcgs_error *error)
{
    adcgs_splat_scene *s = scene->splats = calloc(1, sizeof *s);
    if (!s)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    ADCGS_TRY(adcgs_splats_read(&s->splats, path, error));
    double *values = malloc(s->splats.n * sizeof *values);
    const adcgs_status status =
        values ? find_region(s, values, path, error) : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    free(values);
    ADCGS_TRY(status);
    if (want_points)
        ADCGS_TRY(take_points(&scene->points, &s->splats, path, error));
    normalise(s);
    for (int a = 0; a < 3; a++) /* in world coordinates; the splats are relative to the offset */
        s->centre[a] += s->splats.offset[a];
    for (int split = 0; split < ADCGS_SPLITS; split++)
        ADCGS_TRY(add_views(scene, split, path, error));
    scene->axes = s->splats.axes;
    return ADCGS_OK;
}

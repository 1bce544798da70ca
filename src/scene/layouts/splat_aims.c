/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Directions from which splats look like their scene. */
#include "config.h"

#include "scene/layouts/splat_aims.h"

#include "geometry/rotation.h"
#include "scene/splat_detail.h"
#include "system/sort_values.h"

#include <math.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define HALF_FIELD 0.4363323129985824  /* radians: 25 degrees, between the optical axis and the middle of an edge of the view */
#define GOLDEN_ANGLE 2.399963229728653 /* radians, pi (3 - sqrt(5)); geometry */
#define SIZE 100                       /* pixels: width and height of the images that are judged */
#define SMALL 2.0                      /* pixels in them: standard deviation of a splat that counts as detail, at most */
/*
 * Share of the best direction's detail. Calibrated on seven files of splats: objects (biker, the sample of SpacetimeGaussians,
 * fireworks) have 0.8 to 0.94 at the lower quartile, rooms and landscapes (the demo, james, a sunflower field) 0.0 to 0.3.
 */
#define DETAIL_LEAST 0.5
#define OBJECT_LEAST 0.75 /* share of the directions with this detail: then all are used */
#define NEAR 0.01         /* near plane over the distance */

void adcgs_splat_aims_spread(double out[3], uint32_t i, uint32_t n, double angle)
{
    const double height = 1.0 - (2.0 * i + 1.0) / n, around = GOLDEN_ANGLE * i + angle;
    const double flat = sqrt(1.0 - height * height);
    out[0] = flat * cos(around);
    out[1] = height;
    out[2] = flat * sin(around);
}

void adcgs_splat_aims_camera(adcgs_camera *camera, const adcgs_splat_scene *s, const double out[3], double distance, int size)
{
    const double up[3] = {0.0, s->splats.axes == ADCGS_SPLATS_Y_UP ? 1.0 : -1.0, 0.0}; /* never parallel to a viewing direction */
    double eye[3], forward[3];
    for (int i = 0; i < 3; i++) {
        eye[i] = s->centre[i] + distance * out[i];
        forward[i] = -out[i];
    }
    adcgs_look_along(camera->cam_to_world, eye, forward, up);
    camera->width = camera->height = size;
    camera->cx = camera->cy = 0.5 * size;
    camera->fx = camera->fy = 0.5 * size / tan(HALF_FIELD);
}

double adcgs_splat_aims_distance(const adcgs_splat_scene *s)
{
    return s->radius / sin(HALF_FIELD);
}

static adcgs_status judge(double *detail, adcgs_splat_aims *aims, const adcgs_splat_scene *s, const adcgs_splats *splats,
                          adcgs_error *error)
{
    const double distance = adcgs_splat_aims_distance(s);
    for (uint32_t i = 0; i < ADCGS_SPLAT_AIMS; i++) {
        adcgs_camera camera = {.near_plane = NEAR * distance};
        adcgs_splat_aims_spread(aims->out[i], i, ADCGS_SPLAT_AIMS, 0.0);
        adcgs_splat_aims_camera(&camera, s, aims->out[i], distance, SIZE);
        ADCGS_TRY(adcgs_splat_detail(&detail[i], s, splats, &camera, SMALL, error));
    }
    return ADCGS_OK;
}

adcgs_status adcgs_splat_aims_find(adcgs_splat_aims *aims, int *is_object, const adcgs_splat_scene *s, const adcgs_splats *splats,
                                   const char *path, adcgs_error *error)
{
    double detail[ADCGS_SPLAT_AIMS], sorted[ADCGS_SPLAT_AIMS];
    adcgs_splats copy;
    ADCGS_TRY(adcgs_splats_copy(&copy, splats, path, error));
    adcgs_splat_scene_normalise(s, &copy);
    const adcgs_status status = judge(detail, aims, s, &copy, error);
    adcgs_splats_free(&copy);
    ADCGS_TRY(status);
    memcpy(sorted, detail, sizeof sorted);
    adcgs_sort(sorted, ADCGS_SPLAT_AIMS);
    const double least = DETAIL_LEAST * sorted[ADCGS_SPLAT_AIMS - 1];
    aims->n = 0;
    for (uint32_t i = 0; i < ADCGS_SPLAT_AIMS; i++)
        if (detail[i] >= least)
            memmove(aims->out[aims->n++], aims->out[i], sizeof aims->out[i]);
    *is_object = aims->n >= OBJECT_LEAST * ADCGS_SPLAT_AIMS;
    return ADCGS_OK;
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The share of an image that small splats cover. */
#include "config.h"

#include "scene/splat_detail.h"

#include "base/cpu_detect.h"
#include "render/render.h"

#include <math.h>
#include <stdlib.h>

#define DEPTH_LEAST 1e-6 /* units of the radius, in front of the camera; chosen by hand, not measured */

/** Marks splats: 1 in the first channel for small ones, 1 in the second for all. */
static void mark(float *colours, size_t slots, const adcgs_splat_scene *s, const adcgs_splats *splats, const adcgs_camera *camera,
                 double most)
{
    const double *const m = camera->cam_to_world;
    for (uint32_t i = 0; i < splats->n; i++) {
        double depth = 0.0, size = 0.0;
        for (int a = 0; a < 3; a++) {
            depth += ((double)splats->mean[a][i] - (m[4 * a + 3] - s->centre[a]) / s->radius) * m[4 * a + 2];
            size = fmax(size, (double)splats->scale[a][i]);
        }
        colours[i] = depth > DEPTH_LEAST && size * camera->fx <= most * depth ? 1.0f : 0.0f;
        colours[slots + i] = 1.0f;
    }
}

adcgs_status adcgs_splat_detail(double *share, const adcgs_splat_scene *s, const adcgs_splats *splats, const adcgs_camera *camera,
                                double most, adcgs_error *error)
{
    static const float black[3] = {0.0f, 0.0f, 0.0f};
    const size_t plane = (size_t)camera->width * (size_t)camera->height, slots = ((size_t)splats->n + 63) / 64 * 64;
    adcgs_primitives primitives;
    adcgs_raster *raster = NULL;
    adcgs_cpu_level cpu;
    adcgs_view view;
    float *const colours = adcgs_alloc(NULL, 3 * slots, sizeof *colours, error);
    float *const image = adcgs_alloc(NULL, 3 * plane, sizeof *image, error);
    adcgs_status status = colours && image ? adcgs_cpu_resolve(ADCGS_CPU_AUTO, &cpu, error) : adcgs_alloc_status(error);
    *share = 0.0;
    if (status == ADCGS_OK)
        status = adcgs_view_init(&view, camera, s->centre, s->radius, error);
    if (status == ADCGS_OK)
        status = adcgs_raster_create(&raster, cpu, NULL, NULL, error);
    if (status == ADCGS_OK) {
        adcgs_splats_primitives(splats, &primitives);
        mark(colours, slots, s, splats, camera, most);
        for (size_t c = 0; c < 3; c++)
            primitives.colour[c] = colours + c * slots;
        status = adcgs_raster_forward(raster, &primitives, &view, black, ADCGS_SCREEN_FILTER, image, 0, error);
    }
    double small = 0.0, all = 0.0;
    for (size_t i = 0; status == ADCGS_OK && i < plane; i++) {
        small += (double)image[i];
        all += (double)image[plane + i];
    }
    if (all > 0.0)
        *share = small / all;
    adcgs_raster_free(&raster);
    adcgs_free(NULL, colours);
    adcgs_free(NULL, image);
    return status;
}

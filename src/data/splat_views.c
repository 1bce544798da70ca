/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Splats as a scene: what its cameras see. */
#include "config.h"

#include "data/splat_views.h"

#include "base/cpu.h"
#include "io/harmonics.h"
#include "render/render.h"

#include <math.h>
#include <stdlib.h>

void adcgs_splat_scene_free(adcgs_splat_scene **splats)
{
    if (*splats)
        adcgs_splats_free(&(*splats)->splats);
    free(*splats);
    *splats = NULL;
}

/** Colours as a camera sees them: [3][slots]. */
static void look(float *colours, size_t slots, const adcgs_splat_scene *s, const adcgs_camera *camera)
{
    const adcgs_splats *splats = &s->splats;
    const size_t n = (size_t)(splats->degree + 1) * (size_t)(splats->degree + 1) - 1;
    for (uint32_t i = 0; i < splats->n; i++) {
        const float *rest = splats->harmonics + i * 3 * n;
        double d[3], harmonics[ADCGS_HARMONICS_MAX];
        for (int a = 0; a < 3; a++)
            d[a] = (double)splats->mean[a][i] - (camera->cam_to_world[4 * a + 3] - s->centre[a]) / s->radius;
        const double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        for (int a = 0; a < 3; a++)
            d[a] = length > 0.0 ? d[a] / length : 0.0;
        adcgs_harmonics(harmonics, d, splats->degree);
        for (size_t c = 0; c < 3; c++) {
            double value = (double)splats->colour[c][i];
            for (size_t k = 0; k < n; k++)
                value += harmonics[k] * (double)rest[c * n + k];
            colours[c * slots + i] = (float)fmax(value, 0.0);
        }
    }
}

static adcgs_status draw(float *rgb, const adcgs_splat_scene *s, const float background[3], const adcgs_camera *camera,
                         const float *colours, adcgs_error *error)
{
    adcgs_cpu_level cpu;
    adcgs_raster *raster = NULL;
    adcgs_primitives primitives;
    adcgs_view view;
    adcgs_splats_primitives(&s->splats, &primitives);
    for (size_t c = 0; c < 3 && colours; c++)
        primitives.colour[c] = colours + c * primitives.n;
    ADCGS_TRY(adcgs_cpu_resolve(ADCGS_CPU_AUTO, &cpu, error)); /* the picture does not depend on it */
    ADCGS_TRY(adcgs_view_init(&view, camera, s->centre, s->radius, error));
    ADCGS_TRY(adcgs_raster_create(&raster, cpu, NULL, NULL, error));
    const adcgs_status status =
        adcgs_raster_forward(raster, &primitives, &view, background, ADCGS_SCREEN_FILTER, rgb, 0, error);
    adcgs_raster_free(&raster);
    return status;
}

adcgs_status adcgs_splat_scene_render(const adcgs_splat_scene *splats, const float background[3], const adcgs_camera *camera,
                                      adcgs_image *out, const char *path, adcgs_error *error)
{
    const size_t plane = (size_t)camera->width * (size_t)camera->height, slots = ((size_t)splats->splats.n + 63) / 64 * 64;
    float *colours = splats->splats.degree ? aligned_alloc(64, 3 * slots * sizeof *colours) : NULL;
    float *planar = malloc(3 * plane * sizeof *planar);
    adcgs_status status = planar && (colours || !splats->splats.degree)
                              ? adcgs_image_alloc(out, camera->width, camera->height, 3, path, error)
                              : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for a view", path);
    if (status == ADCGS_OK) {
        if (colours) {
            memset(colours, 0, 3 * slots * sizeof *colours);
            look(colours, slots, splats, camera);
        }
        status = draw(planar, splats, background, camera, colours, error);
        for (size_t i = 0; i < 3 * plane && status == ADCGS_OK; i++)
            out->data[i] = fminf(fmaxf(planar[i % 3 * plane + i / 3], 0.0f), 1.0f);
        if (status != ADCGS_OK) {
            adcgs_error_locate(error, path);
            adcgs_image_free(out);
        }
    }
    free(planar);
    free(colours);
    return status;
}

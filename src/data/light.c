/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Light that steps, evened out. */
#include "config.h"

#include "data/light.h"

enum { SIDE = 2 * ADCGS_GLANCE_SIDE }; /* of pictures at a glance: each cell has some pixels */

/** As few pixels as will do. */
static int divide_for(const adcgs_scene *scene)
{
    int side = 0;
    for (uint32_t i = 0; i < scene->n_views[ADCGS_SPLIT_TRAIN]; i++) {
        const adcgs_camera *const camera = &scene->views[ADCGS_SPLIT_TRAIN][i].camera;
        const int shorter = ADCGS_MIN(camera->width, camera->height);
        side = side ? ADCGS_MIN(side, shorter) : shorter;
    }
    return ADCGS_MAX(side / SIDE, 1);
}

static adcgs_status take_glances(adcgs_glance *glances, const adcgs_scene *scene, const adcgs_pictures_config *config,
                                 adcgs_pool *pool, adcgs_error *error)
{
    adcgs_pictures *pictures;
    adcgs_pictures_config small = *config;
    small.split = ADCGS_SPLIT_TRAIN;
    small.divide = divide_for(scene);
    small.glances = glances;
    const adcgs_status status = adcgs_pictures_load(&pictures, scene, &small, pool, error);
    adcgs_pictures_free(&pictures);
    return status;
}

adcgs_status adcgs_light_even(adcgs_scene *scene, adcgs_fault *found, const adcgs_pictures_config *config, adcgs_pool *pool,
                              adcgs_error *error)
{
    adcgs_scene_view *const views = scene->views[ADCGS_SPLIT_TRAIN];
    const uint32_t n = scene->n_views[ADCGS_SPLIT_TRAIN];
    adcgs_tracks tracks;
    *found = (adcgs_fault){.cameras = 0};
    for (uint32_t i = 0; i < n; i++)
        memset(views[i].stops, 0, sizeof views[i].stops);
    adcgs_glance *const glances = adcgs_alloc(NULL, n, sizeof *glances, error);
    if (!glances)
        return adcgs_alloc_status(error);
    adcgs_status status = take_glances(glances, scene, config, pool, error);
    if (status == ADCGS_OK)
        status = adcgs_tracks_find(&tracks, views, n, error);
    if (status == ADCGS_OK) {
        status = adcgs_fault_light(found, views, &tracks, glances, error);
        if (status == ADCGS_OK && found->cameras)
            status = adcgs_fault_light_even(views, &tracks, glances, error);
        adcgs_tracks_clear(&tracks);
    }
    adcgs_free(NULL, glances);
    return status;
}

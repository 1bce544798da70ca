/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Estimate of the storage that the images of a split need. */
#include "config.h"

#include "scene/image_store.h"
#include "scene/spool.h"

#include <stdlib.h>

/** Number of values of an image. */
static uint64_t values_of(const adcgs_scene_view *view, int divide)
{
    const uint64_t width = (uint64_t)((view->camera.width + divide - 1) / divide);
    return 3 * width * (uint64_t)((view->camera.height + divide - 1) / divide);
}

uint64_t adcgs_image_store_least(const adcgs_scene *scene, adcgs_split split, int divide)
{
    uint64_t bytes = 0;
    for (uint32_t i = 0; i < scene->n_views[split]; i++) {
        const adcgs_scene_view *const v = &scene->views[split][i];
        const int computed = divide > 1 || v->is_video || v->lens.width > 0 || scene->has_alpha || scene->splats;
        bytes += values_of(v, divide) * (computed ? 2 : 1);
    }
    return bytes;
}

/** Raises *bytes to the bytes per value of a view, found by loading the view alone. */
static adcgs_status sample(const adcgs_scene *scene, const adcgs_image_store_config *config, uint32_t view, uint64_t *bytes,
                           adcgs_error *error)
{
    adcgs_image_store *one;
    adcgs_scene part = *scene;
    adcgs_image_store_config alone = *config;
    uint64_t memory, file;
    part.views[config->split] += view;
    part.n_views[config->split] = 1;
    alone.memory = UINT64_MAX;
    alone.progress = NULL;
    alone.thumbnails = NULL;
    ADCGS_TRY(adcgs_image_store_load(&one, &part, &alone, NULL, error));
    adcgs_image_store_size(one, &memory, &file);
    adcgs_image_store_free(&one);
    *bytes = ADCGS_MAX(*bytes, memory / values_of(&part.views[config->split][0], config->divide));
    return ADCGS_OK;
}

adcgs_status adcgs_image_store_estimate(adcgs_image_store_need *need, const adcgs_scene *scene,
                                        const adcgs_image_store_config *config, adcgs_error *error)
{
    const adcgs_scene_view *views = scene->views[config->split];
    const uint32_t n = scene->n_views[config->split];
    const uint64_t budget = config->memory ? config->memory : adcgs_image_store_default_memory();
    uint64_t values = 0, bytes = 1;
    *need = (adcgs_image_store_need){.n = n};
    for (uint32_t i = 0; i < n; i++)
        values += values_of(&views[i], config->divide);
    if (values * sizeof(float) <= budget) {
        need->bytes = need->memory = values * sizeof(float);
        return ADCGS_OK;
    }
    ADCGS_TRY(sample(scene, config, 0, &bytes, error));
    if (!views[n - 1].is_video) /* reading the last frame of a video means decoding it all */
        ADCGS_TRY(sample(scene, config, n - 1, &bytes, error));
    need->bytes = values * bytes;
    char *const folder = adcgs_spool_folder();
    if (!folder)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for images");
    need->room = adcgs_spool_room(folder, &need->problem);
    free(folder);
    uint64_t left[2] = {budget, need->room}, *const used[2] = {&need->memory, &need->file};
    for (uint32_t i = 0; i < n; i++) {
        const uint64_t size = bytes * values_of(&views[i], config->divide);
        const int place = size <= left[0] ? 0 : size <= left[1] ? 1 : 2;
        need->again += place == 2;
        if (place < 2) {
            left[place] -= size;
            *used[place] += size;
        }
    }
    return ADCGS_OK;
}

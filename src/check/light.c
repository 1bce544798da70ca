/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Compensation of light steps. */
#include "config.h"

#include "check/light.h"

#include "check/check_footage.h"

#include <math.h>

static void add_up_track(adcgs_scene_view *views, const uint8_t *behind, const uint32_t *order, uint32_t n,
                         const adcgs_thumbnail *thumbnails)
{
    double stops[3] = {0.0, 0.0, 0.0};
    for (uint32_t i = 0; i < n; i++) {
        double gains[3] = {0.0, 0.0, 0.0};
        if (behind[order[i]])
            adcgs_thumbnail_gains(&thumbnails[order[i - 1]], &thumbnails[order[i]], gains);
        for (int c = 0; c < 3; c++) {
            stops[c] += isnan(gains[c]) ? 0.0 : gains[c] / log(2.0);
            views[order[i]].stops[c] = (float)stops[c];
        }
    }
}

void adcgs_light_add_up(adcgs_scene_view *views, const uint8_t *behind, const adcgs_camera_order *tracks,
                        const adcgs_thumbnail *thumbnails)
{
    for (uint32_t c = 0; c < tracks->n; c++)
        add_up_track(views, behind, tracks->order + tracks->begin[c], tracks->begin[c + 1] - tracks->begin[c], thumbnails);
}

adcgs_status adcgs_light_compensate(adcgs_scene *scene, adcgs_fault *found, const adcgs_image_store_config *config,
                                    adcgs_pool *pool, adcgs_error *error)
{
    adcgs_scene_view *const views = scene->views[ADCGS_SPLIT_TRAIN];
    const uint32_t n = scene->n_views[ADCGS_SPLIT_TRAIN];
    adcgs_camera_order tracks;
    *found = (adcgs_fault){.cameras = 0};
    for (uint32_t i = 0; i < n; i++)
        memset(views[i].stops, 0, sizeof views[i].stops);
    adcgs_thumbnail *const thumbnails = adcgs_alloc(NULL, n, sizeof *thumbnails, error);
    uint8_t *const behind = adcgs_alloc(NULL, n, sizeof *behind, error);
    adcgs_status status =
        thumbnails && behind ? adcgs_thumbnails_load(thumbnails, scene, config, pool, error) : adcgs_alloc_status(error);
    if (status == ADCGS_OK)
        status = adcgs_camera_order_find(&tracks, views, n, error);
    if (status == ADCGS_OK) {
        status = adcgs_fault_light(found, behind, views, &tracks, thumbnails, error);
        adcgs_light_add_up(views, behind, &tracks, thumbnails);
        adcgs_camera_order_clear(&tracks);
    }
    adcgs_free(NULL, behind);
    adcgs_free(NULL, thumbnails);
    return status;
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Details of a scene. */
#include "train/anchor_plan.h"

#include "metric/detail.h"

#include <stdlib.h>

enum { PICTURES_MOST = 16 }; /* maximum number of images for the details; chosen by hand, not measured */

adcgs_status adcgs_plan_details(const adcgs_scene *scene, int divide, uint32_t *details, adcgs_error *error)
{
    const uint32_t all = scene->n_views[ADCGS_SPLIT_TRAIN], n = ADCGS_MIN(all, PICTURES_MOST);
    uint64_t sum = 0;
    for (uint32_t i = 0; i < n; i++) {
        const adcgs_scene_view *const view = &scene->views[ADCGS_SPLIT_TRAIN][(2 * (uint64_t)i + 1) * all / (2 * (uint64_t)n)];
        adcgs_camera camera;
        float *rgb;
        uint32_t here;
        ADCGS_TRY(adcgs_scene_image(scene, view, divide, &rgb, &camera, error));
        const adcgs_status status = adcgs_detail(rgb, (int)camera.width, (int)camera.height, &here, error);
        free(rgb);
        ADCGS_TRY(status);
        sum += here;
    }
    *details = (uint32_t)(sum / n);
    return ADCGS_OK;
}

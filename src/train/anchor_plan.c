/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Maximum number of anchors of a scene. */
#include "train/anchor_plan.h"

#include "metric/detail.h"

#include <math.h>
#include <stdlib.h>

/* Origin: chosen by hand, not measured. The rule between them is calibrated (doc/log/anchors.md, "Grid of anchor numbers"). */
enum {
    PICTURES_MOST = 16, /* maximum number of images for the details */
    ANCHORS_LEAST = 100 /* minimum of max_anchors */
};

adcgs_status adcgs_plan_details(const adcgs_scene *scene, int divide, uint32_t *details, adcgs_error *error)
{
    const uint32_t all = scene->n_views[ADCGS_SPLIT_TRAIN], n = ADCGS_MIN(all, PICTURES_MOST);
    uint64_t sum = 0;
    for (uint32_t i = 0; i < n; i++) {
        const adcgs_scene_view *const view = &scene->views[ADCGS_SPLIT_TRAIN][(2 * (uint64_t)i + 1) * all / (2 * (uint64_t)n)];
        adcgs_camera camera;
        float *rgb;
        uint32_t here;
        ADCGS_TRY(adcgs_scene_load(scene, view, divide, &rgb, &camera, error));
        const adcgs_status status = adcgs_detail(rgb, (int)camera.width, (int)camera.height, &here, error);
        free(rgb);
        ADCGS_TRY(status);
        sum += here;
    }
    *details = (uint32_t)(sum / n);
    return ADCGS_OK;
}

adcgs_status adcgs_plan_anchors(adcgs_train_config *c, const adcgs_scene *scene, uint32_t *details, adcgs_error *error)
{
    *details = 0;
    if (c->own_anchors || !(c->detail_anchors > 0))
        return ADCGS_OK;
    *details = c->details;
    if (!c->has_details)
        ADCGS_TRY(adcgs_plan_details(scene->whole ? scene->whole : scene, c->scale, details, error));
    c->max_anchors = (uint32_t)fmin(fmax((double)c->detail_anchors * sqrt(*details), ANCHORS_LEAST), ADCGS_ANCHORS_MAX);
    c->start_anchors = ADCGS_MIN(c->start_anchors, c->max_anchors);
    return ADCGS_OK;
}

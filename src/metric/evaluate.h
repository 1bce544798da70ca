/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Quality of a decoded stream against a scene's pictures: every view of a
 * split is rendered, rounded to 8 bits as a player would, and compared.
 */
#ifndef ADCGS_METRIC_EVALUATE_H
#define ADCGS_METRIC_EVALUATE_H

#include "data/scene.h"

#include <adcgs/decoder.h>

/** One view's result. Pictures are planar [3][height][width] and last only during the call. */
typedef struct adcgs_view_score {
    const adcgs_scene_view *view;
    double psnr, ssim;
    double seconds;                /**< to render the frame */
    int width, height;
    const float *decoded, *truth;
} adcgs_view_score;

typedef adcgs_status (*adcgs_score_fn)(void *user, const adcgs_view_score *score, adcgs_error *error);

/** Means over the views, and the median speed. */
typedef struct adcgs_evaluation {
    uint32_t n;
    double psnr, ssim;
    double frames_per_second; /**< of rendering alone: 1 / median seconds */
} adcgs_evaluation;

/** each may be NULL. ADCGS_ERR_DATA if the split is empty. */
adcgs_status adcgs_evaluate(adcgs_evaluation *out, adcgs_decoder *decoder, const adcgs_scene *scene, adcgs_split split,
                            adcgs_score_fn each, void *user, adcgs_error *error);

#endif

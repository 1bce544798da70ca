/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Quality of a decoded stream against a scene's pictures: every view of a
 * split is rendered, rounded to 8 bits as a player would, and compared.
 */
#ifndef ADCGS_METRIC_EVALUATE_H
#define ADCGS_METRIC_EVALUATE_H

#include "data/scene.h"
#include "metric/temporal.h"

#include <adcgs/types.h>

/** What to measure besides PSNR and SSIM; flags. */
enum {
    ADCGS_MEASURE_MS_SSIM = 1,
    ADCGS_MEASURE_DYNAMIC = 2, /**< PSNR of what moves; those of TIME want two passes over the truth of fixed cameras */
    ADCGS_MEASURE_STATIC = 4,  /**< variance over time of what does not */
    ADCGS_MEASURE_FLICKER = 8,
    ADCGS_MEASURE_FITTED = 16, /**< PSNR after gain and black level were fitted */
    ADCGS_MEASURE_FITTED_DYNAMIC = 32, /**< of what moves, after they were fitted to the whole picture */
    ADCGS_MEASURE_MOVING = ADCGS_MEASURE_DYNAMIC | ADCGS_MEASURE_FITTED_DYNAMIC,
    ADCGS_MEASURE_TIME = ADCGS_MEASURE_MOVING | ADCGS_MEASURE_STATIC | ADCGS_MEASURE_FLICKER,
    ADCGS_MEASURE_ALL = ADCGS_MEASURE_MS_SSIM | ADCGS_MEASURE_FITTED | ADCGS_MEASURE_TIME
};

/** One view's result. Pictures are planar [3][height][width] and last only during the call. */
typedef struct adcgs_view_score {
    const adcgs_scene_view *view;
    uint32_t camera;                        /**< from 0 in the order of the views; equal pose and lens are one camera */
    double psnr, ssim;
    double fitted_psnr, fitted_dynamic_psnr; /**< as the next */
    double ms_ssim;                         /**< not a number where it is not measured, as all of the next */
    int ms_ssim_scales;                     /**< 0 then */
    adcgs_temporal_view temporal;           /**< of cameras with more than one view; where what moves is known, so is its PSNR */
    double known_share;                     /**< of the picture, that moves as is known; not a number where it is not */
    const adcgs_temporal_total *of_camera;  /**< with the last view of such a camera, else NULL */
    double seconds;                         /**< to render the frame */
    int width, height;
    const adcgs_camera *seen;               /**< the view's, of this size; lasts as the pictures do */
    const float *decoded, *truth;
} adcgs_view_score;

typedef adcgs_status (*adcgs_score_fn)(void *user, const adcgs_view_score *score, adcgs_error *error);

/** Means over the views, and the median speed. */
typedef struct adcgs_evaluation {
    uint32_t n;
    double psnr, ssim;
    double frames_per_second; /**< of rendering alone: 1 / median seconds */
} adcgs_evaluation;

/**
 * Views come camera by camera, each in ascending time. measure: flags from above. each may be NULL.
 * Pictures are those of the scene, reduced as its `measured` says. ADCGS_ERR_DATA if the split is empty.
 */
adcgs_status adcgs_evaluate(adcgs_evaluation *out, adcgs_decoder *decoder, const adcgs_scene *scene, adcgs_split split,
                            int measure, adcgs_score_fn each, void *user, adcgs_error *error);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Quality of a decoded stream against a scene's images: every view of a split
 * is rendered, rounded to 8 bits as in a player, and compared.
 */
#ifndef ADCGS_METRIC_EVALUATE_H
#define ADCGS_METRIC_EVALUATE_H

#include "metric/temporal.h"
#include "scene/scene.h"

#include <adcgs/types.h>

/** Measures in addition to PSNR and SSIM; flags, powers of two by definition. */
enum {
    ADCGS_MEASURE_MS_SSIM = 1,
    ADCGS_MEASURE_DYNAMIC = 2, /**< PSNR of moving regions; the flags of TIME need two passes over the true images of static
                                    cameras */
    ADCGS_MEASURE_STATIC = 4,  /**< variance over time of static regions */
    ADCGS_MEASURE_FLICKER = 8,
    ADCGS_MEASURE_FITTED = 16,         /**< PSNR after fitting gain and black level */
    ADCGS_MEASURE_FITTED_DYNAMIC = 32, /**< the same of moving regions, fitted to the whole image */
    ADCGS_MEASURE_MOVING = ADCGS_MEASURE_DYNAMIC | ADCGS_MEASURE_FITTED_DYNAMIC,
    ADCGS_MEASURE_TIME = ADCGS_MEASURE_MOVING | ADCGS_MEASURE_STATIC | ADCGS_MEASURE_FLICKER,
    ADCGS_MEASURE_ALL = ADCGS_MEASURE_MS_SSIM | ADCGS_MEASURE_FITTED | ADCGS_MEASURE_TIME
};

/** One view's result. Images are planar [3][height][width] and valid only during the call. */
typedef struct adcgs_view_score {
    const adcgs_scene_view *view;
    uint32_t camera; /**< from 0 in order of the views; equal pose and lens are one camera */
    double psnr, ssim;
    double fitted_psnr, fitted_dynamic_psnr; /**< NaN if not measured */
    double ms_ssim;                          /**< NaN if not measured, as the members below */
    int ms_ssim_scales;                      /**< 0 if not measured */
    adcgs_temporal_view temporal;            /**< for cameras with several views; with a mask of moving pixels, dynamic_psnr is
                                                 that of the mask */
    double known_share;                      /**< share of pixels in the mask of moving pixels; NaN without a mask */
    const adcgs_temporal_total *of_camera;   /**< with the last view of a camera with several views, else NULL */
    double seconds;                          /**< to render the frame */
    int width, height;
    const adcgs_camera *seen; /**< the view's camera, at this size; valid as long as the images */
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
 * Views come camera by camera, each in ascending time. measure: flags from above. each may be NULL. Images are those of the
 * scene, reduced as its `measured` says. ADCGS_ERR_DATA if the split is empty.
 */
adcgs_status adcgs_evaluate(adcgs_evaluation *out, adcgs_decoder *decoder, const adcgs_scene *scene, adcgs_split split,
                            int measure, adcgs_score_fn each, void *user, adcgs_error *error);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Brightness of cameras. Cameras filmed together seldom agree on it, by tens of percent in some sets, and a model told to match
 * them all puts haze before those that are dark. Nor do photographs of something that stands still, taken one by one. So each
 * camera that takes several pictures, and each picture of a still scene, has a gain per channel, which follows the least squares
 * fit of pictures drawn to pictures taken, and the model is trained on pictures divided by it, so that it shows the mean camera.
 * Black levels are known before, and taken off first.
 * Cameras that agree within 3 % are taken as they are. Gains are of training alone, no stream holds them. Known as gain
 * compensation (Brown and Lowe 2007, Automatic panoramic image stitching using invariant features, IJCV).
 */
#ifndef ADCGS_TRAIN_EXPOSURE_H
#define ADCGS_TRAIN_EXPOSURE_H

#include "data/scene.h"

/** Of drawn * taken and of drawn^2, by channel. */
typedef struct adcgs_exposure_sums {
    double cross[3], square[3];
} adcgs_exposure_sums;

typedef struct adcgs_exposure_camera {
    double cross[3], square[3]; /* such sums; recent pictures count more */
    float gain[3];              /* (taken - black) / drawn */
    float black[3];             /* added to all it takes, relative to the middle camera; see black_level.h */
} adcgs_exposure_camera;

/** Zero-initialise before use. */
typedef struct adcgs_exposure {
    uint32_t n;                     /**< cameras; 0: brightness is taken as it is */
    uint32_t *of;                   /**< [views] camera of each view */
    adcgs_exposure_camera *cameras; /**< [n] */
    int patient;                    /**< the mean says nothing until each has taken a picture: they are many */
    float limit;                    /**< of a gain's logarithm, either way, about the mean: from the images alone */
} adcgs_exposure;

/**
 * Sort views by camera, equal in pose and lens. Where a camera has less than four pictures in the mean, n stays 0, unless the
 * scene is still: then a gain takes nothing from what changes over time.
 */
adcgs_status adcgs_exposure_create(adcgs_exposure *exposure, const adcgs_scene_view *views, uint32_t n_views, int still,
                                   adcgs_error *error);
void adcgs_exposure_clear(adcgs_exposure *exposure);
/** The sums of a view's picture as drawn and as taken, [3][plane] both. */
void adcgs_exposure_sum(const adcgs_exposure *exposure, uint32_t view, const float *drawn, const float *taken, size_t plane,
                        adcgs_exposure_sums *sums);
/** Take note of such sums: the gain of the view's camera is another then. */
void adcgs_exposure_follow(adcgs_exposure *exposure, uint32_t view, const adcgs_exposure_sums *sums);
/**
 * Bound gains by the images: no gain is further from the mean than the brightest or the darkest camera is from the median one.
 * brightness: [n] mean value of each camera's images; sorted here. Values that are not > 0 do not count.
 */
void adcgs_exposure_bound(adcgs_exposure *exposure, double *brightness);
/**
 * A burnt pixel is a lower bound: where more is rendered, the target follows the rendered value. drawn, target: as the mean
 * camera would have them, [3][plane]. background: that of images with alpha, which are not burnt where they have its colour;
 * else NULL.
 */
void adcgs_exposure_allow_burnt(const adcgs_exposure *exposure, uint32_t view, const float *drawn, const float background[3],
                                float *target, size_t plane);
/** out: the picture taken, as the mean camera would have. All [3][plane]. */
void adcgs_exposure_even(const adcgs_exposure *exposure, uint32_t view, const float *taken, float *out, size_t plane);

#endif

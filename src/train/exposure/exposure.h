/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Exposure of cameras. Cameras recorded together seldom agree in brightness; some data sets differ by tens of percent. Nor do
 * photographs of a static scene, taken one by one. A model that must match them all puts haze in front of the darker ones. So
 * each camera with several images, and each image of a static scene, has a gain per channel. It follows the least-squares fit of
 * rendered to recorded images. The recorded images are divided by it, so that the model shows the mean camera. Black levels are
 * known before and are subtracted first.
 * Cameras that agree within 3 % are used unchanged. Gains belong to training and are not part of a stream. Known as gain
 * compensation (Brown and Lowe 2007, Automatic panoramic image stitching using invariant features, IJCV).
 */
#ifndef ADCGS_TRAIN_EXPOSURE_EXPOSURE_H
#define ADCGS_TRAIN_EXPOSURE_EXPOSURE_H

#include "scene/scene.h"
#include "train/state/visit.h"

/** Sums of drawn * taken and of drawn^2, per channel. */
typedef struct adcgs_exposure_sums {
    double cross[3], square[3];
} adcgs_exposure_sums;

typedef struct adcgs_exposure_camera {
    double cross[3], square[3]; /* decaying sums; recent images count more */
    float gain[3];              /* (taken - black) / drawn */
    float black[3];             /* offset of the camera relative to the median camera; see black_level.h */
} adcgs_exposure_camera;

/** Zero-initialise before use. */
typedef struct adcgs_exposure {
    uint32_t n;                     /**< cameras; 0: brightness is used unchanged */
    uint32_t *of;                   /**< [views] camera of each view */
    adcgs_exposure_camera *cameras; /**< [n] */
    int patient;                    /**< 1: many cameras; the mean is valid once each has had an image */
    float limit;                    /**< bound of |log gain| about the mean, from the images alone */
} adcgs_exposure;

/**
 * Groups views by camera, equal in pose and lens. If cameras have fewer than four images on average, n stays 0, except for a
 * static scene, in which a gain cannot absorb changes over time.
 */
adcgs_status adcgs_exposure_create(adcgs_exposure *exposure, const adcgs_scene_view *views, uint32_t n_views, int still,
                                   adcgs_error *error);
void adcgs_exposure_clear(adcgs_exposure *exposure);
/** Stores or restores the gains. The number of cameras follows from the scene. */
void adcgs_exposure_walk(adcgs_checkpoint_walk *walk, adcgs_exposure *exposure);
/** Computes the sums of a view's rendered and recorded images, both [3][plane]. */
void adcgs_exposure_sum(const adcgs_exposure *exposure, uint32_t view, const float *drawn, const float *taken, size_t plane,
                        adcgs_exposure_sums *sums);
/** Adds such sums, and updates the gain of the view's camera. */
void adcgs_exposure_follow(adcgs_exposure *exposure, uint32_t view, const adcgs_exposure_sums *sums);
/**
 * Bounds gains by the images: no gain is farther from the mean than the brightest or the darkest camera is from the median one.
 * brightness: [n] mean value of each camera's images; sorted here. Values that are not > 0 do not count.
 */
void adcgs_exposure_bound(adcgs_exposure *exposure, double *brightness);
/**
 * A burnt pixel is a lower bound: if the render is brighter, the target follows the render. drawn, target: as the mean camera
 * would show them, [3][plane]. background: of images with alpha, whose pixels of this colour are not burnt; otherwise NULL.
 */
void adcgs_exposure_allow_burnt(const adcgs_exposure *exposure, uint32_t view, const float *drawn, const float background[3],
                                float *target, size_t plane);
/** out: the recorded image as the mean camera would show it. All [3][plane]. */
void adcgs_exposure_even(const adcgs_exposure *exposure, uint32_t view, const float *taken, float *out, size_t plane);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Training views: loading of images, rendering, and gradients. */
#ifndef ADCGS_TRAIN_TRAIN_VIEWS_H
#define ADCGS_TRAIN_TRAIN_VIEWS_H

#include "train/state/state.h"

/** (Re)loads all training views with their size divided by an integer. */
adcgs_status adcgs_trainer_load_views(adcgs_trainer *trainer, int divide, adcgs_error *error);

/**
 * A training view's image as the mean camera would show it; valid until the next call. Masked pixels are copied from the render,
 * trainer->image. sums: receives the sums of the rendered and the recorded image, which determine the gain of the view's camera
 * (adcgs_exposure_follow()); NULL: not wanted.
 */
adcgs_status adcgs_trainer_target(adcgs_trainer *trainer, uint32_t view, adcgs_exposure_sums *sums, const float **target,
                                  adcgs_error *error);

/**
 * Loss of trainer->image against a view's target, as a mean over the pixels that are not masked. Masked pixels have no gradient
 * in trainer->grad, and count as correct in windows of other pixels.
 */
adcgs_status adcgs_trainer_loss(adcgs_trainer *trainer, uint32_t view, const float *target, adcgs_loss_value *value,
                                adcgs_error *error);

/** Index of the pixel that shows a position in scene units. Returns 0 if the view does not contain it. */
int adcgs_view_pixel(const adcgs_view *view, const float x[3], size_t *at);
/** Crops a view to a rectangle of its image; the pixels stay the same. */
void adcgs_view_crop(adcgs_view *view, int x, int y, int width, int height);
/** Loss of trainer->image, a render of a crop of a view without masks, against its part of the target, which is overwritten. */
adcgs_status adcgs_trainer_loss_crop(adcgs_trainer *trainer, uint32_t view, const adcgs_view *crop, adcgs_loss_value *value,
                                     adcgs_error *error);

/** In place of a training view: the scene's own background, as in a decoded frame; definition. */
#define ADCGS_MEAN_LIGHT UINT32_MAX

/**
 * Renders the primitives of the last forward pass into image [3][height][width]. trainer->image is large enough for every
 * training view. of: the training view whose target the image is compared with, or ADCGS_MEAN_LIGHT. An image with alpha is
 * composited before its gain is known, so the background of its target is divided by the gain. The render uses the same
 * background; otherwise the model would grow haze in front of the camera. keep: 1 if adcgs_view_backward() follows.
 */
adcgs_status adcgs_view_render(adcgs_trainer *trainer, const adcgs_view *view, uint32_t of, float *image, int keep,
                               adcgs_error *error);
/**
 * Computes gradients of the primitives from trainer->grad, the gradient of trainer->image, for the last render of the same view
 * with keep.
 */
adcgs_status adcgs_view_backward(adcgs_trainer *trainer, const adcgs_view *view, uint32_t of, adcgs_raster_grads *grads,
                                 adcgs_error *error);

/**
 * The view of a view pass. Once the curriculum covers all of time, every epoch visits each view once, in its own order (a Feistel
 * walk over the index).
 */
uint32_t adcgs_view_pick(const adcgs_trainer *trainer, uint32_t look);

#endif

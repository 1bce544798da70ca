/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Training views: loading their pictures, drawing them, and the gradients of what was drawn. */
#ifndef ADCGS_TRAIN_VIEWS_H
#define ADCGS_TRAIN_VIEWS_H

#include "train/state.h"

/** (Re)load all training views with their size divided by an integer. */
adcgs_status adcgs_trainer_load_views(adcgs_trainer *trainer, int divide, adcgs_error *error);

/**
 * A training view's picture as the mean camera would have taken it; valid until the next is asked for. Where it is masked, it
 * is the model's own, trainer->image. sums: receives those of the image drawn and of the image taken, from which
 * the gain of the view's camera follows (adcgs_exposure_follow()); NULL: they are not wanted.
 */
adcgs_status adcgs_trainer_target(adcgs_trainer *trainer, uint32_t view, adcgs_exposure_sums *sums, const float **target,
                                  adcgs_error *error);

/**
 * The loss of trainer->image against a view's target: a mean over the pixels that are not masked; these have no gradient in
 * trainer->grad, and to the windows of others they are right.
 */
adcgs_status adcgs_trainer_loss(adcgs_trainer *trainer, uint32_t view, const float *target, adcgs_loss_value *value,
                                adcgs_error *error);

/** The pixel, row by row, at which a view has a place in scene units; 0 if it has none. */
int adcgs_view_pixel(const adcgs_view *view, const float x[3], size_t *at);
/** Narrow a view to a rectangle of its picture, in which it draws the same. */
void adcgs_view_crop(adcgs_view *view, int x, int y, int width, int height);
/** The loss of trainer->image, drawn of a crop of a view without masks, against its part of the target, which is spent. */
adcgs_status adcgs_trainer_loss_crop(adcgs_trainer *trainer, uint32_t view, const adcgs_view *crop, adcgs_loss_value *value,
                                     adcgs_error *error);

/** In place of a training view: the scene's own background, as in a decoded frame. */
#define ADCGS_MEAN_LIGHT UINT32_MAX

/**
 * Draw the primitives of the last forward pass as a camera sees them, into image [3][height][width] (trainer->image is large
 * enough for every training view). of: the training view whose target the image is compared with, or ADCGS_MEAN_LIGHT. An image
 * with alpha is composited before its gain is known, so its target has a background that is divided by the gain: the model is
 * drawn over the same one, or it would grow haze in front of the camera. keep: adcgs_view_draw_back() will follow.
 */
adcgs_status adcgs_view_draw(adcgs_trainer *trainer, const adcgs_view *view, uint32_t of, float *image, int keep,
                             adcgs_error *error);
/**
 * From trainer->grad, the gradient of trainer->image that was drawn last and kept, of the same view, to gradients of the
 * primitives.
 */
adcgs_status adcgs_view_draw_back(adcgs_trainer *trainer, const adcgs_view *view, uint32_t of, adcgs_raster_grads *grads,
                                  adcgs_error *error);

/**
 * The view that is looked at when so many have been. Once all of time is trained on, every epoch visits all views once, in an
 * order of its own (a Feistel walk over the index).
 */
uint32_t adcgs_view_pick(const adcgs_trainer *trainer, uint32_t look);

#endif

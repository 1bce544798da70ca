/* SPDX-License-Identifier: BSD-2-Clause */
/** \file From a decoded image to one of the requested size: composites over the background, undistorts, reduces, evens light. */
#ifndef ADCGS_SCENE_IMAGE_SHAPE_H
#define ADCGS_SCENE_IMAGE_SHAPE_H

#include "scene/scene.h"

/** Input of the reduction: colours over a background, or colours with a weight in the fourth channel and no background. */
typedef struct adcgs_image_source {
    const adcgs_image *image, *mask; /**< mask NULL: every pixel counts */
    const float *background;         /**< NULL: the fourth channel, if present, is the weight */
} adcgs_image_source;

/** The camera of an image that is reduced by an integer. */
void adcgs_camera_divide(adcgs_camera *camera, int divide);
/** Replaces the recorded image by one of the requested size: colours, and with a mask their weight. */
adcgs_status adcgs_image_shape(const adcgs_scene *scene, const adcgs_scene_view *view, const adcgs_image *mask, int divide,
                               adcgs_image *image, adcgs_error *error);
/** Returns planes from malloc(), in which pixels that do not count are NaN; NULL: out of memory. */
float *adcgs_image_planes(const adcgs_image *image);
/**
 * Reduces rows of an image to a row of each plane, at pixel `first`, with the values of adcgs_image_shape() and
 * adcgs_image_planes().
 */
void adcgs_image_place_rows(float *rgb, size_t plane, size_t first, const adcgs_image_source *source, int divide);
/**
 * Divides an image by its excess of light. The true values of clipped pixels are unknown: they become NaN. Values that were not
 * clipped stay at most white.
 */
void adcgs_image_even_light(const adcgs_scene_view *view, float *rgb, size_t plane);

#endif

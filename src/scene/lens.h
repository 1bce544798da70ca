/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Lenses with distortion: the model of the recorded images, and their conversion to pinhole images. Training uses pinhole
 * images, which are resampled once when they are loaded: splats are projected by a pinhole camera, and the decoder renders
 * nothing else.
 */
#ifndef ADCGS_SCENE_LENS_H
#define ADCGS_SCENE_LENS_H

#include "media/image/image.h"

#include <adcgs/types.h>

/**
 * The OpenCV model. A point at (x, y) = (X/Z, Y/Z) in OpenCV axes, r^2 = x^2 + y^2, is projected to
 *   x' = x (1 + k1 r^2 + k2 r^4 + k3 r^6 + k8 r^8) / (1 + k4 r^2 + k5 r^4 + k6 r^6) + 2 p1 x y + p2 (r^2 + 2 x^2),
 *   y' = y (the same) + p1 (r^2 + 2 y^2) + 2 p2 x y,
 * and seen at u = fx x' + skew y' + cx, v = fy y' + cy, pixels as in adcgs_camera. In OpenCV's fisheye model (x', y') has the
 * direction of (x, y). Its length is a (1 + k1 a^2 + k2 a^4 + k3 a^6 + k4 a^8), a = atan(r) being the angle from the axis.
 */
typedef struct adcgs_lens {
    int32_t width, height; /**< size of the recorded images; 0: a pinhole, the other members are unused */
    double fx, fy, cx, cy, skew;
    double k[6], p[2];  /**< k1 .. k6; p1, p2 */
    double k8;          /**< not in OpenCV; nerfstudio calls it k4 */
    int64_t is_fisheye; /**< only k1 .. k4 count; as wide as a double, since lenses are compared as bytes */
} adcgs_lens;

/** Projects a direction. The result is meaningless beyond the model's first fold. */
void adcgs_lens_project(const adcgs_lens *lens, double x, double y, double uv[2]);
/**
 * Derives the pinhole camera for a lens: its focal lengths, no skew, and the largest rectangle of pixels that the image covers
 * wholly. The rectangle is found on a raster of at most 128 cells along the longer side, then grown until no side can move.
 * Sets width, height, fx, fy, cx and cy of camera. A fisheye lens sees more than a pinhole can show: the rectangle reaches at
 * most 60 degrees from the axis to each side. A lens that displaces no point by a hundredth of a pixel becomes the pinhole
 * itself, with lens->width 0.
 * \return ADCGS_ERR_DATA, naming path, if less than a tenth of the image is left, or if the model folds inside the image. For a
 * fisheye lens only folds inside the part that the pinhole can show count.
 */
adcgs_status adcgs_lens_pinhole(adcgs_lens *lens, adcgs_camera *camera, const char *path, adcgs_error *error);
/**
 * Resamples *image from the lens to the pinhole, all channels. Uses cubic convolution (Catmull-Rom, 4x4 pixels) with colours
 * weighted by alpha. It is exact for ramps and smoother than linear interpolation. No value is outside the range of its source
 * pixels. On failure *image is unchanged.
 */
adcgs_status adcgs_lens_straighten(const adcgs_lens *lens, const adcgs_camera *camera, adcgs_image *image, const char *path,
                                   adcgs_error *error);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Lenses that bend: how pictures were taken, and the pinhole's pictures made
 * of them. Training is on pinhole pictures, resampled once when they are
 * loaded, because splats are projected by a pinhole camera and the decoder
 * draws nothing else.
 */
#ifndef ADCGS_DATA_LENS_H
#define ADCGS_DATA_LENS_H

#include "io/image.h"

#include <adcgs/types.h>

/**
 * The OpenCV model. A point at (x, y) = (X/Z, Y/Z) in OpenCV axes, r^2 = x^2 + y^2, is taken to
 *   x' = x (1 + k1 r^2 + k2 r^4 + k3 r^6 + k8 r^8) / (1 + k4 r^2 + k5 r^4 + k6 r^6) + 2 p1 x y + p2 (r^2 + 2 x^2),
 *   y' = y (the same) + p1 (r^2 + 2 y^2) + 2 p2 x y,
 * and seen at u = fx x' + skew y' + cx, v = fy y' + cy, pixels as in adcgs_camera. Of OpenCV's fisheye model x' and y' have the
 * direction of x and y and, a = atan(r) being the angle from the axis, the length a (1 + k1 a^2 + k2 a^4 + k3 a^6 + k4 a^8).
 */
typedef struct adcgs_lens {
    int32_t width, height;        /**< of the pictures as taken; 0: a pinhole, and the rest is not used */
    double fx, fy, cx, cy, skew;
    double k[6], p[2];            /**< k1 .. k6; p1, p2 */
    double k8;                    /**< not of OpenCV: nerfstudio calls it k4 */
    int64_t is_fisheye;           /**< k1 .. k4 are all that counts; of a number's size, since lenses are compared as bytes */
} adcgs_lens;

/** Where a direction is seen; beyond the first fold of the model this means nothing. */
void adcgs_lens_project(const adcgs_lens *lens, double x, double y, double uv[2]);
/** The direction seen at a pixel; 0 where the model has no inverse there. */
int adcgs_lens_unproject(const adcgs_lens *lens, double u, double v, double xy[2]);
/**
 * The pinhole camera for a lens: its focal lengths, no skew, and the largest rectangle of pixels that the picture covers
 * wholly; of very large pictures the largest up to a raster of 1/128, then grown until no side can move. Sets width, height,
 * fx, fy, cx and cy of camera. A fisheye lens sees more than a pinhole can show: what is left reaches at most 60 degrees from
 * the axis to each side. A lens that moves nothing by a hundredth of a pixel becomes the pinhole itself, and lens->width 0.
 * ADCGS_ERR_DATA, naming path, if the model folds inside the picture, of a fisheye lens inside of what could be left of it, or
 * less than a tenth is left.
 */
adcgs_status adcgs_lens_pinhole(adcgs_lens *lens, adcgs_camera *camera, const char *path, adcgs_error *error);
/**
 * The pinhole's picture from the lens's, all channels: *image is replaced. Cubic convolution (Catmull-Rom, 4x4 pixels),
 * colours weighted by alpha: exact for ramps and smoother than straight lines between pixels, with no value
 * outside the range of the pixels it is made of. On failure *image is as it was.
 */
adcgs_status adcgs_lens_straighten(const adcgs_lens *lens, const adcgs_camera *camera, adcgs_image *image, const char *path,
                                   adcgs_error *error);

#endif

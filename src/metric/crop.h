/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Quality of a part of a picture: of the rectangle in which a box in the world
 * is seen. For scenes in which what matters fills little of the picture.
 */
#ifndef ADCGS_METRIC_CROP_H
#define ADCGS_METRIC_CROP_H

#include "metric/evaluate.h"

/** World units, along the world's axes. */
typedef struct adcgs_box {
    double low[3], high[3];
} adcgs_box;

typedef struct adcgs_crop {
    int visible;            /**< else nothing below is set */
    int rectangle[4];       /**< left, top, right, bottom in pixels; right and bottom are the first ones outside */
    double psnr, ssim;      /**< of the pictures cut out */
} adcgs_crop;

/**
 * The bounds of the scene's points, a tenth larger. Without outliers, which along some axis lie further from the quartiles than
 * 1.5 times their distance: clouds from photographs have stray points, and points of what stands behind.
 * \return ADCGS_ERR_DATA if no point is left.
 */
adcgs_status adcgs_box_of_points(adcgs_box *box, const adcgs_scene *scene, adcgs_error *error);
/**
 * The pixels that the bounds of a box's projection touch, clipped to the picture; 0 if there are none. Only what is beyond the
 * near plane counts.
 */
int adcgs_box_rectangle(const adcgs_box *box, const adcgs_camera *camera, int rectangle[4]);
/** Compare the two pictures of a view inside the rectangle of a box. */
adcgs_status adcgs_crop_measure(adcgs_crop *out, const adcgs_box *box, const adcgs_view_score *score, adcgs_error *error);

#endif

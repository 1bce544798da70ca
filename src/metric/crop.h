/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Quality of a part of an image: the rectangle in which a box of the world is
 * visible. For scenes whose subject fills a small part of the image.
 */
#ifndef ADCGS_METRIC_CROP_H
#define ADCGS_METRIC_CROP_H

#include "metric/evaluate.h"

/** World units, along the world's axes. */
typedef struct adcgs_box {
    double low[3], high[3];
} adcgs_box;

typedef struct adcgs_crop {
    int visible;       /**< if 0, the members below are not set */
    int rectangle[4];  /**< left, top, right, bottom in pixels; right and bottom are exclusive */
    double psnr, ssim; /**< of the cropped images */
} adcgs_crop;

/**
 * The bounds of the scene's points, enlarged by a tenth. Outliers are left out: points that lie, along some axis, further from
 * the quartiles than 1.5 times the quartiles' distance. Point clouds from photographs have stray points, and points of the
 * background.
 * \return ADCGS_ERR_DATA if no point is left
 */
adcgs_status adcgs_box_of_points(adcgs_box *box, const adcgs_scene *scene, adcgs_error *error);
/**
 * The pixels that the bounds of a box's projection touch, clipped to the image; 0 if there are none. Only the part beyond the
 * near plane counts.
 */
int adcgs_box_rectangle(const adcgs_box *box, const adcgs_camera *camera, int rectangle[4]);
/** Compare the two images of a view inside the rectangle of a box. */
adcgs_status adcgs_crop_measure(adcgs_crop *out, const adcgs_box *box, const adcgs_view_score *score, adcgs_error *error);

#endif

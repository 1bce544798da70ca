/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The point of the scene under a place of the image: the centre of an orbit. */
#ifndef ADCGS_CAMERA_PIVOT_H
#define ADCGS_CAMERA_PIVOT_H

#include <adcgs/types.h>

/**
 * The point at the median depth around a place of the image. x, y: 0 to 1 over width and height. Returns ADCGS_ERR_DATA if the
 * place shows background only. Costs one image of some thousand pixels.
 */
adcgs_status adcgs_pivot_find(double point[3], adcgs_decoder *decoder, const adcgs_camera *camera, double time, double x,
                              double y, adcgs_error *error);

#endif

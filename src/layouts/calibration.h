/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Cameras calibrated for pictures of one size, used with pictures of another. */
#ifndef ADCGS_LAYOUTS_CALIBRATION_H
#define ADCGS_LAYOUTS_CALIBRATION_H

#include "data/scene.h"

/** Make a lens that is for pictures of one size one for another: numbers in pixels are scaled, each along its axis. */
void adcgs_lens_resize(adcgs_lens *lens, int width, int height);

/**
 * Set a view's lens and the intrinsics of its camera. The lens is for pictures of its own width and height; those that are
 * there are width x height, which must have the same shape to 1 % or a pixel. ADCGS_ERR_DATA, naming path, if they have not,
 * and as adcgs_lens_pinhole().
 */
adcgs_status adcgs_calibrate(adcgs_scene_view *view, const adcgs_lens *lens, int width, int height, const char *path,
                             adcgs_error *error);

#endif

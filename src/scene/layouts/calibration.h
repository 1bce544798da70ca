/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Cameras calibrated for images of one size, used with images of another. */
#ifndef ADCGS_SCENE_LAYOUTS_CALIBRATION_H
#define ADCGS_SCENE_LAYOUTS_CALIBRATION_H

#include "scene/scene.h"

/** Converts a lens to images of another size: numbers in pixels are scaled, each along its axis. */
void adcgs_lens_resize(adcgs_lens *lens, int width, int height);

/**
 * Sets a view's lens and the intrinsics of its camera. The lens is for images of its own width and height. The view's images
 * are width x height and must have the same shape to 1 % or a pixel. ADCGS_ERR_DATA, naming path, if they have not; other
 * errors as from adcgs_lens_pinhole().
 */
adcgs_status adcgs_calibrate(adcgs_scene_view *view, const adcgs_lens *lens, int width, int height, const char *path,
                             adcgs_error *error);

#endif

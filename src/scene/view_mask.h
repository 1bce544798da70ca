/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Masks of views. A mask has its image's aspect ratio; if its size differs, it is scaled by the nearest pixel. */
#ifndef ADCGS_SCENE_VIEW_MASK_H
#define ADCGS_SCENE_VIEW_MASK_H

#include "scene/scene.h"

/** Sets width and height of a view's image, before it is undistorted. */
void adcgs_view_size(const adcgs_scene_view *view, int wanted[2]);
/** Reads a mask, with adcgs_mask_settle(), and scales it to the view's image. ADCGS_ERR_DATA if the aspect ratio differs. */
adcgs_status adcgs_view_mask_read(const adcgs_scene_view *view, const char *path, adcgs_image *mask, adcgs_error *error);
/** The same in steps: checks the size of a file, or a known size, before a mask is read. */
adcgs_status adcgs_view_mask_check(const adcgs_scene_view *view, const char *path, adcgs_error *error);
adcgs_status adcgs_view_mask_fits(const adcgs_scene_view *view, const char *path, int width, int height, adcgs_error *error);
/** Scales an image that was read as a mask, with adcgs_mask_settle(). On failure it is freed. */
adcgs_status adcgs_view_mask_settle(const adcgs_scene_view *view, const char *path, adcgs_image *mask, adcgs_error *error);
/** Checks a mask's aspect ratio, and that its colours and alpha agree. */
adcgs_status adcgs_view_mask_probe(const adcgs_scene_view *view, const char *path, adcgs_error *error);
/** ADCGS_ERR_DATA if the masks of all training views hide all pixels. */
adcgs_status adcgs_scene_check_masks(const adcgs_scene *scene, adcgs_error *error);

#endif

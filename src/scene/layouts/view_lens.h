/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Views taken through lenses, while scenes are read. */
#ifndef ADCGS_SCENE_LAYOUTS_VIEW_LENS_H
#define ADCGS_SCENE_LAYOUTS_VIEW_LENS_H

#include "scene/scene.h"

/**
 * Derives the pinhole for view->lens, in view->camera: by adcgs_lens_pinhole(), or copied from one of the latest views of the
 * scene with the same lens. The view may be one of the scene's, if it is the last of its split.
 */
adcgs_status adcgs_view_lens(const adcgs_scene *scene, adcgs_scene_view *view, const char *path, adcgs_error *error);

#endif

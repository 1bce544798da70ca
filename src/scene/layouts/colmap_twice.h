/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Files of a COLMAP model that exist in both formats. */
#ifndef ADCGS_SCENE_LAYOUTS_COLMAP_TWICE_H
#define ADCGS_SCENE_LAYOUTS_COLMAP_TWICE_H

#include "scene/layouts/colmap_files.h"
#include "scene/scene.h"

/**
 * Adds a remark if a file also exists in the other format, and its cameras or poses differ from those of the model. An unreadable
 * other file is ignored. ADCGS_ERR_MEMORY.
 */
adcgs_status adcgs_colmap_twice_remark(adcgs_scene *scene, const adcgs_colmap *model, const adcgs_colmap_place *place,
                                       adcgs_colmap_file file, adcgs_error *error);

#endif

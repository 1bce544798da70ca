/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Images without a pose next to those of a scene. */
#ifndef ADCGS_SCENE_LAYOUTS_UNPOSED_H
#define ADCGS_SCENE_LAYOUTS_UNPOSED_H

#include "scene/scene.h"

/**
 * Adds a remark with the number of images in a folder and its subfolders that no view of the scene uses; none if there are no
 * such images. Names are compared without their extension. folder ends with its slash, and paths of views in it begin with it.
 * ADCGS_ERR_MEMORY.
 */
adcgs_status adcgs_unposed_remark(adcgs_scene *scene, const char *folder, adcgs_error *error);

#endif

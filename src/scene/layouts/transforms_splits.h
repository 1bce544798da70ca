/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Scenes of transforms: a folder with one file or a file for each split, or a file alone. */
#ifndef ADCGS_SCENE_LAYOUTS_TRANSFORMS_SPLITS_H
#define ADCGS_SCENE_LAYOUTS_TRANSFORMS_SPLITS_H

#include "scene/scene.h"

/** True if the folder has transforms_train.json or transforms.json. */
int adcgs_is_transforms(const char *folder);
/**
 * Reads the scene's folder. *points_path: NULL, or a path that has precedence; receives that of the scene's initial points, from
 * malloc(), if a file names them.
 */
adcgs_status adcgs_transforms_read_folder(adcgs_scene *scene, char **points_path, adcgs_error *error);
/** The same for one file with the frames of all splits. */
adcgs_status adcgs_transforms_read_single(adcgs_scene *scene, const char *path, char **points_path, adcgs_error *error);

#endif

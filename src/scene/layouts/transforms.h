/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * transforms*.json of D-NeRF and nerfstudio: cameras in OpenGL axes with camera-to-world matrices, intrinsics for all frames or
 * per frame, times in [0,1] or in units of their own. An image whose size differs from w and h must have their shape, to a
 * pixel; numbers in pixels are scaled to it. Without w and h the size is the image's own.
 */
#ifndef ADCGS_SCENE_LAYOUTS_TRANSFORMS_H
#define ADCGS_SCENE_LAYOUTS_TRANSFORMS_H

#include "scene/scene.h"

/** Values of one file other than its views. */
typedef struct adcgs_transforms {
    adcgs_fps rate;    /**< unknown if not given */
    int has_times;     /**< frames carry times */
    int has_lists;     /**< the file lists names for each split */
    char clock[64];    /**< a field of frames that is not read but differs between them like a time, or "" */
    char *points_path; /**< NULL if it names none */
} adcgs_transforms;

/**
 * Appends the views of a file to the scene, with times as in the file. split ADCGS_SPLITS: the file holds all splits,
 * distinguished by its lists of file names or else by position.
 */
adcgs_status adcgs_transforms_read(adcgs_scene *scene, adcgs_transforms *out, const char *path, adcgs_split split,
                                   adcgs_error *error);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * transforms*.json of D-NeRF and nerfstudio: cameras in OpenGL axes with
 * camera-to-world matrices, intrinsics for all frames or per frame, times in
 * [0,1] or in units of their own. An image of another size than w and h say has
 * the shape that they say, to a pixel, and numbers in pixels are scaled to it;
 * where they say nothing the size is the image's own.
 */
#ifndef ADCGS_LAYOUTS_TRANSFORMS_H
#define ADCGS_LAYOUTS_TRANSFORMS_H

#include "data/scene.h"

/** What one file says besides its views. */
typedef struct adcgs_transforms {
    adcgs_fps rate;   /**< not known if it says nothing */
    int has_times;     /**< frames carry times */
    int has_lists;     /**< it lists names for each split */
    const char *clock; /**< a field of frames that is not read but differs between them as times do, or NULL */
    char *points_path; /**< NULL if it names none */
} adcgs_transforms;

/**
 * Append the views of a file to the scene; their times are still those of the file. split ADCGS_SPLITS: the file holds all
 * splits, told apart by its lists of file names or else by position.
 */
adcgs_status adcgs_transforms_read(adcgs_scene *scene, adcgs_transforms *out, const char *path, adcgs_split split,
                                   adcgs_error *error);

#endif

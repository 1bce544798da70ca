/* SPDX-License-Identifier: BSD-2-Clause */
/** \file COLMAP's result: the largest of its models, and the pose of each camera. */
#ifndef ADCGS_APPS_IMPORT_COLMAP_RESULT_H
#define ADCGS_APPS_IMPORT_COLMAP_RESULT_H

#include "apps/import/scene_images.h"
#include "scene/layouts/colmap_model.h"

/** A camera of the scene: an image of a moving camera, or a fixed camera. */
typedef struct adcgs_posed {
    uint32_t source;         /**< the image; for a fixed camera, its first image with a pose */
    const adcgs_lens *lens;  /**< the model's, for images as given to COLMAP */
    double cam_to_world[12]; /**< OpenCV axes */
    int is_test;
} adcgs_posed;

typedef struct adcgs_poses {
    adcgs_colmap model; /**< its points are the scene's initial points */
    adcgs_posed *posed; /**< in the order of the source images, or of the fixed cameras */
    uint32_t n;
} adcgs_poses;

/**
 * Reads the poses, and rotates the world so that the cameras' up direction is z. Fills in the report. ADCGS_ERR_DATA, naming
 * the log, if too few cameras were found.
 */
adcgs_status adcgs_poses_read(adcgs_poses *out, adcgs_import_job *job);
void adcgs_poses_clear(adcgs_poses *poses);

#endif

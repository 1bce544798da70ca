/* SPDX-License-Identifier: BSD-2-Clause */
/** \file What COLMAP found: the largest of its models, and the pose of each camera. */
#ifndef ADCGS_IMPORT_MODEL_H
#define ADCGS_IMPORT_MODEL_H

#include "import/pictures.h"
#include "layouts/colmap_model.h"

/** A camera of the scene: a picture of a camera that moves, or one that stands. */
typedef struct adcgs_posed {
    uint32_t shot;           /**< the picture; of a camera that stands the first whose pose is known */
    const adcgs_lens *lens;  /**< the model's, for pictures as COLMAP got them */
    double cam_to_world[12]; /**< OpenCV axes */
    int is_test;
} adcgs_posed;

typedef struct adcgs_poses {
    adcgs_colmap model;      /**< its points are the scene's to begin with */
    adcgs_posed *posed;      /**< in the order of the shots, or of the cameras that stand */
    uint32_t n;
} adcgs_poses;

/** The world is turned so that cameras' up is z. Fills in the report. ADCGS_ERR_DATA, naming the log, if too little was found. */
adcgs_status adcgs_poses_read(adcgs_poses *out, adcgs_import_job *job);
void adcgs_poses_clear(adcgs_poses *poses);

#endif

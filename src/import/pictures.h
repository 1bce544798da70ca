/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The files of a scene's pictures, made from what was given. */
#ifndef ADCGS_IMPORT_PICTURES_H
#define ADCGS_IMPORT_PICTURES_H

#include "import/shots.h"

typedef struct adcgs_import_job {
    const adcgs_import_options *options;
    adcgs_shots shots;
    char *folder;      /**< where all is made */
    char *log;         /**< of COLMAP */
    int has_masks;     /**< of some picture at least */
    adcgs_progress *progress;
    adcgs_import_report *report;
    adcgs_error *error;
} adcgs_import_job;

/** As adcgs_fail(), into the job's error. */
#define ADCGS_IMPORT_FAIL(job, status, ...) adcgs_fail((job)->error, status, __VA_ARGS__)

/** A path below the job's folder, from malloc(). *out is NULL on failure. */
adcgs_status adcgs_import_path(char **out, const adcgs_import_job *job, const char *name);
/** Make a folder there, unless it is there. */
adcgs_status adcgs_import_make_folder(const adcgs_import_job *job, const char *name);
/** ADCGS_ERR_IO if somebody wants us to stop. */
adcgs_status adcgs_import_goes_on(const adcgs_import_job *job);

/**
 * images/FOLDER/STEM.END of all shots, and masks/FOLDER/STEM.END.png, as COLMAP calls them, of those that have one.
 * What is there already, of a run before, stays.
 */
adcgs_status adcgs_import_pictures(adcgs_import_job *job);
/** The videos of a rig in videos/, and their masks as masks/CAMERA.png. */
adcgs_status adcgs_import_videos(adcgs_import_job *job);

/* ---- Shared: masks.c ---- */

/** The mask of a shot, if there is one, made to fit its picture. */
adcgs_status adcgs_import_mask(adcgs_import_job *job, const adcgs_shot *shot);
/** The mask of all that a camera filmed, as it is, if there is one. */
adcgs_status adcgs_import_camera_mask(adcgs_import_job *job, uint32_t camera);

#endif

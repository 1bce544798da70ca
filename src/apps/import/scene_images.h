/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The image files of a scene, made from the given footage. */
#ifndef ADCGS_APPS_IMPORT_SCENE_IMAGES_H
#define ADCGS_APPS_IMPORT_SCENE_IMAGES_H

#include "apps/import/phase.h"
#include "apps/import/source_images.h"

typedef struct adcgs_import_job {
    const adcgs_import_options *options;
    adcgs_source_images sources;
    char *folder;  /**< folder of the unfinished scene */
    char *log;     /**< path of COLMAP's log */
    int has_masks; /**< at least one image has a mask */
    adcgs_progress *progress;
    adcgs_import_phase phase;
    adcgs_import_report *report;
    adcgs_error *error;
} adcgs_import_job;

/** Like adcgs_fail(), into the job's error. */
#define ADCGS_IMPORT_FAIL(job, status, ...) adcgs_fail((job)->error, status, __VA_ARGS__)

/** A path below the job's folder, from malloc(). *out is NULL on failure. */
adcgs_status adcgs_import_path(char **out, const adcgs_import_job *job, const char *name);
/** Makes a folder in the job's folder, unless it exists. */
adcgs_status adcgs_import_make_folder(const adcgs_import_job *job, const char *name);
/** Removes a whole folder or a file, if it exists, without following links. */
adcgs_status adcgs_import_remove_tree(const char *path, adcgs_error *error);
/** The same in the job's folder. */
adcgs_status adcgs_import_remove(const adcgs_import_job *job, const char *name);
/** Returns ADCGS_ERR_IO after an interrupt. */
adcgs_status adcgs_import_goes_on(const adcgs_import_job *job);

/**
 * Makes images/FOLDER/STEM.END for all source images, and masks/FOLDER/STEM.END.png, in COLMAP's convention, for source
 * images with a mask. Files that exist from an earlier run are kept.
 */
adcgs_status adcgs_import_pictures(adcgs_import_job *job);
/** Copies the videos of a rig to videos/, and their masks to masks/CAMERA.png. */
adcgs_status adcgs_import_videos(adcgs_import_job *job);

/* ---- Shared: masks.c ---- */

/** Makes the mask of a source image, if there is one, to fit its image. */
adcgs_status adcgs_import_mask(adcgs_import_job *job, const adcgs_source_image *source);
/** Copies the mask that applies to a camera's whole footage without resizing it, if there is one. */
adcgs_status adcgs_import_camera_mask(adcgs_import_job *job, uint32_t camera);

#endif

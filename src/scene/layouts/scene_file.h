/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The adcgs scene file: cameras with their poses and footage (a video or numbered images each), in one JSON file.
 * doc/scene-file.md describes it field by field.
 */
#ifndef ADCGS_SCENE_LAYOUTS_SCENE_FILE_H
#define ADCGS_SCENE_LAYOUTS_SCENE_FILE_H

#include "scene/camera_json.h"
#include "scene/layouts/footage.h"
#include "scene/scene.h"

/**
 * Fills an empty scene, with times in [0,1] of its duration, which is set. If the file names no points, the scene has an empty
 * cloud. with_points 0: points are not read.
 * taken: footage of the training cameras, in their order, instead of the files named by the scene file; other cameras are left
 * out then. NULL: footage comes from those files.
 * \return ADCGS_ERR_DATA, naming file and field, for unknown fields and invalid data
 */
adcgs_status adcgs_scene_file_read(adcgs_scene *scene, const char *path, const adcgs_frame_range *frames, int with_points,
                                   const adcgs_footage *taken, adcgs_error *error);

/* ---- Live footage ---- */

/** A training camera, and the location of its future footage. */
typedef struct adcgs_source_camera {
    char name[ADCGS_CAMERA_NAME_MAX + 1];
    char *video;           /**< NULL: images; "standard input" if is_input */
    int is_input;          /**< the file gives "-" */
    char *folder, *images; /**< of images: see adcgs_footage_number() */
    int64_t first, count;  /**< of images: first number, and count; count 0: unknown */
    adcgs_fps rate;        /**< of the camera, else of the file; unknown: the video's, or the default for images */
    double offset;         /**< time of its first frame in seconds */
} adcgs_source_camera;

/**
 * Lists the training cameras of a scene file, without reading their footage. Call adcgs_source_cameras_free() also on failure.
 */
adcgs_status adcgs_source_cameras_read(adcgs_source_camera **out, uint32_t *n, const char *path, adcgs_error *error);
void adcgs_source_cameras_free(adcgs_source_camera **cameras, uint32_t n);

/* ---- One camera; src/scene/layouts/scene_camera.c ---- */

/** A camera of the scene file, without its footage. */
typedef struct adcgs_scene_camera {
    adcgs_scene_view view; /**< name and pose, in the file's units */
    adcgs_lens lens;       /**< for images of its own width and height */
} adcgs_scene_camera;

/** at->frame is the camera, at->root the defaults of all cameras, or NULL. */
adcgs_status adcgs_scene_camera_read(adcgs_scene_camera *out, const adcgs_json_place *at);
/** Refuses fields that are not in the list, which ends with NULL. Messages put prefix in front of their names. */
adcgs_status adcgs_scene_camera_fields(const adcgs_json_place *at, const char *prefix, json_t *object, const char *const *known);
/** Reads a string: NULL if it is absent. */
adcgs_status adcgs_scene_camera_string(const adcgs_json_place *at, const char *field, const char **text);

#endif

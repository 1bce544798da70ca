/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The adcgs scene file: cameras with their poses, and what each of them took, a video or a row of pictures, in one JSON file.
 * doc/scene-file.md describes it field by field.
 */
#ifndef ADCGS_LAYOUTS_SCENE_FILE_H
#define ADCGS_LAYOUTS_SCENE_FILE_H

#include "data/camera_json.h"
#include "data/scene.h"
#include "layouts/footage.h"

/**
 * Fill an empty scene, with times in [0,1] of its duration, which is set. Without points in the file the scene has a cloud of
 * none; with_points 0: they are not read.
 * taken: what the cameras for training took, in their order, instead of what lies where the file says; then there are no others.
 * NULL: that. \return ADCGS_ERR_DATA, naming file and field, for unknown fields and what is wrong.
 */
adcgs_status adcgs_scene_file_read(adcgs_scene *scene, const char *path, const adcgs_frame_range *frames, int with_points,
                                   const adcgs_footage *taken, adcgs_error *error);

/* ---- Footage that is yet to come ---- */

/** A camera for training, and where what it takes will appear. */
typedef struct adcgs_source_camera {
    char name[ADCGS_CAMERA_NAME_MAX + 1];
    char *video;          /**< NULL: pictures; "standard input" if is_input */
    int is_input;         /**< the file says "-" */
    char *folder, *images; /**< of pictures: adcgs_footage_number() */
    int64_t first, count; /**< of pictures: number of the first, how many; 0: nobody knows */
    adcgs_fps rate;       /**< of the camera, else of the file; not known: as the video says, or that of pictures */
    double offset;        /**< seconds at which its first frame is taken */
} adcgs_source_camera;

/** The cameras for training of a scene file, whose footage is not looked at. On failure, too, adcgs_source_cameras_free(). */
adcgs_status adcgs_source_cameras_read(adcgs_source_camera **out, uint32_t *n, const char *path, adcgs_error *error);
void adcgs_source_cameras_free(adcgs_source_camera **cameras, uint32_t n);

/* ---- One camera; src/layouts/scene_camera.c ---- */

/** What the file says of a camera besides its footage. */
typedef struct adcgs_scene_camera {
    adcgs_scene_view view; /**< name and pose, in the file's units */
    adcgs_lens lens;       /**< for pictures of its own width and height */
} adcgs_scene_camera;

/** at->frame is the camera, at->root what all cameras share, or NULL. */
adcgs_status adcgs_scene_camera_read(adcgs_scene_camera *out, const adcgs_json_place *at);
/** Refuse fields that are not in the list, which NULL ends; prefix stands before their names in messages. */
adcgs_status adcgs_scene_camera_fields(const adcgs_json_place *at, const char *prefix, json_t *object, const char *const *known);
/** A string: NULL if it is not there. */
adcgs_status adcgs_scene_camera_string(const adcgs_json_place *at, const char *field, const char **text);

#endif

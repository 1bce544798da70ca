/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The camera fields that transforms files and camera paths share: intrinsics for all frames or per frame, and camera-to-world
 * matrices in OpenGL axes. Messages name file, frame and field.
 */
#ifndef ADCGS_SCENE_CAMERA_JSON_H
#define ADCGS_SCENE_CAMERA_JSON_H

#include "base/base.h"
#include "media/video/fps.h"
#include "scene/lens.h"

#include <adcgs/types.h>

#include <jansson.h>

/** The current position in a file, for messages and for fields that frames inherit. */
typedef struct adcgs_json_place {
    const char *path; /**< of the file */
    json_t *root;
    json_t *frame;    /**< NULL: at the root */
    size_t index;     /**< of the frame */
    const char *list; /**< name of the array of frames; NULL: "frames" */
    adcgs_error *error;
} adcgs_json_place;

/** Loads a file as a JSON object; the caller releases *root with json_decref(). */
adcgs_status adcgs_json_load(json_t **root, const char *path, adcgs_error *error);
/** Like adcgs_fail(), with file, frame and field in front of the message. */
adcgs_status adcgs_json_bad(const adcgs_json_place *at, adcgs_status status, const char *field, const char *format, ...)
    ADCGS_PRINTF(4, 5);
/** Returns a field of the frame, or else of the whole file; NULL if both lack it. */
json_t *adcgs_json_find(const adcgs_json_place *at, const char *field);
/** Reads a field (adcgs_json_find()) as a number in [min, max]. If it is absent, *value is unchanged and *found is 0. */
adcgs_status adcgs_json_number(const adcgs_json_place *at, const char *field, double min, double max, double *value, int *found);
/** Reads a field (adcgs_json_find()) as frames per second: a number, or a ratio as text ("30000/1001"). */
adcgs_status adcgs_json_fps(const adcgs_json_place *at, const char *field, adcgs_fps *rate, int *found);
/** Returns the array of frames, which has between one and a million elements. */
adcgs_status adcgs_json_frames(const adcgs_json_place *at, json_t **frames, size_t *n);

/** Reads w and h; *found is 0 if both are absent. */
adcgs_status adcgs_json_size(const adcgs_json_place *at, adcgs_camera *camera, int *found);
/** Reads focal lengths and principal point (default: the centre) of a camera whose size is set. Refuses lens distortion. */
adcgs_status adcgs_json_intrinsics(const adcgs_json_place *at, adcgs_camera *camera);
/**
 * The same for a lens whose size is set, with its distortion. As in nerfstudio, k1 to k3, p1 and p2 are OpenCV's, and k4 is the
 * factor of r^8. Only COLMAP's camera_model FULL_OPENCV has k4 to k6 in the denominator. OPENCV_FISHEYE, COLMAP's fisheye
 * models with fewer coefficients, and is_fisheye, which instant-ngp writes, denote OpenCV's fisheye model.
 */
adcgs_status adcgs_json_lens(const adcgs_json_place *at, adcgs_lens *lens);
/** Reads the frame's transform_matrix and converts it to OpenCV axes. */
adcgs_status adcgs_json_pose(const adcgs_json_place *at, adcgs_camera *camera);

#endif

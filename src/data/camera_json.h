/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The camera fields that transforms files and camera paths share: intrinsics
 * for all frames or per frame, camera-to-world matrices in OpenGL axes.
 * Messages name file, frame and field.
 */
#ifndef ADCGS_DATA_CAMERA_JSON_H
#define ADCGS_DATA_CAMERA_JSON_H

#include "base/base.h"
#include "data/lens.h"
#include "io/fps.h"

#include <adcgs/types.h>

#include <jansson.h>

/** Where we are, for messages and for fields that frames inherit. */
typedef struct adcgs_json_place {
    const char *path; /**< of the file */
    json_t *root;
    json_t *frame;    /**< NULL: at the root */
    size_t index;     /**< of the frame */
    const char *list; /**< name of the array of frames; NULL: "frames" */
    adcgs_error *error;
} adcgs_json_place;

/** Load a file as a JSON object; json_decref() the root afterwards. */
adcgs_status adcgs_json_load(json_t **root, const char *path, adcgs_error *error);
/** As adcgs_fail(), after file, frame and field. */
adcgs_status adcgs_json_bad(const adcgs_json_place *at, adcgs_status status, const char *field, const char *format, ...)
    ADCGS_PRINTF(4, 5);
/** A field of the frame, or else of the whole file; NULL if there is none. */
json_t *adcgs_json_find(const adcgs_json_place *at, const char *field);
/** Such a field as a number in [min, max]. Leaves *value alone and *found 0 when it is not there. */
adcgs_status adcgs_json_number(const adcgs_json_place *at, const char *field, double min, double max, double *value, int *found);
/** Such a field as frames per second: a number, or a ratio as text ("30000/1001"). */
adcgs_status adcgs_json_fps(const adcgs_json_place *at, const char *field, adcgs_fps *rate, int *found);
/** The array of frames, not empty, of at most a million. */
adcgs_status adcgs_json_frames(const adcgs_json_place *at, json_t **frames, size_t *n);

/** w and h; *found 0 when neither is there. */
adcgs_status adcgs_json_size(const adcgs_json_place *at, adcgs_camera *camera, int *found);
/** Focal lengths and principal point (the middle, if not given) of a camera whose size is set. Lenses that bend are refused. */
adcgs_status adcgs_json_intrinsics(const adcgs_json_place *at, adcgs_camera *camera);
/**
 * The same for a lens whose size is set, with its distortion in the meaning of nerfstudio: k1 to k3, p1 and p2 are OpenCV's, k4
 * is the factor of r^8. Only camera_model FULL_OPENCV, which is COLMAP's, has k4 to k6 below the line. OPENCV_FISHEYE and what
 * COLMAP has of it with fewer terms are OpenCV's fisheye model, and so is is_fisheye, which instant-ngp writes.
 */
adcgs_status adcgs_json_lens(const adcgs_json_place *at, adcgs_lens *lens);
/** The frame's transform_matrix, converted to OpenCV axes. */
adcgs_status adcgs_json_pose(const adcgs_json_place *at, adcgs_camera *camera);

#endif

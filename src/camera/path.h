/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Which frames to render: a camera and a time for each. */
#ifndef ADCGS_CAMERA_PATH_H
#define ADCGS_CAMERA_PATH_H

#include "base/base.h"

#include <adcgs/decoder.h>

typedef struct adcgs_shot {
    adcgs_camera camera;
    double time; /**< seconds */
} adcgs_shot;

typedef struct adcgs_shots {
    int n;
    int outside;       /**< how many are before the stream begins or after it ends; they show its first or last moment */
    double frame_rate; /**< to play them at, > 0 */
    adcgs_shot *shot;
} adcgs_shots;

typedef struct adcgs_shots_request {
    const char *camera; /**< stored camera's name or index, orbit, spiral, bullet, or a .json file; NULL: 0, else orbit */
    int has_times;
    double begin, end;  /**< seconds; the stream's whole span without them */
    int size[2];        /**< 0, 0: the camera's own; else what it sees is fitted to it: adcgs_camera_fit() */
    int fill;           /**< as adcgs_camera_fit() has it */
} adcgs_shots_request;

/** ADCGS_ERR_USAGE if times are given and the stream has none of them. */
adcgs_status adcgs_shots_check_times(const adcgs_info *info, const adcgs_shots_request *request, adcgs_error *error);
adcgs_status adcgs_shots_make(adcgs_shots *out, const adcgs_decoder *decoder, const adcgs_shots_request *request,
                              adcgs_error *error);
void adcgs_shots_free(adcgs_shots *shots);

/**
 * What rendering through a camera ended with. ADCGS_ERR_USAGE, which is a camera that the renderer refuses, becomes
 * ADCGS_ERR_DATA: it came from a file. The message names the camera.
 */
adcgs_status adcgs_shots_rendered(const adcgs_camera *camera, adcgs_status status, adcgs_error *error);

/** Write the stored cameras as a path of key frames, a second apart, for adcgs_shots_make() to read and the user to change. */
adcgs_status adcgs_shots_write_path(const adcgs_decoder *decoder, const char *path, adcgs_error *error);

/* What follows is for the files of this part alone. */
#define ADCGS_SHOTS_MAX 1000000
#define ADCGS_ORBIT_WIDTH 800
#define ADCGS_ORBIT_HEIGHT 600
#define ADCGS_NEAR_PER_SCALE 0.01 /* near plane of cameras that do not say, per scene unit */
#define ADCGS_SHOTS_SECONDS 4.0 /* a path round a scene that stands still */

/** who asks for so many, for the message: a file; NULL: the user, whose wrong use it is. */
adcgs_status adcgs_shots_alloc(adcgs_shots *shots, double n, const char *who, adcgs_error *error);

typedef enum adcgs_shots_motion {
    ADCGS_SHOTS_FIXED,  /**< the camera stands */
    ADCGS_SHOTS_MOVING, /**< it moves, so it takes its time where the scene stands still */
    ADCGS_SHOTS_FROZEN  /**< it moves, and the scene stands still */
} adcgs_shots_motion;

/** Shots with times only, at the stream's frame rate, both ends included; a still scene lasts ADCGS_SHOTS_SECONDS. */
adcgs_status adcgs_shots_times(adcgs_shots *out, const adcgs_info *info, const adcgs_shots_request *request,
                               adcgs_shots_motion motion, adcgs_error *error);
/** A camera where the stream stores none; up: that of the stream, of length 1. */
void adcgs_shots_default(adcgs_camera *camera, const adcgs_info *info, const double up[3]);

/** What drawing a path round the stored cameras takes. */
typedef struct adcgs_rig {
    int n;
    adcgs_camera *cameras; /**< the stored ones, fitted to the first one's size; one of our own if there is none */
    double focus[3];       /**< centre of the scene */
    double distance;       /**< a typical one to it, > 0 */
    double up[3];          /**< the cameras' on the mean, of length 1 */
} adcgs_rig;

adcgs_status adcgs_rig_init(adcgs_rig *rig, const adcgs_decoder *decoder, const adcgs_info *info, const double up[3],
                            adcgs_error *error);
void adcgs_rig_clear(adcgs_rig *rig);
/** Two turns of a spiral round the mean pose, looking at the focus. Sets the cameras; times are set already. */
void adcgs_rig_spiral(const adcgs_rig *rig, adcgs_shots *shots);
/** Once along all cameras in the order of their angles round the focus. Sets the cameras; needs three of them. */
adcgs_status adcgs_rig_bullet(const adcgs_rig *rig, adcgs_shots *shots, adcgs_error *error);

/**
 * A path from {"frames": [{"time": seconds, "transform_matrix": camera-to-world in OpenGL axes}], "fl_x": ..., "w": ...,
 * "h": ...}. Frames without a time follow each other at the stream's frame rate. With "keys" in place of "frames" each also has
 * "at", seconds along the path, and frames are made between them at "frame_rate".
 */
adcgs_status adcgs_shots_read_path(adcgs_shots *out, const adcgs_info *info, const adcgs_shots_request *request,
                                   double near_plane, adcgs_error *error);

#endif

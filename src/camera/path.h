/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Which frames to render: a camera and a time for each. */
#ifndef ADCGS_CAMERA_PATH_H
#define ADCGS_CAMERA_PATH_H

#include "base/base.h"

#include <adcgs/types.h>

typedef struct adcgs_camera_frame {
    adcgs_camera camera;
    double time; /**< seconds */
} adcgs_camera_frame;

typedef struct adcgs_camera_path {
    int n;
    int outside;       /**< how many are before the stream begins or after it ends; they show its first or last moment */
    double frame_rate; /**< to play them at, > 0 */
    adcgs_camera_frame *frame;
} adcgs_camera_path;

/** Which axis a rotation by three angles turns about first, second, third: rows of adcgs_rotation_orders. */
typedef enum adcgs_rotation_order {
    ADCGS_ROTATION_XYZ,
    ADCGS_ROTATION_XZY,
    ADCGS_ROTATION_YXZ,
    ADCGS_ROTATION_YZX,
    ADCGS_ROTATION_ZXY,
    ADCGS_ROTATION_ZYX
} adcgs_rotation_order;

/** Their names, "xyz" and so on, ended by NULL. */
extern const char *const adcgs_rotation_orders[];

typedef struct adcgs_camera_path_request {
    const char *camera; /**< stored camera's name or index, orbit, spiral, bullet, or a path's file; NULL: 0, else orbit */
    adcgs_rotation_order order; /**< of the angles in a .chan file */
    int has_times;
    double begin, end;  /**< seconds; the stream's whole span without them */
    int size[2];        /**< 0, 0: the camera's own; else what it sees is fitted to it: adcgs_camera_fit() */
    int fill;           /**< as adcgs_camera_fit() has it */
} adcgs_camera_path_request;

/** ADCGS_ERR_USAGE if times are given and the stream has none of them. */
adcgs_status adcgs_camera_path_check_times(const adcgs_info *info, const adcgs_camera_path_request *request, adcgs_error *error);
adcgs_status adcgs_camera_path_make(adcgs_camera_path *out, const adcgs_decoder *decoder,
                                    const adcgs_camera_path_request *request, adcgs_error *error);
void adcgs_camera_path_free(adcgs_camera_path *frames);

/**
 * What rendering through a camera ended with. ADCGS_ERR_USAGE, which is a camera that the renderer refuses, becomes
 * ADCGS_ERR_DATA: it came from a file. The message names the camera.
 */
adcgs_status adcgs_camera_path_rendered(const adcgs_camera *camera, adcgs_status status, adcgs_error *error);

/** A key frame of a path. */
typedef struct adcgs_camera_key {
    double at; /**< where on the path, in seconds or any other unit; each more than the one before */
    adcgs_camera_frame frame;
} adcgs_camera_key;

/**
 * Write key frames of one size as a path for adcgs_camera_path_make() to read, in the format that its name tells: .chan, .usda,
 * else JSON. has_times: with their times, which are the scene's. order: of angles in a .chan file. Atomic.
 */
adcgs_status adcgs_camera_keys_write(const adcgs_camera_key *keys, int n, int has_times, const adcgs_info *info,
                                     double frame_rate, adcgs_rotation_order order, const char *path, adcgs_error *error);
/** The same of frames, or where these are NULL of the stored cameras, a second apart, to begin one's own path with. */
adcgs_status adcgs_camera_path_write(const adcgs_decoder *decoder, const adcgs_camera_path *frames, adcgs_rotation_order order,
                                     const char *path, adcgs_error *error);

/* What follows is for the files of this part alone. */
#define ADCGS_PATH_FRAMES_MAX 1000000
#define ADCGS_ORBIT_WIDTH 800
#define ADCGS_ORBIT_HEIGHT 600
#define ADCGS_NEAR_PER_SCALE 0.01 /* near plane of cameras that do not say, per scene unit */
#define ADCGS_PATH_SECONDS 4.0 /* a path round a scene that stands still */

/** who asks for so many, for the message: a file; NULL: the user, whose wrong use it is. */
adcgs_status adcgs_camera_path_alloc(adcgs_camera_path *frames, double n, const char *who, adcgs_error *error);

typedef enum adcgs_camera_path_motion {
    ADCGS_PATH_FIXED,  /**< the camera stands */
    ADCGS_PATH_MOVING, /**< it moves, so it takes its time where the scene stands still */
    ADCGS_PATH_FROZEN  /**< it moves, and the scene stands still */
} adcgs_camera_path_motion;

/** Frames with times only, at the stream's frame rate, both ends included; a still scene lasts ADCGS_PATH_SECONDS. */
adcgs_status adcgs_camera_path_times(adcgs_camera_path *out, const adcgs_info *info, const adcgs_camera_path_request *request,
                               adcgs_camera_path_motion motion, adcgs_error *error);
/** A camera where the stream stores none; up: that of the stream, of length 1. */
void adcgs_camera_path_default(adcgs_camera *camera, const adcgs_info *info, const double up[3]);

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
/**
 * Two turns of a spiral round the mean pose, looking at the focus, as Mildenhall et al. (LLFF, 2019) show scenes. Sets the
 * cameras; times are set already.
 */
void adcgs_rig_spiral(const adcgs_rig *rig, adcgs_camera_path *frames);
/** Once along all cameras by their angles round the focus, known as bullet time. Sets the cameras; needs three of them. */
adcgs_status adcgs_rig_bullet(const adcgs_rig *rig, adcgs_camera_path *frames, adcgs_error *error);

/**
 * A path from a file: .chan, USD, or JSON: {"frames": [{"time": seconds, "transform_matrix": camera-to-world in OpenGL axes}],
 * "fl_x": ..., "w": ..., "h": ...}. Frames without a time follow each other at the stream's frame rate. With "keys" in place of
 * "frames" each also has "at", seconds along the path, and frames are made between them at "frame_rate". like: a camera for what
 * other formats do not say, and the near plane of all.
 */
adcgs_status adcgs_camera_path_read(adcgs_camera_path *out, const adcgs_info *info, const adcgs_camera_path_request *request,
                                    const adcgs_camera *like, adcgs_error *error);

#endif

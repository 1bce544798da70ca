/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Camera paths: a camera and a time for each frame to render. */
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
    int outside;       /**< number of frames outside the stream's time span; they show its first or last time */
    double frame_rate; /**< frame rate for playback, > 0 */
    adcgs_camera_frame *frame;
} adcgs_camera_path;

/** The axes of a rotation by three angles, in order of application: rows of adcgs_rotation_orders. */
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
    const char *camera;         /**< name or index of a stored camera, follow, orbit, spiral, bullet, or the file of a path; NULL:
                             follow, without a filmed path the camera 0, without cameras orbit */
    adcgs_rotation_order order; /**< of the angles in a .chan file */
    int has_times;
    double begin, end; /**< seconds; by default the stream's whole span */
    int size[2];       /**< 0, 0: the camera's own; else its view is fitted to it by adcgs_camera_fit() */
    int fill;          /**< parameter of adcgs_camera_fit() */
} adcgs_camera_path_request;

/**
 * The index of the stored camera with this name, else number. Otherwise ADCGS_ERR_USAGE; advice follows the message if the stream
 * stores no cameras.
 */
adcgs_status adcgs_camera_find_stored(int *index, const adcgs_decoder *decoder, const adcgs_info *info, const char *wanted,
                                      const char *advice, adcgs_error *error);
/** ADCGS_ERR_USAGE if times are given and none of them is in the stream. */
adcgs_status adcgs_camera_path_check_times(const adcgs_info *info, const adcgs_camera_path_request *request, adcgs_error *error);
/** The decoder is used to find the centre of an orbit, if it has a segment to render. */
adcgs_status adcgs_camera_path_make(adcgs_camera_path *out, adcgs_decoder *decoder, const adcgs_camera_path_request *request,
                                    adcgs_error *error);
void adcgs_camera_path_free(adcgs_camera_path *frames);

/**
 * Status of rendering through a camera. ADCGS_ERR_USAGE, for a camera that the renderer rejects, becomes ADCGS_ERR_DATA, since
 * the camera came from a file. The message names the camera.
 */
adcgs_status adcgs_camera_path_rendered(const adcgs_camera *camera, adcgs_status status, adcgs_error *error);

/** A key frame of a path. */
typedef struct adcgs_camera_key {
    double at; /**< position on the path, in seconds or any other unit; strictly ascending */
    adcgs_camera_frame frame;
} adcgs_camera_key;

/**
 * Write key frames of one size as a path for adcgs_camera_path_make(). The extension gives the format: .chan, .usda, else JSON.
 * has_times: with their times, which are the scene's. order: of angles in a .chan file. Atomic.
 */
adcgs_status adcgs_camera_keys_write(const adcgs_camera_key *keys, int n, int has_times, const adcgs_info *info,
                                     double frame_rate, adcgs_rotation_order order, const char *path, adcgs_error *error);
/**
 * The same for frames. If NULL, for the filmed path with its times; without such a path for the stored cameras, one per second,
 * as a start for a path of one's own.
 */
adcgs_status adcgs_camera_path_write(const adcgs_decoder *decoder, const adcgs_camera_path *frames, adcgs_rotation_order order,
                                     const char *path, adcgs_error *error);

/* The declarations below are for the files of this part only. */
/* Origin: chosen by hand, not measured. */
#define ADCGS_PATH_FRAMES_MAX 1000000 /**< frames of a path */
#define ADCGS_ORBIT_WIDTH 800         /**< image width of cameras without one, pixels */
#define ADCGS_ORBIT_HEIGHT 600        /**< image height of cameras without one, pixels */
#define ADCGS_NEAR_PER_SCALE 0.01     /* near plane of cameras without one, per scene unit */
#define ADCGS_PATH_SECONDS 4.0        /* duration of a path around a static scene, seconds */

/** who: source of the number n in messages, a file; NULL: the user, for a usage error. */
adcgs_status adcgs_camera_path_alloc(adcgs_camera_path *frames, double n, const char *who, adcgs_error *error);

typedef enum adcgs_camera_path_motion {
    ADCGS_PATH_FIXED,  /**< the camera is fixed */
    ADCGS_PATH_MOVING, /**< it moves, so the path also lasts some time in a static scene */
    ADCGS_PATH_FROZEN  /**< it moves, and the scene's time is frozen */
} adcgs_camera_path_motion;

/** Frames with times only, at the stream's frame rate, both ends included; a static scene lasts ADCGS_PATH_SECONDS. */
adcgs_status adcgs_camera_path_times(adcgs_camera_path *out, const adcgs_info *info, const adcgs_camera_path_request *request,
                                     adcgs_camera_path_motion motion, adcgs_error *error);
/** A camera for a stream without any; up: that of the stream, of length 1. */
void adcgs_camera_path_default(adcgs_camera *camera, const adcgs_info *info, const double up[3]);

/** Data for paths around the stored cameras. */
typedef struct adcgs_rig {
    int n;
    adcgs_camera *cameras; /**< the stored cameras, fitted to the first one's size; a default camera if there is none */
    double focus[3];       /**< centre of the scene */
    double distance;       /**< typical distance of the cameras to it, > 0 */
    double up[3];          /**< mean of the cameras' up axes, of length 1 */
} adcgs_rig;

adcgs_status adcgs_rig_init(adcgs_rig *rig, const adcgs_decoder *decoder, const adcgs_info *info, const double up[3],
                            adcgs_error *error);
void adcgs_rig_clear(adcgs_rig *rig);
/**
 * Two turns of a spiral around the mean pose, looking at the focus, as Mildenhall et al. (LLFF, 2019) show scenes. Sets the
 * cameras; times must be set already.
 */
void adcgs_rig_spiral(const adcgs_rig *rig, adcgs_camera_path *frames);
/**
 * One pass along all cameras in order of their angles around the focus, known as bullet time. Sets the cameras; needs three of
 * them.
 */
adcgs_status adcgs_rig_bullet(const adcgs_rig *rig, adcgs_camera_path *frames, adcgs_error *error);

/**
 * Read a path from a file: .chan, USD, or JSON: {"frames": [{"time": seconds, "transform_matrix": camera-to-world in OpenGL
 * axes}], "fl_x": ..., "w": ..., "h": ...}. Frames without a time follow each other at the stream's frame rate. With "keys" in
 * place of "frames" each also has "at", seconds along the path, and frames are interpolated at "frame_rate". like: a camera with
 * the values that other formats lack, and the near plane of all.
 */
adcgs_status adcgs_camera_path_read(adcgs_camera_path *out, const adcgs_info *info, const adcgs_camera_path_request *request,
                                    const adcgs_camera *like, adcgs_error *error);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Cameras and frames: what the renderer takes and gives.
 */
#ifndef ADCGS_CAMERA_H
#define ADCGS_CAMERA_H

#include <stddef.h>
#include <stdint.h>

#include <adcgs/status.h>

#ifdef __cplusplus
extern "C" {
#endif

#define ADCGS_CAMERA_NAME_MAX 63

/**
 * A pinhole camera. Axes are OpenCV's: x right, y down, looking along +z.
 * A point (X, Y, Z) in camera coordinates falls on u = fx X/Z + cx,
 * v = fy Y/Z + cy, in pixels; the image covers [0,width] x [0,height], so the
 * centre of the first pixel is at (0.5, 0.5).
 */
typedef struct adcgs_camera {
    int32_t width, height;   /**< pixels, 1..16384 */
    double fx, fy;           /**< focal lengths in pixels, > 0 */
    double cx, cy;           /**< principal point in pixels */
    double cam_to_world[12]; /**< row-major 3x4 [R|c], world units; R orthonormal */
    double near_plane;       /**< world units, > 0: nothing closer is drawn */
    char name[ADCGS_CAMERA_NAME_MAX + 1];
} adcgs_camera;

/**
 * A rendered frame, linear in memory as [height][width][3] binary32, RGB in the
 * stream's transfer characteristic, 0 black to 1 white, not clipped.
 */
typedef struct adcgs_frame {
    int32_t width, height;
    float *rgb; /**< [height][width][3], owned by whoever allocated it */
} adcgs_frame;

/** Convert to 8 bits: q = floor(clip(v,0,1)*255 + 0.5) in binary32 (spec clause "Output conversion"). out: [n]. */
ADCGS_API void adcgs_frame_to_u8(const adcgs_frame *frame, uint8_t *out);

/** Digest (MD5) of a frame's values in memory order, each as a little-endian binary32: conformance point R. */
ADCGS_API void adcgs_frame_digest(const adcgs_frame *frame, uint8_t digest[16]);

#ifdef __cplusplus
}
#endif
#endif

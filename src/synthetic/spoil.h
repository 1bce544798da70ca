/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Common faults of captures, in graded strength: unequal exposure, wrong poses, unsynchronised cameras, times without images.
 * Only training views are affected; validation and test views stay correct. Random numbers depend on the camera or the image
 * only, so that a stronger fault is the same fault, amplified.
 */
#ifndef ADCGS_SYNTHETIC_SPOIL_H
#define ADCGS_SYNTHETIC_SPOIL_H

#include "base/thread_pool.h"

typedef enum adcgs_spoil_kind {
    ADCGS_SPOIL_EXPOSURE,  /**< stops: each camera's gain is 2 to a random power between plus and minus this strength */
    ADCGS_SPOIL_WHITE,     /**< stops: the same for each channel of each camera */
    ADCGS_SPOIL_STEP,      /**< stops: images in the second half of the time are darker by this strength */
    ADCGS_SPOIL_POSE,      /**< pixels: each camera is turned by a constant error of this deviation */
    ADCGS_SPOIL_SHAKE,     /**< pixels: the camera of each image is turned by an error of its own */
    ADCGS_SPOIL_WRONGPOSE, /**< degrees: only the camera in the middle is turned, about the vertical */
    ADCGS_SPOIL_AXES,      /**< 1: y and z of all cameras are negated; 2: poses are world-to-camera; 3: x is mirrored */
    ADCGS_SPOIL_SYNC,      /**< frame intervals: each camera is late or early by up to this strength */
    ADCGS_SPOIL_DROP,      /**< share of images that are missing, at random */
    ADCGS_SPOIL_TWICE,     /**< share of images that are replaced by the previous one (duplicate frames) */
    ADCGS_SPOIL_BEFORE,    /**< share of the time without images, at the beginning */
    ADCGS_SPOIL_INSIDE,    /**< share of the time without images, in the middle */
    ADCGS_SPOIL_AFTER,     /**< share of the time without images, at the end */
    ADCGS_SPOIL_TINT,      /**< stops: in the second half of the time, red is brighter and blue darker by half of this strength */
    ADCGS_SPOILS
} adcgs_spoil_kind;

typedef struct adcgs_spoil {
    double strength[ADCGS_SPOILS]; /**< 0: no fault */
} adcgs_spoil;

/** A training image. */
typedef struct adcgs_spoil_picture {
    int camera, cameras; /**< index of its camera, and number of cameras */
    int number;          /**< of the image */
    int width;           /**< pixels */
    double time, step;   /**< of the image, and the interval between times */
    double stops;        /**< exposure of the image relative to the truth; it belongs to the scene and is no fault */
} adcgs_spoil_picture;

/** NAME=STRENGTH[,NAME=STRENGTH]; NULL or "" means no fault. */
adcgs_status adcgs_spoil_parse(adcgs_spoil *out, const char *text, adcgs_error *error);

/** True if the image is missing. */
int adcgs_spoil_hides(const adcgs_spoil *spoil, const adcgs_spoil_picture *picture);
/** The actual time of the image, 0 to 1, regardless of the written one. */
double adcgs_spoil_time(const adcgs_spoil *spoil, const adcgs_spoil_picture *picture);
/** Converts the true pose to the written pose, row-major 3x4 in OpenGL's axes; focal is in pixels. */
void adcgs_spoil_pose(const adcgs_spoil *spoil, const adcgs_spoil_picture *picture, double focal, double to_world[12]);
/** Applies the image's exposure to its pixels, interleaved rgb. */
void adcgs_spoil_pixels(const adcgs_spoil *spoil, const adcgs_spoil_picture *picture, float *rgb, size_t pixels);

#endif

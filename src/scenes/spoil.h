/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * What goes wrong where scenes are filmed, in graded strength: cameras that are exposed unlike each other, that do not stand
 * where they are said to, or that are not in step; moments that nobody saw. Only training's views are spoilt: those for
 * validation and testing stay true. Random numbers are those of a camera or a picture, so that a stronger fault is the same one,
 * only stronger.
 */
#ifndef ADCGS_SCENES_SPOIL_H
#define ADCGS_SCENES_SPOIL_H

#include "base/pool.h"

typedef enum adcgs_spoil_kind {
    ADCGS_SPOIL_EXPOSURE, /**< stops: each camera's gain is 2 to a power between plus and minus so many */
    ADCGS_SPOIL_WHITE,    /**< stops: that of each channel of each camera */
    ADCGS_SPOIL_STEP,     /**< stops: the pictures of the second half of the time are so much darker */
    ADCGS_SPOIL_POSE,     /**< pixels: each camera is turned by an error of this deviation, always the same */
    ADCGS_SPOIL_SHAKE,    /**< pixels: each picture's camera is, by an error of its own */
    ADCGS_SPOIL_WRONGPOSE, /**< degrees: the camera in the middle alone is turned about the vertical by so many */
    ADCGS_SPOIL_AXES,     /**< 1: y and z of all cameras point the other way; 2: poses from world to camera; 3: x is mirrored */
    ADCGS_SPOIL_SYNC,     /**< moments: each camera is up to so many late or early */
    ADCGS_SPOIL_DROP,     /**< share of the pictures that are missing, here and there */
    ADCGS_SPOIL_TWICE,    /**< share of the pictures in place of which the one of the moment before comes again */
    ADCGS_SPOIL_BEFORE,   /**< share of the time, at its beginning, from which there is no picture */
    ADCGS_SPOIL_INSIDE,   /**< in the middle */
    ADCGS_SPOIL_AFTER,    /**< at the end */
    ADCGS_SPOIL_TINT,     /**< stops: in the second half of the time red is half of that brighter, and blue darker */
    ADCGS_SPOILS
} adcgs_spoil_kind;

typedef struct adcgs_spoil {
    double strength[ADCGS_SPOILS]; /**< 0: it is as it should be */
} adcgs_spoil;

/** A picture for training. */
typedef struct adcgs_spoil_picture {
    int camera, cameras; /**< which of how many took it */
    int number;          /**< of the picture */
    int width;           /**< pixels */
    double time, step;   /**< of the picture, and from one moment to the next */
    double stops;        /**< exposure of the image relative to the truth, which is the scene's own and no fault */
} adcgs_spoil_picture;

/** NAME=STRENGTH[,NAME=STRENGTH]; NULL or "" spoils nothing. */
adcgs_status adcgs_spoil_parse(adcgs_spoil *out, const char *text, adcgs_error *error);

/** Is the picture not there? */
int adcgs_spoil_hides(const adcgs_spoil *spoil, const adcgs_spoil_picture *picture);
/** The time at which it was taken, 0 to 1, whatever is said. */
double adcgs_spoil_time(const adcgs_spoil *spoil, const adcgs_spoil_picture *picture);
/** From the camera that took it, with a focal length in pixels, to the pose that is written, row-major 3x4 in OpenGL's axes. */
void adcgs_spoil_pose(const adcgs_spoil *spoil, const adcgs_spoil_picture *picture, double focal, double to_world[12]);
/** Its pixels, rgb interleaved, with its exposure. */
void adcgs_spoil_pixels(const adcgs_spoil *spoil, const adcgs_spoil_picture *picture, float *rgb, size_t pixels);

#endif

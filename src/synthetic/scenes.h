/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Scenes with ground truth: small animated worlds, ray traced, written in the layout of D-NeRF
 * (transforms_{train,val,test}.json and a folder of images each). Name, size and motion determine every byte: all uses only + -
 * * / and sqrt on doubles, own sine and cosine, and counter-based random numbers.
 *
 * In a scene with moving objects, each validation and test image has a mask of the moving regions, which its frame names as
 * moving_path. The mask NAME_moving is white where, for at least half of a pixel's samples, the nearest surface belongs to a
 * moving object, else black.
 */
#ifndef ADCGS_SYNTHETIC_SCENES_H
#define ADCGS_SYNTHETIC_SCENES_H

#include "synthetic/spoil.h"

typedef struct adcgs_scenes_options {
    const char *name;   /**< of the scene, see adcgs_scenes_name() */
    int width, height;  /**< of the images; 0: the scene's own size */
    const char *format; /**< extension of the images: "png" or "ppm"; NULL: "png" */
    int frames;         /**< times that the training cameras see, 1 to 100000, over the same duration; 0: the scene's own */
    int cameras;        /**< training cameras, 1 to 1000; 0: the scene's own. The number that sees each time stays that of the
                             scene, or all if they are fewer */
    int watch;          /**< 0, or the number of validation views, 2 to 1000, in order of time, of one fixed camera */
    double aside;       /**< 0, or the turns, up to 0.5, by which test cameras stand beyond the last training camera */
    adcgs_spoil spoil;  /**< faults of training images and cameras */
    double noise;       /**< levels of 255, 0 to 64: deviation of the noise added to each channel of training images */
    double motion;      /**< 0.001 to 10, factor of all motion: speed, bounces, turns, orbits, change of colour, and times of
                             appearance and disappearance; 0.1 is a tenth of the motion; 0: 1 */
} adcgs_scenes_options;

/** Name and one-line description of scene i; NULL past the last. */
const char *adcgs_scenes_name(int i);
const char *adcgs_scenes_about(int i);

/** Called after each image. */
typedef void (*adcgs_scenes_progress_fn)(void *user, int done, int total);

/** Renders a scene into a folder, which is created if needed. pool may be NULL. */
adcgs_status adcgs_scenes_write(const char *directory, const adcgs_scenes_options *options, adcgs_pool *pool,
                                adcgs_scenes_progress_fn progress, void *user, adcgs_error *error);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Scenes with known truth: small animated worlds, ray traced, written in the
 * layout of D-NeRF (transforms_{train,val,test}.json and a folder of pictures
 * each). Every byte follows from the name, the size and the motion: only + - * / and sqrt
 * on doubles, own sine and cosine, counter-based random numbers.
 *
 * Beside the pictures for validation and testing of a scene in which something moves lie masks of what moves, which their frames
 * name as moving_path: NAME_moving, white where the nearest surface is, for at least half of a pixel's samples, that of an object
 * that moves, else black.
 */
#ifndef ADCGS_SCENES_SCENES_H
#define ADCGS_SCENES_SCENES_H

#include "scenes/spoil.h"

typedef struct adcgs_scenes_options {
    const char *name;   /**< of the scene, see adcgs_scenes_name() */
    int width, height;  /**< of the pictures; 0: the scene's own size */
    const char *format; /**< extension of the pictures: "png" or "ppm"; NULL: "png" */
    int moments;        /**< that training's cameras see, 1 to 100000, in the same time; 0: the scene's own */
    int cameras;        /**< for training, 1 to 1000, as many of which see a moment as otherwise, or all of them, if they are
                             fewer; 0: the scene's own */
    int watch;          /**< 0, or so many views for validation, 2 to 1000, one after the other, of one camera that stays */
    double aside;       /**< 0, or so many turns, to 0.5, beside the last of training's cameras are those for testing */
    adcgs_spoil spoil;  /**< what is wrong with training's pictures and cameras */
    double noise;       /**< levels of 255, 0 to 64: the deviation of what is added to each channel of training's pictures */
    double motion;      /**< 0.001 to 10: factor of all that moving objects do (speed, bounces, turns, orbits, change of colour)
                             and of the times from which they are there, so that 0.1 is a tenth of the motion; 0: 1 */
} adcgs_scenes_options;

/** Name and one line about scene i; NULL past the last. */
const char *adcgs_scenes_name(int i);
const char *adcgs_scenes_about(int i);

/** Number of pictures of the three splits together, 0 if there is no such scene. */
int adcgs_scenes_count(const char *name);

/** Called after each picture. */
typedef void (*adcgs_scenes_progress_fn)(void *user, int done, int total);

/** Render a scene into a folder, which is made if need be. pool may be NULL. */
adcgs_status adcgs_scenes_write(const char *directory, const adcgs_scenes_options *options, adcgs_pool *pool,
                                adcgs_scenes_progress_fn progress, void *user, adcgs_error *error);

#endif

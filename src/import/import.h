/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Footage whose cameras nobody knows, made a scene: pictures, a video of a camera that moves, or videos of cameras that stand and
 * run in step. Pictures are taken out, made upright and of bounded size; COLMAP finds the cameras; a scene file says what came
 * of it. The folder appears whole or not at all: until then it is called as the output with ".importing" behind it, which holds
 * COLMAP's log, and from which the next run with the same footage goes on.
 */
#ifndef ADCGS_IMPORT_IMPORT_H
#define ADCGS_IMPORT_IMPORT_H

#include "cli/cli.h"
#include "io/fps.h"

/** With more numbers a lens is told better from many pictures; few may agree on whatever they are. */
typedef enum adcgs_import_lens {
    ADCGS_IMPORT_RADIAL,
    ADCGS_IMPORT_PINHOLE,
    ADCGS_IMPORT_OPENCV,
    ADCGS_IMPORT_FISHEYE,
} adcgs_import_lens;

typedef struct adcgs_import_options {
    char *const *inputs; /**< files and folders, as on the command line */
    int n_inputs;
    const char *output;  /**< the folder to be made */
    const char *colmap;  /**< the program */
    const char *masks;   /**< a folder, or NULL */
    int side;            /**< width and height of pictures at most */
    int frames;          /**< of a moving camera's video at most */
    int test_every;      /**< every so many views, or cameras that stand, for testing; 0: none */
    int lens;            /**< adcgs_import_lens */
    int own_lens;        /**< each camera of a rig has intrinsics of its own */
    int threads;         /**< of COLMAP; 0: one per processor */
    adcgs_fps fps;       /**< of pictures that were taken one after the other; not known: at one time */
} adcgs_import_options;

/** How good the poses are. */
typedef struct adcgs_import_report {
    const char *kind;         /**< "pictures", "film" or "rig" */
    uint32_t pictures, posed; /**< that COLMAP got, and those whose pose it found */
    uint32_t cameras, found;  /**< that stand, of a rig, and those whose pose was found; else 0 */
    uint32_t models;          /**< that COLMAP made, of which the largest is taken */
    uint32_t points;          /**< for training to begin with */
    double error;             /**< mean distance of points from where they were seen, in pixels */
    double track;             /**< pictures that see a point, on average */
    double spread;            /**< of a rig: how far its cameras' poses at other moments lie, over the cameras' mean distance */
    double seconds;           /**< of the footage */
    int width, height;        /**< of the first picture */
    int is_numbered;          /**< pictures without times whose names only count: perhaps frames of a film */
} adcgs_import_report;

/**
 * ADCGS_ERR_USAGE where operands do not go together or the output is there already, ADCGS_ERR_UNSUPPORTED without COLMAP,
 * ADCGS_ERR_DATA where it finds no poses.
 */
adcgs_status adcgs_import(const adcgs_import_options *options, adcgs_progress *progress, adcgs_import_report *report,
                          adcgs_error *error);

#endif

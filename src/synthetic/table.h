/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The scenes as data: the objects, the moving ones among them, and the cameras and times. table.c has scenes on a table, with
 * one difficulty each; capture_scenes.c has scenes that imitate common captures.
 */
#ifndef ADCGS_SYNTHETIC_TABLE_H
#define ADCGS_SYNTHETIC_TABLE_H

#include "synthetic/trace.h"

#define ADCGS_SCENES_FOCAL 2.5 /**< focal length, in halves of the image's width; chosen by hand */
#define ADCGS_SCENES_WIDE 1.25 /**< the same for scenes that surround their cameras; chosen by hand */

/** Arrangement of a scene's cameras. */
typedef enum adcgs_scenes_path {
    ADCGS_PATH_ARC,    /**< on an arc of 140 degrees that looks at the target */
    ADCGS_PATH_HAND,   /**< one hand-held camera, back and forth */
    ADCGS_PATH_ROUND,  /**< on a sphere except its lower third */
    ADCGS_PATH_WALK,   /**< on a circle about the target, looking away from it */
    ADCGS_PATH_DRIVE,  /**< side by side on a car that drives along y */
    ADCGS_PATH_FRONT,  /**< in front of the target, within 30 degrees */
    ADCGS_PATH_TRIPOD, /**< one camera that never moves */
    ADCGS_PATH_SWEEP   /**< along x, with optical axes that meet behind the cameras */
} adcgs_scenes_path;

/** Appearance of pixels that no object covers. */
typedef enum adcgs_scenes_ground {
    ADCGS_GROUND_BLACK, /**< black, without alpha */
    ADCGS_GROUND_ALPHA, /**< transparent: RGBA, straight alpha */
    ADCGS_GROUND_WHITE  /**< white, without alpha */
} adcgs_scenes_ground;

typedef struct adcgs_scenes_entry {
    const char *name, *about;
    const adcgs_trace_object *objects;
    int n_objects;
    uint32_t moving;    /**< bit i: object i moves; the others keep the pose of time 0 */
    int size;           /**< width, and height if that is 0 */
    int height;         /**< 0: as high as wide */
    int cameras, times; /**< times 1: a static scene, whose views have no time */
    int turns;          /**< each time is seen by every turns-th camera, a different set at each time; divides cameras */
    double swings;      /**< 0, or the number of swings of a single hand-held camera */
    int n_val, n_test;
    double distance; /**< of the cameras from the target */
    double target[3];
    adcgs_scenes_path path;
    adcgs_scenes_ground ground;
    int is_wide;  /**< focal length ADCGS_SCENES_WIDE */
    int samples;  /**< rays per pixel along each axis; 0: 3 */
    double stops; /**< exposures of training cameras: evenly between plus and minus this many stops, mean 0 */
} adcgs_scenes_entry;

/** The scenes that imitate common captures, terminated by an entry without a name. */
extern const adcgs_scenes_entry adcgs_scenes_captures[];

/** Entry i of the table, NULL past the last. */
const adcgs_scenes_entry *adcgs_scenes_entry_at(int i);
const adcgs_scenes_entry *adcgs_scenes_entry_find(const char *name);

#endif

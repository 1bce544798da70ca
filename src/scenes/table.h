/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The scenes as data: which objects, which of them move, from where and when they are seen. table.c has those on a table, one
 * difficulty each; captures.c those that are filmed as other people film.
 */
#ifndef ADCGS_SCENES_TABLE_H
#define ADCGS_SCENES_TABLE_H

#include "scenes/trace.h"

#define ADCGS_SCENES_FOCAL 2.5 /**< focal length, in halves of the image's width */
#define ADCGS_SCENES_WIDE 1.25 /**< that of scenes that surround their cameras */

/** Where the cameras of a scene stand. */
typedef enum adcgs_scenes_path {
    ADCGS_PATH_ARC,    /**< on an arc of 140 degrees that looks at the target */
    ADCGS_PATH_HAND,   /**< one camera held in a hand, to and fro */
    ADCGS_PATH_ROUND,  /**< on all of a sphere but its lower third */
    ADCGS_PATH_WALK,   /**< on a circle about the target, looking away from it */
    ADCGS_PATH_DRIVE,  /**< side by side on a car that drives along y */
    ADCGS_PATH_FRONT,  /**< in front of the target, within 30 degrees */
    ADCGS_PATH_TRIPOD, /**< one camera that never moves */
    ADCGS_PATH_SWEEP   /**< along x, with optical axes that meet behind the cameras */
} adcgs_scenes_path;

/** How an image shows pixels that nothing covers. */
typedef enum adcgs_scenes_ground {
    ADCGS_GROUND_BLACK, /**< black, without alpha */
    ADCGS_GROUND_ALPHA, /**< transparent: RGBA, straight alpha */
    ADCGS_GROUND_WHITE  /**< white, without alpha */
} adcgs_scenes_ground;

typedef struct adcgs_scenes_entry {
    const char *name, *about;
    const adcgs_trace_object *objects;
    int n_objects;
    uint32_t moving;         /**< bit i: object i moves; the others keep the pose of time 0 */
    int size;                /**< width and height */
    int height;              /**< unless it is 0: it is as wide */
    int cameras, times;      /**< times 1: a static scene, whose views have no time */
    int turns; /**< each moment is seen by every turns-th camera, a different set from moment to moment; divides cameras */
    double swings; /**< 0, or one camera alone, held in a hand, goes to and fro so many times */
    int n_val, n_test;
    double distance;         /**< of the cameras from the target */
    double target[3];
    adcgs_scenes_path path;
    adcgs_scenes_ground ground;
    int is_wide;             /**< focal length ADCGS_SCENES_WIDE */
    int samples;             /**< rays per pixel along each axis; 0: 3 */
    double stops;            /**< exposures of training's cameras lie between plus and minus so many, evenly, their mean is 0 */
} adcgs_scenes_entry;

/** The entries of scenes as other people film them, the last without a name. */
extern const adcgs_scenes_entry adcgs_scenes_captures[];

/** Entry i of the table, NULL past the last. */
const adcgs_scenes_entry *adcgs_scenes_entry_at(int i);
const adcgs_scenes_entry *adcgs_scenes_entry_find(const char *name);

#endif

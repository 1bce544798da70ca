/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The scenes as data: which objects, which of them move, from where and when they are seen. */
#ifndef ADCGS_SCENES_TABLE_H
#define ADCGS_SCENES_TABLE_H

#include "scenes/trace.h"

#define ADCGS_SCENES_FOCAL 2.5 /**< focal length of every camera, in halves of the picture's width */

typedef struct adcgs_scenes_entry {
    const char *name, *about;
    const adcgs_trace_object *objects;
    int n_objects;
    uint32_t moving;         /**< bit i: object i moves; the others keep the pose of time 0 */
    int size;                /**< width and height */
    int cameras, times;
    int turns; /**< each moment is seen by every turns-th camera, a different set from moment to moment; divides cameras */
    double swings; /**< 0, or one camera alone, held in a hand, goes to and fro so many times */
    int n_val, n_test;
    double distance;         /**< of the cameras from the target */
    double target[3];
} adcgs_scenes_entry;

/** Entry i of the table, NULL past the last. */
const adcgs_scenes_entry *adcgs_scenes_entry_at(int i);
const adcgs_scenes_entry *adcgs_scenes_entry_find(const char *name);

#endif

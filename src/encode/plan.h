/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A scene's segments, planned before any is learnt: all that they have in common and all that one of them has to know to be
 * learnt anywhere, so that parts which are learnt apart, by whichever machine, make the stream that one program makes of
 * them. As a file it is JSON, with numbers in as many digits as they need.
 *
 * Part N of plan x.json, from 1, is the stream x.N.adcgs beside it, of that segment alone; before, x.N is its checkpoint. Two of
 * its notes say what it is of, and are of no other use: `plan`, the plan's digest, and `follows`, that of the model that it goes
 * on with.
 */
#ifndef ADCGS_ENCODE_PLAN_H
#define ADCGS_ENCODE_PLAN_H

#include "data/content.h"
#include "data/part.h"
#include "train/config.h"

#define ADCGS_PLAN_FORMAT 1
#define ADCGS_PLAN_DIGEST 33         /**< hexadecimal digits and a zero */
#define ADCGS_NOTE_PLAN "plan"
#define ADCGS_NOTE_FOLLOWS "follows"

typedef struct adcgs_plan_segment {
    uint8_t follows;  /**< it is learnt from the one before */
    uint32_t views;   /**< for training */
    double cost;      /**< seconds of one processor, roughly */
} adcgs_plan_segment;

/** Zero-initialise before use. */
typedef struct adcgs_plan {
    char encoder[64]; /**< the program that made it; another version's segments would be others */
    char digest[ADCGS_PLAN_DIGEST]; /**< of what the file says, however it is laid out; filled by reading */
    /* How the scene is opened. */
    char *scene;      /**< where it was; that it lies elsewhere does not matter */
    char *points;     /**< of initial points, or NULL */
    char *frames;     /**< as on the command line, or NULL */
    int dataset;
    adcgs_fps rate;   /**< asked for; den 0: the scene's */
    char outline[2 * ADCGS_CONTENT_BYTES + 1]; /**< adcgs_scene_outline() */
    int has_alpha;
    float background[3];
    /* How it is learnt. */
    adcgs_cpu_level cpu; /**< kernels differ in the last bit, and so do runs */
    adcgs_train_config config;
    /* How it is coded. */
    double origin[3], scale;
    uint32_t timebase_num, timebase_den;
    adcgs_cuts cuts;
    adcgs_plan_segment *segments; /**< [cuts.n] */
} adcgs_plan;

void adcgs_plan_clear(adcgs_plan *plan);

/** What learning costs of a part of a scene, in seconds of one processor: within a factor of two or three, alike for all. */
double adcgs_plan_cost(const adcgs_train_config *config, const adcgs_scene *part);

/** Write a plan for a scene, with the files that each segment needs. Where there is such a file it has to be the same plan. */
adcgs_status adcgs_plan_write(const adcgs_plan *plan, const adcgs_scene *scene, const char *path, adcgs_error *error);
/** ADCGS_ERR_DATA names the field that is missing or wrong. plan: cleared by the caller, also on failure. */
adcgs_status adcgs_plan_read(adcgs_plan *plan, const char *path, adcgs_error *error);

#endif

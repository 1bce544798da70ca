/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A plan of a scene's segments, made before training: the values that they share and everything that one segment needs to be
 * trained anywhere. Parts trained on separate machines then make the same stream as one program that trains them all. The file is
 * JSON, with as many digits as the numbers need.
 *
 * Part N (from 1) of plan x.json is the stream x.N.adcgs next to it, with that segment alone; before that, x.N is its checkpoint.
 * Two of its notes identify it and have no other use: `plan` is the plan's digest, and `follows` is the digest of the model that
 * it continues.
 */
#ifndef ADCGS_SESSION_PLAN_H
#define ADCGS_SESSION_PLAN_H

#include "scene/content.h"
#include "scene/part.h"
#include "train/train_config.h"

#define ADCGS_PLAN_FORMAT 1  /* number of the format; definition */
#define ADCGS_PLAN_DIGEST 33 /**< hexadecimal digits of an MD5 and a zero; definition */
#define ADCGS_NOTE_PLAN "plan"
#define ADCGS_NOTE_FOLLOWS "follows"

typedef struct adcgs_plan_segment {
    uint8_t follows; /**< it is trained from the previous segment */
    uint32_t views;  /**< training views */
    double cost;     /**< estimate, seconds of one processor */
} adcgs_plan_segment;

/** Zero-initialise before use. */
typedef struct adcgs_plan {
    char encoder[64];               /**< the program that made it; segments of another version would differ */
    char digest[ADCGS_PLAN_DIGEST]; /**< of the file's values, independent of layout; set by reading */
    /* How the scene is opened. */
    char *scene;  /**< path of the scene at planning; it may lie elsewhere now */
    char *points; /**< file of initial points, or NULL */
    char *frames; /**< as on the command line, or NULL */
    int dataset;
    adcgs_fps rate;                            /**< requested frame rate; den 0: the scene's */
    char outline[2 * ADCGS_CONTENT_BYTES + 1]; /**< adcgs_scene_outline() */
    int has_alpha;
    float background[3];
    /* How it is trained. */
    adcgs_cpu_level cpu; /**< kernels differ in the last bit, and so do runs */
    adcgs_train_config config;
    int has_details;
    uint32_t details; /**< details per image of the scene (adcgs_plan_details()), if they determine max_anchors */
    /* How it is coded. */
    double origin[3], scale;
    uint32_t timebase_num, timebase_den;
    adcgs_cuts cuts;
    adcgs_plan_segment *segments; /**< [cuts.n] */
} adcgs_plan;

void adcgs_plan_clear(adcgs_plan *plan);

/**
 * Estimates the training cost of a part of a scene, in seconds of one processor. The error is a factor of two or three, about the
 * same for all parts.
 */
double adcgs_plan_cost(const adcgs_plan *plan, const adcgs_scene *part);

/** Writes a plan for a scene, with the files that each segment needs. An existing file has to be the same plan. */
adcgs_status adcgs_plan_write(const adcgs_plan *plan, const adcgs_scene *scene, const char *path, adcgs_error *error);
/** ADCGS_ERR_DATA names the field that is missing or wrong. plan: cleared by the caller, also on failure. */
adcgs_status adcgs_plan_read(adcgs_plan *plan, const char *path, adcgs_error *error);

#endif

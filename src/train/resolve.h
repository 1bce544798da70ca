/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * From the requested to the resolved configuration. Preset and user determine the request, which stays unchanged. A run uses a
 * copy of it, which these phases alone change, each as soon as its facts are known. Every change is recorded in the
 * copy: the decider, the reason and the requested value. A value that the user gave stays, unless the phase says otherwise.
 */
#ifndef ADCGS_TRAIN_RESOLVE_H
#define ADCGS_TRAIN_RESOLVE_H

#include "train/settings.h"
#include "train/trial/mechanisms.h"

/* ---- Before a run, for all segments of a scene ---- */

/** Size of the images: the divisor of their width and height that suits them. */
void adcgs_resolve_size(adcgs_train_config *config, int divisor);
/** Verdicts of trials: the mechanisms that lost are off, also if the user gave their settings. */
void adcgs_resolve_trials(adcgs_train_config *config, const uint8_t dropped[ADCGS_MECHANISMS]);
/** Facts of a trial (trial.h). */
typedef struct adcgs_trial_facts {
    int without;         /**< adcgs_mechanism that it leaves out, or ADCGS_MECHANISM_NONE */
    uint32_t iterations; /**< at least 1 */
    uint64_t seed;
    int reduction; /**< images are reduced by this factor, and by half for the whole run; less than 1: as requested */
} adcgs_trial_facts;
/** A trial: a short run on small images, without a target or a time limit. It replaces values that the user gave, too. */
void adcgs_resolve_trial(adcgs_train_config *config, const adcgs_trial_facts *facts);
/** Segments share their parameters: all time tables have at most as many rows as the shortest part has timestamps. */
void adcgs_resolve_parts(adcgs_train_config *config, uint32_t times);
/** One segment of a whole scene gets the iterations of all its parts. */
void adcgs_resolve_whole(adcgs_train_config *config, uint32_t parts);
/** The head of a live stream states the maximum of anchors before most images arrive, so their details do not determine it. */
void adcgs_resolve_live(adcgs_train_config *config);
/** A key of a live stream has as many rows in its time table as the first segment. */
void adcgs_resolve_key(adcgs_train_config *config, uint16_t rows);
/** A segment that is due soon: at most `frames` frames are matched, without rigid bodies. */
void adcgs_resolve_delay(adcgs_train_config *config, int frames);
/** Iterations and time limit (seconds, 0: none) of a segment. */
void adcgs_resolve_effort(adcgs_train_config *config, uint32_t iterations, double time_limit);

/* ---- When a run begins, in this order ---- */

/** Facts of a scene, or of the part that is trained. */
typedef struct adcgs_scene_facts {
    uint32_t times; /**< timestamps */
    int is_shared;  /**< at least two views share a timestamp, on average */
    int is_sparse;  /**< less than half of the cameras see a frame, on average over the whole scene */
} adcgs_scene_facts;

/** Parts that are left out, the time table, and the loss. */
void adcgs_resolve_scene(adcgs_train_config *config, const adcgs_scene_facts *facts);
/** True if the details per image determine max_anchors. */
int adcgs_resolve_wants_details(const adcgs_train_config *config);
/**
 * Sets max_anchors, if the details determine it, and limits start_anchors to it. The value is detail_anchors times the square
 * root of the details per image. The growth is less than proportional: with the same number of iterations, each detail of a busy
 * image is trained less and is worth fewer bits. All parts of a scene get the number of the whole scene.
 */
void adcgs_resolve_anchors(adcgs_train_config *config, uint32_t details);
/** Lambda, anchors and networks that suit the target; see rate_plan.h. */
adcgs_status adcgs_resolve_target(adcgs_train_config *config, adcgs_error *error);
/**
 * Initial anchors, if there are points, from the scene or from matching: they lie on surfaces, and growth adds the rest. splats:
 * the scene consists of splats, so that the points stand for all content.
 */
void adcgs_resolve_start(adcgs_train_config *config, int splats);
/** Result of matching: whether there are lifetimes, and how many bodies, -1: as many as requested. */
void adcgs_resolve_matching(adcgs_train_config *config, int moves, int bodies);
/** A run that continues the previous segment has its parameters. */
void adcgs_resolve_previous(adcgs_train_config *config, const adcgs_params *params);
/** Returns the lambda of the run: the configured one, times a factor by the contrast of the images unless the user gave it. */
double adcgs_resolve_contrast(adcgs_train_config *config, double factor);

/* ---- The record ---- */

/** A decision that replaced the requested value of a setting. */
typedef struct adcgs_resolution {
    const adcgs_setting *setting;
    double requested, used;
    const char *by, *reason;
} adcgs_resolution;

/** Returns 1 and the next setting from *row on whose value was replaced, and moves *row behind it; 0: there is none. */
int adcgs_resolve_next(const adcgs_train_config *config, size_t *row, adcgs_resolution *out);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Trials: a run tests its own mechanisms. Mechanisms that follow from the scene (matching, gains, lifetimes, ...) were each
 * chosen by results on some scenes, and some do harm on others. Before a long run, each mechanism that applies is tested on the
 * scene itself. A trial is a short run at a small size, with all mechanisms or without one. Some training views are held out,
 * rendered at its end, and compared. If they are clearly better without a mechanism, with two seeds, it is dropped. Known as
 * hold-out validation (Stone 1974, Cross-validatory choice and assessment of statistical predictions, JRSS B).
 */
#ifndef ADCGS_TRAIN_TRIAL_TRIAL_H
#define ADCGS_TRAIN_TRIAL_TRIAL_H

#include "base/cpu_detect.h"
#include "base/thread_pool.h"
#include "scene/scene.h"
#include "train/trial/mechanisms.h"
#include "train/train_config.h"

enum { ADCGS_TRIALS_TEXT = 640 }; /* bytes of the text; arithmetic: one entry of each mechanism fits */

/** Result of the trials for a mechanism. */
typedef struct adcgs_trial {
    int mechanism;        /**< adcgs_mechanism */
    double with, without; /**< dB, mean over the held-out views, and over seeds if two were used */
    int dropped;
} adcgs_trial;

typedef struct adcgs_trials {
    uint32_t n;          /**< mechanisms tested; 0: none, as in a short run */
    uint32_t views;      /**< held-out views */
    uint32_t iterations; /**< of each trial */
    adcgs_trial of[ADCGS_MECHANISMS];
} adcgs_trials;

/** Called before each trial: number `done` of at most `most`, without a mechanism (NULL: with all). Returns nonzero to stop. */
typedef int (*adcgs_trials_progress)(void *user, const char *without, uint32_t done, uint32_t most);

typedef struct adcgs_trials_options {
    adcgs_cpu_level cpu;
    adcgs_pool *pool;
    uint64_t memory;                /**< maximum bytes of images, as in adcgs_image_store_config */
    adcgs_trials_progress progress; /**< or NULL */
    void *user;
} adcgs_trials_options;

/** Iterations of each trial by the configuration (trial_share); 0: the run is too short for trials, or they are off. */
uint32_t adcgs_trial_length(const adcgs_train_config *config);

/**
 * Tests the mechanisms that apply to a whole scene. The result does not depend on the number of threads. ADCGS_ERR_IO if progress
 * returns nonzero.
 */
adcgs_status adcgs_trials_run(adcgs_trials *out, const adcgs_train_config *config, const adcgs_scene *scene,
                              const adcgs_trials_options *options, adcgs_error *error);

/** The mechanisms that lost, 1 each, as adcgs_resolve_trials() takes them. */
void adcgs_trials_dropped(const adcgs_trials *trials, uint8_t dropped[ADCGS_MECHANISMS]);

/** "views=12 iterations=400 gains=24.13/24.60 ... dropped=gains" (with/without), for a stream; "" without trials. */
void adcgs_trials_format(const adcgs_trials *trials, char text[ADCGS_TRIALS_TEXT]);

#endif

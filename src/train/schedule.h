/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Training as data: presets, sizes, learning rates and the stages of a run.
 * Every moment of a run is a fraction of its iterations, so that a preset
 * stretches to any length.
 */
#ifndef ADCGS_TRAIN_SCHEDULE_H
#define ADCGS_TRAIN_SCHEDULE_H

#include "train/fmodel.h"

typedef struct adcgs_train_config {
    const char *preset;
    uint32_t iterations;
    double time_limit;     /**< seconds; > 0: progress is measured in time, and the result depends on the machine */
    uint64_t seed;
    int scale;             /**< images are divided by this integer before training */
    float lambda;          /**< loss per mebibyte (2^23 bits) of estimated features */
    float ssim_weight;
    adcgs_params params;   /**< time_rows is capped by the scene */
    adcgs_shape shape;
    uint32_t start_anchors, max_anchors;
    float grow_threshold;  /**< of the significance-weighted screen gradient */
    float prune_opacity;   /**< of the accumulated opacity */
    uint32_t refine_every; /**< iterations between refinements */
    int rate_period;       /**< rate is measured on every n-th group of anchors */
    float dropout;         /**< share of primitives left out at random until rounding: against overfitting few views */
    /* Moments, as fractions of the run. */
    float quarter_until, half_until; /**< coarse-to-fine: a quarter, then half of the resolution */
    float deform_from, grow_from, grow_until, noise_from, rate_from, weigh_at, decide_at, round_from, freeze_from;
    /* Ablation switches of the paper: stages left out. */
    uint8_t without_coarse, without_fine, without_rate, without_refinement;
} adcgs_train_config;

/** Fill in a preset; ADCGS_ERR_USAGE for an unknown name. */
adcgs_status adcgs_train_preset(adcgs_train_config *config, const char *name, adcgs_error *error);
/** Names of the presets, NULL-terminated, quickest first. */
extern const char *const adcgs_train_presets[];
/** Learning rates of a fresh model's parameter groups. */
void adcgs_train_rates(adcgs_fmodel *f);

/** Stage of a run at a progress in [0,1], for display and log. */
const char *adcgs_train_stage(const adcgs_train_config *config, double progress);

#endif

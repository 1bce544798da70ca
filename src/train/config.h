/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A training run as data. What each number means, its range and its value in each preset are in the table of settings
 * (settings_table.c); configurations are made by settings.h. Every moment of a run is a fraction of its iterations, so that a
 * preset stretches to any length.
 */
#ifndef ADCGS_TRAIN_CONFIG_H
#define ADCGS_TRAIN_CONFIG_H

#include "fmodel/fmodel.h"

/** What a run is steered to; without a target, lambda stays as configured. */
typedef enum adcgs_train_target {
    ADCGS_TARGET_NONE,
    ADCGS_TARGET_SIZE, /**< at most so many bytes of stream */
    ADCGS_TARGET_PSNR, /**< so many dB, mean over the training views */
} adcgs_train_target;

#define ADCGS_TARGET_SIZE_MIN 1.0
#define ADCGS_TARGET_SIZE_MAX 1e12
#define ADCGS_TARGET_PSNR_MIN 5.0
#define ADCGS_TARGET_PSNR_MAX 80.0
#define ADCGS_TIME_LIMIT_MAX 1e7 /* seconds */

typedef struct adcgs_train_config {
    const char *preset;
    double time_limit;     /**< seconds; > 0: progress is measured in time, and the result depends on the machine */
    adcgs_train_target target;
    double target_value;   /**< bytes or dB */
    /* Chosen by hand: no target changes lambda, max_anchors or networks' widths, no scene the others. */
    uint8_t own_lambda, own_start, own_anchors, own_networks, own_rigid, own_scale_from, own_square, own_smooth;
    uint32_t details;      /**< of the scene's pictures, where somebody has looked (adcgs_plan_details()) */
    uint8_t has_details;
    uint8_t judges_poses;  /**< somebody wants to hear what is wrong with them; no checkpoint and no stream knows of it */
    /* The run. */
    uint32_t iterations;
    uint32_t batch;        /**< views that an iteration looks at */
    uint64_t seed;
    int scale;             /**< images are divided by this integer before training */
    float learn_features, learn_prediction, learn_motion, learn_entropy; /**< learning rates, relative to what suits most */
    /* The loss. */
    float lambda;          /**< loss per mebibyte (2^23 bits) of estimated features and networks */
    float network_rate;    /**< weight of the networks' own bits, relative to the features' */
    int rate_period;       /**< rate is measured on every n-th group of anchors */
    float rdo_strength;    /**< of the loss per bit when values are frozen, relative to training's; 0: the nearest levels */
    float ssim_weight, square_weight;
    float rigid_weight;    /**< of the energy that keeps neighbours alike as they move; 0 where several views share a moment */
    float scale_weight;    /**< of the price of primitives' size */
    float distortion_weight; /**< of the spread of depth along rays */
    int distortion_period; /**< it is measured in every n-th iteration */
    float tier_weight;     /**< of what pictures look like while tiers are absent */
    float dropout;         /**< share of primitives left out at random until rounding: against overfitting few views */
    /* The model. */
    adcgs_params params;   /**< time_rows is capped by the scene */
    adcgs_shape shape;
    /* Anchors. */
    int tiers;             /**< sets of anchors, the first a coarse picture of everything; at most, few anchors make fewer */
    float detail_anchors;  /**< max_anchors over the square root of details, unless that was chosen by hand; 0: the preset's */
    uint32_t start_anchors, max_anchors;
    uint8_t span_ends;     /**< these lives end earlier where pictures show what is behind */
    float span_moments;    /**< moments before and behind its own that an anchor lives, to begin with */
    uint32_t densify_every;  /**< iterations between densifications */
    float densify_threshold; /**< of the significance-weighted screen gradient */
    float prune_opacity;   /**< of the accumulated opacity */
    float keep_opacity;    /**< primitives of less opacity in the mean go when it is decided what stays */
    float still_below;     /**< effect of time on an anchor, of which 1 can just be seen, below which it is static */
    /* Moments, as fractions of the run. */
    float curriculum_begin, curriculum_until; /**< views trained on grow from this fraction, about the middle of time, to all */
    float rates_fall_from; /**< learning rates stay as they begin until here */
    float quarter_until, half_until; /**< coarse-to-fine: a quarter, then half of the resolution */
    float scale_from;      /**< size has its price from here on; where several views share a moment, from the start */
    float deform_from, fine_from, densify_from, densify_until, noise_from, rate_from;
    float prune_units_at, prune_units_again; /**< hidden units are removed; the second time needs the first */
    float decide_at, tiers_from, round_from, freeze_from;
    float average_last;    /**< so much of the end of rounding, and of the run, is averaged, but at most half of either stage */
    /* Switches: what is left out, see adcgs_train_leave_out(). */
    uint8_t without_coarse, without_fine, without_rate, without_densification, without_weight_steps;
    uint8_t without_rounding; /**< values and weights remain binary32 to the end, for a model that is stored uncompressed */
    uint8_t bf16;          /**< networks that draw are trained in bf16; see adcgs_bf16_check() */
    uint8_t retime_doubled; /**< pictures that come twice are learnt as of the time that they show */
    uint8_t even_light;    /**< steps of light are taken out of pictures (data/light.h), by who opens the scene */
    float trial_share;     /**< iterations of a trial (trial.h), of the run's; fewer than 100: no trials */
    uint8_t gains;         /**< cameras, and images of a static scene, have a gain each in training (exposure.h) */
    uint8_t black_levels;  /**< cameras have a black level each in training (black_level.h) */
    uint8_t residual_densify; /**< anchors grow where several views miss light, too (residual_densify.h) */
    uint8_t prune_floaters; /**< static primitives in space that matching found empty are pruned (floaters.h) */
    uint8_t stereo;        /**< moments at most of which pictures of cameras that stay are matched, for first anchors; 0: none */
} adcgs_train_config;

#endif

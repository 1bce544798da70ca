/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The configuration of a training run. The table of settings (settings_table.c) documents each number, its range and its value in
 * each preset. settings.h creates the requested configuration, which preset and user determine. resolve.h derives the resolved
 * one, which a run uses. Times of a run are fractions of its iterations, so that a preset scales to any length.
 */
#ifndef ADCGS_TRAIN_TRAIN_CONFIG_H
#define ADCGS_TRAIN_TRAIN_CONFIG_H

#include "fmodel/fmodel.h"

/** Target of rate control; without a target, lambda stays as configured. */
typedef enum adcgs_train_target {
    ADCGS_TARGET_NONE,
    ADCGS_TARGET_SIZE, /**< maximum bytes of the stream */
    ADCGS_TARGET_PSNR, /**< dB, mean over the training views */
} adcgs_train_target;

/* Bounds of valid targets, bytes, dB and seconds; definition, far from any sensible value. */
#define ADCGS_TARGET_SIZE_MIN 1.0
#define ADCGS_TARGET_SIZE_MAX 1e12
#define ADCGS_TARGET_PSNR_MIN 5.0
#define ADCGS_TARGET_PSNR_MAX 80.0
#define ADCGS_TIME_LIMIT_MAX 1e7 /* seconds */

/** Maximum number of rows in the table of settings; definition. */
#define ADCGS_SETTINGS_MAX 120

/** Origin of a setting's value. */
typedef enum adcgs_decider {
    ADCGS_BY_PRESET,
    ADCGS_BY_USER,
    ADCGS_BY_SCENE,    /**< its images, cameras and timestamps */
    ADCGS_BY_MATCHING, /**< of its images */
    ADCGS_BY_TRIAL,    /**< of a mechanism */
    ADCGS_BY_TARGET,   /**< size or PSNR */
    ADCGS_BY_EFFORT,   /**< of a segment that is due at a time */
    ADCGS_BY_SEGMENTS, /**< values that the segments of a stream share */
    ADCGS_DECIDERS
} adcgs_decider;

/** The record of a setting: the user's part, and the decision that replaced the requested value. */
typedef struct adcgs_setting_origin {
    uint8_t given;      /**< 1: the user gave the setting */
    uint8_t by;         /**< adcgs_decider of a decision; else 0 */
    double requested;   /**< value before the first decision */
    double used;        /**< value by the last decision; the run may use another one only in its own state (lambda) */
    const char *reason; /**< of the last decision, a few words; NULL: none */
} adcgs_setting_origin;

typedef struct adcgs_train_config {
    const char *preset;
    double time_limit; /**< seconds; > 0: progress is measured in time, and the result depends on the machine */
    adcgs_train_target target;
    double target_value;                             /**< bytes or dB */
    adcgs_setting_origin origin[ADCGS_SETTINGS_MAX]; /**< per row of the table of settings */
    /* The run. */
    uint32_t iterations;
    uint32_t batch; /**< view passes per iteration */
    uint64_t seed;
    int scale; /**< images are reduced by this integer factor before training */
    float lr_scale_anchors, lr_scale_prediction, lr_scale_motion, lr_scale_entropy; /**< learning rates over the defaults */
    /* The loss. */
    float lambda;       /**< loss per mebibyte (2^23 bits) of estimated features and networks */
    float network_rate; /**< weight of the networks' bits, relative to the features' */
    int rate_period;    /**< rate is measured on every n-th group of anchors */
    float ssim_weight, l2_share;
    float rigidity_weight;  /**< of the rigidity energy between neighbours; 0 if several views share a timestamp */
    float scale_reg_weight; /**< of the scale penalty of primitives */
    float tier_weight;      /**< of the loss of renders without the later tiers */
    float dropout;          /**< share of primitives dropped at random until rounding, against overfitting few views */
    /* The model. */
    adcgs_params params; /**< time_rows is capped by the scene */
    adcgs_shape shape;
    /* Anchors. */
    int tiers;            /**< maximum number of progressive anchor sets, the first a coarse scene; few anchors make fewer */
    float detail_anchors; /**< max_anchors / sqrt(details), unless the user set max_anchors; 0: the preset's */
    uint32_t start_anchors, max_anchors;
    uint8_t lifetime_trim;     /**< 1: lifetimes also end where the images show the background */
    float lifetime_frames;     /**< initial half lifetime of an anchor, in matched frames */
    uint32_t densify_interval; /**< iterations between densifications */
    float densify_threshold;   /**< of the significance-weighted screen gradient */
    float prune_opacity;       /**< of the accumulated opacity */
    float min_mean_opacity;    /**< minimum mean opacity of primitives at prune_at */
    float static_threshold;    /**< effect of time below which an anchor is static; 1 is just visible */
    /* Times, as fractions of the run. */
    /** Share of the views, about the middle of time, that training begins with (no time); from until on it uses all views. */
    float curriculum_begin, curriculum_until;
    float lr_decay_start;                      /**< start of the decay of learning rates */
    float quarter_size_until, half_size_until; /**< end of training at a quarter and at half of the resolution */
    float scale_reg_start;                     /**< start of the scale penalty; 0 if several views share a timestamp */
    float deform_start, fine_start, densify_start, densify_until, quant_noise_start, rate_start;
    float prune_units_at, prune_units_again; /**< pruning of hidden units; the second one needs the first */
    float prune_at, tiers_start, quant_round_start, freeze_start;
    float average_share; /**< share of the end of rounding, and of the run, to average; at most half of each stage */
    /* Switches of the ablation, see adcgs_train_leave_out(). */
    uint8_t without_coarse, without_fine, without_rate, without_densification, without_weight_steps;
    uint8_t without_rounding;           /**< values and weights stay binary32, for a model that is stored uncompressed */
    uint8_t bf16;                       /**< rendering networks are trained in bf16; see adcgs_bf16_check() */
    uint8_t retime_duplicates;          /**< a duplicated image gets the timestamp of its content */
    uint8_t exposure_step_compensation; /**< steps of light are corrected (check/light.h) by the caller that opens the scene */
    float trial_share;                  /**< iterations of a trial (trial.h), relative to the run; fewer than 100: no trials */
    uint8_t gains;                      /**< cameras, and images of a static scene, have a gain each in training (exposure.h) */
    uint8_t black_levels;               /**< cameras have a black level each in training (black_level.h) */
    uint8_t residual_densify;           /**< anchors also grow where several views miss light (residual_densify.h) */
    uint8_t prune_floaters;             /**< static primitives in space that matching found empty are pruned (floaters.h) */
    uint8_t matching_frames; /**< maximum number of frames matched for the first anchors, for static cameras; 0: none */
} adcgs_train_config;

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Training as data: presets, sizes, learning rates and the stages of a run.
 * Every moment of a run is a fraction of its iterations, so that a preset
 * stretches to any length.
 */
#ifndef ADCGS_TRAIN_SCHEDULE_H
#define ADCGS_TRAIN_SCHEDULE_H

#include "fmodel/fmodel.h"

#include <stdio.h>

/** What a run is steered to; without a target, lambda stays as configured. */
typedef enum adcgs_train_target {
    ADCGS_TARGET_NONE,
    ADCGS_TARGET_SIZE, /**< at most so many bytes of stream */
    ADCGS_TARGET_PSNR, /**< so many dB, mean over the training views */
} adcgs_train_target;

typedef struct adcgs_train_config {
    const char *preset;
    uint32_t iterations;
    double time_limit;     /**< seconds; > 0: progress is measured in time, and the result depends on the machine */
    uint64_t seed;
    int scale;             /**< images are divided by this integer before training */
    float lambda;          /**< loss per mebibyte (2^23 bits) of estimated features and networks */
    adcgs_train_target target;
    double target_value;   /**< bytes or dB */
    uint8_t own_anchors, own_networks; /**< max_anchors, the networks' widths were chosen by hand: no target changes them */
    uint8_t own_rigid, own_area; /**< rigid_weight, area_from were chosen by hand: no scene changes them */
    float ssim_weight;
    adcgs_params params;   /**< time_rows is capped by the scene */
    adcgs_shape shape;
    uint32_t start_anchors, max_anchors;
    float grow_threshold;  /**< of the significance-weighted screen gradient */
    float prune_opacity;   /**< of the accumulated opacity */
    float keep_opacity;    /**< primitives of less opacity in the mean go when it is decided what stays */
    uint32_t refine_every; /**< iterations between refinements */
    int rate_period;       /**< rate is measured on every n-th group of anchors */
    float network_rate;    /**< weight of the networks' own bits, relative to the features' */
    float rigid_weight;    /**< of the energy that keeps neighbours alike as they move; 0 where several views share a moment */
    float area_weight;     /**< of the price of primitives' size */
    float rdo_strength;    /**< of the loss per bit when values are frozen, relative to training's; 0: the nearest levels */
    float still_below;     /**< effect of time on an anchor, of which 1 can just be seen, below which it is static */
    float dropout;         /**< share of primitives left out at random until rounding: against overfitting few views */
    /* Moments, as fractions of the run. */
    float average_last;    /**< so much of the end of rounding, and of the run, is averaged, but at most half of either stage */
    float window_begin, window_until; /**< views trained on grow from this fraction, about the middle of time, to all */
    float quarter_until, half_until; /**< coarse-to-fine: a quarter, then half of the resolution */
    float area_from;       /**< size has its price from here on; where several views share a moment, from the start */
    float slim_at, slim_again; /**< hidden units are removed; the second time needs the first */
    float deform_from, fine_from, grow_from, grow_until, noise_from, rate_from, decide_at, round_from, freeze_from;
    /* Ablation switches: what is left out, see adcgs_train_leave_out(). */
    uint8_t without_coarse, without_fine, without_rate, without_refinement, without_lattice;
    uint8_t bf16;          /**< networks that draw are trained in bf16; see adcgs_bf16_check() */
    uint8_t without_rounding; /**< values and weights remain binary32 to the end, for a model that is stored uncompressed */
} adcgs_train_config;

/** Fill in a preset; ADCGS_ERR_USAGE for an unknown name. */
adcgs_status adcgs_train_preset(adcgs_train_config *config, const char *name, adcgs_error *error);
/** Change settings of a preset: "name=value,name=value"; ADCGS_ERR_USAGE names what is unknown or out of range. */
adcgs_status adcgs_train_set(adcgs_train_config *config, const char *text, adcgs_error *error);
/**
 * Leave parts of the method out: names separated by commas (coarse, fine, deformation: both of these, rate, refinement, anchors,
 * lattice, none); ADCGS_ERR_USAGE names what is unknown. To be called when all else is set, because
 * - without refinement all max_anchors are there from the start: the initial cloud is dense, as in the paper's ablation;
 * - without anchors every primitive is one of its own, with its own embedding, deformed by itself (as in E-D3DGS): K anchors of
 *   one primitive without f_g take the place of each anchor;
 * - without removal all that has grown stays: every anchor with all its primitives and its motion, every hidden unit;
 * - without the lattice the weights of the networks that draw are stored as binary32, as the paper does.
 */
adcgs_status adcgs_train_leave_out(adcgs_train_config *config, const char *parts, adcgs_error *error);
/** Write the names, ranges and values of all settings, a line each. */
void adcgs_train_settings(const adcgs_train_config *config, FILE *file);
/** Names of the presets, NULL-terminated, quickest first. */
extern const char *const adcgs_train_presets[];
/** Learning rates of a fresh model's parameter groups. */
void adcgs_train_rates(adcgs_fmodel *f);

/** The moment from which lambda has a say; more than 1 if it never has. */
float adcgs_train_lambda_from(const adcgs_train_config *config);

/** Stage of a run at a progress in [0,1], for display and log. */
const char *adcgs_train_stage(const adcgs_train_config *config, double progress);

#endif

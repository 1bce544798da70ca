/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The stages of a run as one table: when each begins and ends, in fractions of the run. The training loop asks this table, and
 * `adcgs-enc --schedule` prints it, so that both agree.
 */
#ifndef ADCGS_TRAIN_STAGE_TABLE_H
#define ADCGS_TRAIN_STAGE_TABLE_H

#include "train/train_config.h"

#include <stdio.h>

/** In the order of the table that is printed. Some last for a time, others are single steps. */
typedef enum adcgs_stage {
    ADCGS_STAGE_QUARTER_SIZE,      /**< images at a quarter of their size */
    ADCGS_STAGE_HALF_SIZE,         /**< images at half of their size */
    ADCGS_STAGE_CURRICULUM,        /**< views around the middle of time */
    ADCGS_STAGE_COARSE,            /**< the coarse deformation */
    ADCGS_STAGE_DENSIFY,           /**< densification and pruning of anchors */
    ADCGS_STAGE_NOISE,             /**< noise in place of rounding */
    ADCGS_STAGE_RATE,              /**< bits of the features in the loss */
    ADCGS_STAGE_SCALE_REG,         /**< the scale regulariser */
    ADCGS_STAGE_STATIC_ANCHORS,    /**< step: anchors without motion become static */
    ADCGS_STAGE_FINE,              /**< the fine deformation */
    ADCGS_STAGE_MOTION_TEST,       /**< step: a scene whose motion does not pay becomes static */
    ADCGS_STAGE_PRUNE,             /**< step: pruning of unused primitives */
    ADCGS_STAGE_PRUNE_UNITS,       /**< step: pruning of hidden units; from then on, bits of the networks in the loss */
    ADCGS_STAGE_TIERS,             /**< step: anchors are sorted into tiers */
    ADCGS_STAGE_PRUNE_UNITS_AGAIN, /**< step: second pruning of hidden units */
    ADCGS_STAGE_ROUND,             /**< values and weights are rounded */
    ADCGS_STAGE_FREEZE,            /**< values are final, networks alone are trained */
    ADCGS_STAGES
} adcgs_stage;

#define ADCGS_STAGE_NEVER 2.0 /**< a fraction that no run reaches; definition */

/** Fraction of the run at which a stage begins; ADCGS_STAGE_NEVER or another value from 1 on: it does not take place. */
double adcgs_stage_begin(const adcgs_train_config *config, adcgs_stage stage);
/** Fraction at which it ends: that of its begin for a step, 1 for a stage that lasts. */
double adcgs_stage_end(const adcgs_train_config *config, adcgs_stage stage);
/** True at a progress in [0,1] from the begin on. */
int adcgs_stage_has_begun(const adcgs_train_config *config, adcgs_stage stage, double progress);
/** True from the begin to the end of a stage that lasts. */
int adcgs_stage_lasts(const adcgs_train_config *config, adcgs_stage stage, double progress);

/** Writes a line per stage: name, percent of the run, iterations, the settings that determine it. */
void adcgs_stage_list(const adcgs_train_config *config, FILE *file);

#endif

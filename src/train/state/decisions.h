/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The decisions of a run that explain the model's size, for users. A stream contains them as metadata, and the run does not
 * depend on them.
 */
#ifndef ADCGS_TRAIN_STATE_DECISIONS_H
#define ADCGS_TRAIN_STATE_DECISIONS_H

#include "train/state/visit.h"

#include <stddef.h>
#include <stdint.h>

typedef struct adcgs_decisions {
    uint64_t points;                /**< initial points, from the scene or from matching */
    uint32_t details;               /**< details per image, if they set max_anchors */
    uint32_t allowed;               /**< max_anchors */
    uint32_t began;                 /**< initial number of anchors */
    uint32_t most;                  /**< maximum number of anchors at any time */
    uint32_t refused;               /**< primitives that could not grow at the last densification, because of max_anchors */
    uint32_t idle;                  /**< anchors pruned because they were hardly visible */
    uint32_t unseen, faint;         /**< primitives dropped by adcgs_prune_and_fix() */
    uint32_t unchanging;            /**< anchors made static because the images do not change where they are rendered */
    uint32_t unmoved;               /**< anchors made static because their change is not visible */
    uint32_t units;                 /**< hidden units of networks that were pruned */
    double loss_still, loss_moving; /**< training loss without and with motion, when compared; 0: not compared */
} adcgs_decisions;

/** One value, with its name in a stream. */
typedef struct adcgs_decision {
    const char *name;
    double value;
} adcgs_decision;

/* Number of values, definition; bytes of their text, arithmetic: names and numbers of all of them fit. */
enum { ADCGS_DECISIONS = 14, ADCGS_DECISIONS_TEXT = 320 };

/** Stores or restores all values. */
void adcgs_decisions_walk(adcgs_checkpoint_walk *walk, adcgs_decisions *decisions);
void adcgs_decisions_list(const adcgs_decisions *decisions, adcgs_decision list[ADCGS_DECISIONS]);
/** "points=18231 began=4500 ...", without values of 0. */
void adcgs_decisions_format(const adcgs_decisions *decisions, char text[ADCGS_DECISIONS_TEXT]);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Why a model is as large as it is: what a run decided, and from what, for people to read. A stream tells it as metadata, and
 * nothing of a run depends on it.
 */
#ifndef ADCGS_TRAIN_DECISIONS_H
#define ADCGS_TRAIN_DECISIONS_H

#include <stddef.h>
#include <stdint.h>

typedef struct adcgs_decisions {
    uint64_t points;     /**< given with the scene, or matched between its pictures, to begin at */
    uint32_t details;    /**< of a picture, where these say how many anchors there may be, and so many: max_anchors */
    uint32_t allowed;
    uint32_t began;      /**< anchors to begin with, and the most there were at once */
    uint32_t most;
    uint32_t refused;    /**< primitives beside which more would have grown at the last densification but for max_anchors */
    uint32_t idle;       /**< anchors that went since next to nothing of them was to be seen */
    uint32_t unseen, faint; /**< primitives that went when it was decided what stays */
    uint32_t unchanging; /**< anchors that moved and became static since pictures do not change where they are drawn, */
    uint32_t unmoved;    /**< or since no more than what can be seen of them changed */
    uint32_t units;      /**< hidden units of networks that went since they did not pay */
    double loss_still, loss_moving; /**< of training pictures without motion and with it, when that was weighed; 0: it was not */
} adcgs_decisions;

/** A figure of them as it is called in a stream. */
typedef struct adcgs_decision {
    const char *name;
    double value;
} adcgs_decision;

enum { ADCGS_DECISIONS = 14, ADCGS_DECISIONS_TEXT = 320 };

void adcgs_decisions_list(const adcgs_decisions *decisions, adcgs_decision list[ADCGS_DECISIONS]);
/** "points=18231 began=4500 ...", without those that are 0. */
void adcgs_decisions_tell(const adcgs_decisions *decisions, char text[ADCGS_DECISIONS_TEXT]);

#endif

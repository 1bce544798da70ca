/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The set of anchors that a run goes on with: what densification, pruning and decisions have in common. */
#ifndef ADCGS_TRAIN_ANCHOR_SET_H
#define ADCGS_TRAIN_ANCHOR_SET_H

#include "train/state.h"

/** Anchors to be: where they are and which anchor of now each one takes its values from. */
typedef struct adcgs_anchor_set {
    uint32_t n, capacity;
    uint32_t (*pos)[3];       /**< cells of the grid */
    uint32_t *source, *order;
    uint8_t *fresh;           /**< did not exist before */
} adcgs_anchor_set;

adcgs_status adcgs_anchor_set_init(adcgs_anchor_set *set, uint32_t capacity, adcgs_error *error);
void adcgs_anchor_set_clear(adcgs_anchor_set *set);
/** The capacity is the caller's to keep. */
void adcgs_anchor_set_add(adcgs_anchor_set *set, const uint32_t pos[3], uint32_t source, int fresh);
/** Sort the set, hand it to the model, and shrink what is new: half the reach, smaller primitives. */
adcgs_status adcgs_anchor_set_adopt(adcgs_trainer *trainer, adcgs_anchor_set *set, adcgs_error *error);

/** An anchor or a slot, and what it is worth. */
typedef struct adcgs_ranked {
    float score;
    uint32_t index;
} adcgs_ranked;
/** Put the highest scores first; of equal ones, the lowest index. */
void adcgs_rank(adcgs_ranked *list, size_t n);

/** Anchor that a slot's primitive belongs to. */
static inline uint32_t adcgs_anchor_of(const adcgs_fmodel *f, uint32_t slot)
{
    return slot / (ADCGS_LANES * (uint32_t)f->params.k) * ADCGS_LANES + slot % ADCGS_LANES;
}
/**
 * Whether an anchor's primitives stay transparent, or cover fewer pixels than min_pixels of the full resolution, in the mean over
 * the views that contain it. An anchor that no view contained is idle once every training view was asked.
 */
int adcgs_anchor_is_idle(const adcgs_trainer *trainer, uint32_t anchor, double min_pixels);

#endif

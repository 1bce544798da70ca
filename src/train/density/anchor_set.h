/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The next set of anchors of a run: common to densification, pruning and decisions. */
#ifndef ADCGS_TRAIN_DENSITY_ANCHOR_SET_H
#define ADCGS_TRAIN_DENSITY_ANCHOR_SET_H

#include "train/state/state.h"

/** The next anchors: their positions, and the current anchor from which each takes its values. */
typedef struct adcgs_anchor_set {
    uint32_t n, capacity;
    uint32_t (*pos)[3]; /**< cells of the grid */
    uint32_t *source, *order;
    uint8_t *fresh; /**< 1: a new anchor */
} adcgs_anchor_set;

adcgs_status adcgs_anchor_set_init(adcgs_anchor_set *set, uint32_t capacity, adcgs_error *error);
void adcgs_anchor_set_clear(adcgs_anchor_set *set);
/** The caller ensures that the capacity suffices. */
void adcgs_anchor_set_add(adcgs_anchor_set *set, const uint32_t pos[3], uint32_t source, int fresh);
/** Sorts the set, applies it to the model, and shrinks new anchors: half the extent, smaller primitives. */
adcgs_status adcgs_anchor_set_adopt(adcgs_trainer *trainer, adcgs_anchor_set *set, adcgs_error *error);

/** An anchor or a slot, and its score. */
typedef struct adcgs_ranked {
    float score;
    uint32_t index;
} adcgs_ranked;
/** Sorts by descending score; equal scores by ascending index. */
void adcgs_rank(adcgs_ranked *list, size_t n);

/** The anchor of a slot's primitive. */
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

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * An iteration shared by a team: each run looks at some of the views, one behind the other, and sums what the tree lets it; then
 * each sums a slice of the numbers for all, so that what a run sends and gets is twice its gradients, however many they are.
 * Known as reduce-scatter and allgather (Thakur et al. 2005, Optimization of collective communication operations in MPICH);
 * here by a tree that does not follow from who has what.
 */
#ifndef ADCGS_TRAIN_SHARE_H
#define ADCGS_TRAIN_SHARE_H

#include "train/state.h"

/** The first of the places that a rank of the team looks at, of config.batch; those of all, for the rank behind the last. */
uint32_t adcgs_share_place(const adcgs_trainer *trainer, int rank);
/** own: what this run's places make. The first becomes the sum of all places, and batch.seen has what all have seen. */
adcgs_status adcgs_share(adcgs_trainer *trainer, const adcgs_tree_part *own, int n_own, adcgs_error *error);

#endif

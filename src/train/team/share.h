/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Sharing of an iteration between the runs of a team. Each run processes some consecutive views, and sums them as far as the tree
 * allows. Then each run sums one slice of the numbers for all. So a run sends and receives twice the size of its gradients, for
 * any number of runs. Known as reduce-scatter and allgather (Thakur et al. 2005, Optimization of collective communication
 * operations in MPICH). The tree of additions here does not depend on the distribution.
 */
#ifndef ADCGS_TRAIN_TEAM_SHARE_H
#define ADCGS_TRAIN_TEAM_SHARE_H

#include "train/state/state.h"

/** First place of config.batch that a rank of the team processes; config.batch for the rank after the last. */
uint32_t adcgs_share_place(const adcgs_trainer *trainer, int rank);
/**
 * own: partial sums of this run's places. The first becomes the sum over all places, and batch.results receives the results of
 * all.
 */
adcgs_status adcgs_share(adcgs_trainer *trainer, const adcgs_tree_part *own, int n_own, adcgs_error *error);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Sums over the places 0 to n of a batch, by a tree that depends only on n: pairs, pairs of pairs, and finally the remaining
 * parts from the last one on. Parts may be summed anywhere: the binary32 additions are the same, and so are the bits. Known as
 * pairwise summation (Higham 1993, The accuracy of floating point summation, SIAM J. Sci. Comput. 14(4)).
 */
#ifndef ADCGS_TRAIN_TEAM_TREE_SUM_H
#define ADCGS_TRAIN_TEAM_TREE_SUM_H

#include "base/base.h"

#define ADCGS_TREE_MOST 256 /* places: maximum views of a batch; definition */
/* Maximum number of parts of a range, plus one; arithmetic: two for each power of two of the places. */
#define ADCGS_TREE_PARTS 17

/** The sum over places first to first + n - 1. */
typedef struct adcgs_tree_part {
    uint32_t first, n;
    float *sum;
} adcgs_tree_part;

/**
 * Appends a part to n parts, and sums pairs as the tree requires, in [size] floats, into the first of each pair.
 * \return the new number of parts
 */
int adcgs_tree_add(adcgs_tree_part *parts, int n, adcgs_tree_part next, size_t size);
/** Sums the remaining parts into the first, after the last place. */
void adcgs_tree_end(adcgs_tree_part *parts, int n, size_t size);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Sums over the places 0 to n of a batch, by a tree that depends on n alone: pairs, pairs of pairs, and what is left at the end
 * from its end on. Parts of it may be summed anywhere: the additions of binary32 are the same, and so are the bits.
 * Known as pairwise summation (Higham 1993, The accuracy of floating point summation, SIAM J. Sci. Comput. 14(4)).
 */
#ifndef ADCGS_TRAIN_TREE_SUM_H
#define ADCGS_TRAIN_TREE_SUM_H

#include "base/base.h"

#define ADCGS_TREE_MOST 256 /* places */
#define ADCGS_TREE_PARTS 17 /* that a run of them has at most, and one more */

/** The sum over places first to first + n. */
typedef struct adcgs_tree_part {
    uint32_t first, n;
    float *sum;
} adcgs_tree_part;

/**
 * Behind n parts comes another: sum, in [size] floats, what the tree sums, into the first of each two.
 * \return how many parts there are then
 */
int adcgs_tree_add(adcgs_tree_part *parts, int n, adcgs_tree_part next, size_t size);
/** All places are there: sum what is left, into the first part. */
void adcgs_tree_end(adcgs_tree_part *parts, int n, size_t size);

#endif

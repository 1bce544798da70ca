/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Sums by a tree. */
#include "train/team/tree_sum.h"

static void add(float *restrict to, const float *restrict from, size_t size)
{
    for (size_t i = 0; i < size; i++)
        to[i] += from[i];
}

/** True if two parts of equal length are the halves of a tree node: the first begins at a multiple of their sum. */
static int are_halves(const adcgs_tree_part *a, const adcgs_tree_part *b)
{
    return a->n == b->n && a->first % (2 * a->n) == 0;
}

int adcgs_tree_add(adcgs_tree_part *parts, int n, adcgs_tree_part next, size_t size)
{
    parts[n] = next;
    for (; n > 0 && are_halves(&parts[n - 1], &parts[n]); n--) {
        add(parts[n - 1].sum, parts[n].sum, size);
        parts[n - 1].n += parts[n].n;
    }
    return n + 1;
}

void adcgs_tree_end(adcgs_tree_part *parts, int n, size_t size)
{
    for (; n > 1; n--) {
        add(parts[n - 2].sum, parts[n - 1].sum, size);
        parts[n - 2].n += parts[n - 1].n;
    }
}

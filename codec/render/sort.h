/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Sorting projected splats by depth. */
#ifndef ADCGS_RENDER_SORT_H
#define ADCGS_RENDER_SORT_H

#include "base/thread_pool.h"

/**
 * Sort n keys by their upper 32 bits, stably. other: [n] scratch. Returns the array that holds the result: keys or other.
 */
uint64_t *adcgs_sort_keys(uint64_t *keys, uint64_t *other, uint32_t n);

#endif

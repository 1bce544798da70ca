/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Least-significant-digit radix sort, 11 bits a pass, over the bits in which the keys differ. */
#include "render/sort.h"

#define DIGIT 11
#define BUCKETS (1u << DIGIT)

static void sort_pass(const uint64_t *from, uint64_t *to, uint32_t n, uint32_t least, int shift)
{
    uint32_t place[BUCKETS] = {0};
    for (uint32_t i = 0; i < n; i++)
        place[((uint32_t)(from[i] >> 32) - least) >> shift & (BUCKETS - 1)]++;
    uint32_t sum = 0;
    for (uint32_t b = 0; b < BUCKETS; b++) {
        const uint32_t count = place[b];
        place[b] = sum;
        sum += count;
    }
    for (uint32_t i = 0; i < n; i++)
        to[place[((uint32_t)(from[i] >> 32) - least) >> shift & (BUCKETS - 1)]++] = from[i];
}

uint64_t *adcgs_sort_keys(uint64_t *keys, uint64_t *other, uint32_t n)
{
    uint32_t least = UINT32_MAX, most = 0;
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t key = (uint32_t)(keys[i] >> 32);
        least = ADCGS_MIN(least, key);
        most = ADCGS_MAX(most, key);
    }
    for (int shift = 0; n > 1 && shift < 32 && (most - least) >> shift; shift += DIGIT) {
        sort_pass(keys, other, n, least, shift);
        uint64_t *const swap = keys;
        keys = other;
        other = swap;
    }
    return keys;
}

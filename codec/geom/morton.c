/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Morton codes, and sorting voxels by them. */
#include "geom/geom.h"

/* Insert two zero bits between the bits of a 21-bit number. */
static uint64_t spread(uint32_t v)
{
    uint64_t x = v & 0x1fffff;
    x = (x | x << 32) & UINT64_C(0x001f00000000ffff);
    x = (x | x << 16) & UINT64_C(0x001f0000ff0000ff);
    x = (x | x << 8) & UINT64_C(0x100f00f00f00f00f);
    x = (x | x << 4) & UINT64_C(0x10c30c30c30c30c3);
    return (x | x << 2) & UINT64_C(0x1249249249249249);
}

uint64_t adcgs_morton(const uint32_t voxel[3])
{
    return spread(voxel[0]) << 2 | spread(voxel[1]) << 1 | spread(voxel[2]);
}

typedef struct item {
    uint64_t code;
    uint32_t index, pad;
} item;

/* Stable, least significant byte first; the sorted items end in a. */
static void radix_sort(item *a, item *b, size_t n)
{
    for (int shift = 0; shift < 64; shift += 16) {
        for (int half = 0; half < 2; half++) {
            size_t start[257] = {0};
            const item *from = half ? b : a;
            item *to = half ? a : b;
            const int at = shift + 8 * half;
            for (size_t i = 0; i < n; i++)
                start[(from[i].code >> at & 255) + 1]++;
            for (int i = 0; i < 255; i++)
                start[i + 1] += start[i];
            for (size_t i = 0; i < n; i++)
                to[start[from[i].code >> at & 255]++] = from[i];
        }
    }
}

int adcgs_morton_sort(uint32_t *voxels, size_t n, uint32_t *order, adcgs_error *error)
{
    if (n > UINT32_MAX)
        return adcgs_fail(error, ADCGS_ERR_LIMIT, "%zu voxels to sort; at most 2^32 - 1 are possible", n);
    item *items = adcgs_alloc(NULL, n, 2 * sizeof *items, error);
    uint32_t *copy = adcgs_alloc(NULL, n, 3 * sizeof *copy, error);
    if (!items || !copy) {
        adcgs_free(NULL, items);
        adcgs_free(NULL, copy);
        return adcgs_alloc_status(error);
    }
    for (size_t i = 0; i < n; i++)
        items[i] = (item){.code = adcgs_morton(voxels + 3 * i), .index = (uint32_t)i};
    memcpy(copy, voxels, n * 3 * sizeof *copy);
    radix_sort(items, items + n, n);
    int duplicates = 0;
    for (size_t i = 0; i < n; i++) {
        memcpy(voxels + 3 * i, copy + 3 * (size_t)items[i].index, 3 * sizeof *copy);
        if (order)
            order[i] = items[i].index;
        duplicates |= i && items[i].code == items[i - 1].code;
    }
    adcgs_free(NULL, items);
    adcgs_free(NULL, copy);
    return duplicates;
}

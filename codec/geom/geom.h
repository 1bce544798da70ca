/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Anchor positions: distinct voxels of a 2^depth cube, coded by recursive
 * count splitting (decision D5; spec clause "Geometry").
 */
#ifndef ADCGS_GEOM_GEOM_H
#define ADCGS_GEOM_GEOM_H

#include "base/base.h"
#include "bits/range.h"

#define ADCGS_GEOM_DEPTH_MAX 21

/** Morton code: bit 3i+2 is x's bit i, 3i+1 is y's, 3i is z's, so x is split first. depth <= 21. */
uint64_t adcgs_morton(const uint32_t voxel[3]);
/** Sort voxels [n][3] into Morton order in place; order, if not NULL, receives the old index of each. 0 if all are distinct. */
int adcgs_morton_sort(uint32_t *voxels, size_t n, uint32_t *order, adcgs_error *error);

/**
 * Decode n distinct voxels into voxels [n][3], Morton order, every coordinate < 2^depth, by a decoder that has been started.
 * The caller checks 1 <= n, depth 0..21, n <= 2^(3 depth); the function checks this, too. It finishes the decoder; on success
 * that holds its final state. Scratch memory, at most 128 bytes for each position plus a constant, comes from memory.
 */
adcgs_status adcgs_geom_decode(adcgs_range_dec *d, uint32_t n, int depth, uint32_t *voxels, adcgs_memory *memory,
                               adcgs_error *error);
/** Append the coded positions to out. voxels: [n][3], Morton order, distinct (ADCGS_ERR_USAGE otherwise). */
adcgs_status adcgs_geom_encode(adcgs_buffer *out, const uint32_t *voxels, uint32_t n, int depth, adcgs_error *error);

#endif

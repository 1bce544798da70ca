/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Memory layout of primitives: one array of slots per number, one after the other; anchors in groups of ADCGS_LANES. */
#ifndef ADCGS_SPLAT_ROWS_H
#define ADCGS_SPLAT_ROWS_H

#include "model/model.h"

/** The arrays, in the order of a primitive's numbers in conformance point S. */
enum {
    ADCGS_ROW_MEAN = 0,
    ADCGS_ROW_SCALE = 3,
    ADCGS_ROW_ROTATION = 6, /**< w, x, y, z */
    ADCGS_ROW_OPACITY = 10,
    ADCGS_ROW_COLOUR = 11,
    ADCGS_ROWS = 14
};

/** Pointers into the arrays at some slot. */
typedef struct adcgs_slot_out {
    float *mean[3], *scale[3], *rotation[4], *opacity, *colour[3];
} adcgs_slot_out;

/** Pointers into rows [ADCGS_ROWS][n] at a slot. */
static inline adcgs_slot_out adcgs_rows_at(float *rows, size_t n, size_t slot)
{
    float *const at = rows + slot;
    adcgs_slot_out o = {.opacity = at + ADCGS_ROW_OPACITY * n};
    for (size_t c = 0; c < 3; c++) {
        o.mean[c] = at + (ADCGS_ROW_MEAN + c) * n;
        o.scale[c] = at + (ADCGS_ROW_SCALE + c) * n;
        o.colour[c] = at + (ADCGS_ROW_COLOUR + c) * n;
    }
    for (size_t c = 0; c < 4; c++)
        o.rotation[c] = at + (ADCGS_ROW_ROTATION + c) * n;
    return o;
}

/** All of rows [ADCGS_ROWS][n], for reading. */
static inline adcgs_primitives adcgs_rows_primitives(float *rows, uint32_t n)
{
    const adcgs_slot_out o = adcgs_rows_at(rows, n, 0);
    return (adcgs_primitives){.n = n,
                              .mean = {o.mean[0], o.mean[1], o.mean[2]},
                              .scale = {o.scale[0], o.scale[1], o.scale[2]},
                              .rotation = {o.rotation[0], o.rotation[1], o.rotation[2], o.rotation[3]},
                              .opacity = o.opacity,
                              .colour = {o.colour[0], o.colour[1], o.colour[2]}};
}

/** Number of groups for n anchors; the last one is padded. */
static inline uint32_t adcgs_lane_groups(uint32_t n)
{
    return (n + ADCGS_LANES - 1) / ADCGS_LANES;
}

/** Slot of primitive k of an anchor with `per_anchor` primitives: by group, then by k, then by anchor. */
static inline size_t adcgs_slot_of(uint32_t anchor, int per_anchor, int k)
{
    return ((size_t)(anchor / ADCGS_LANES) * (size_t)per_anchor + (size_t)k) * ADCGS_LANES + anchor % ADCGS_LANES;
}

#endif

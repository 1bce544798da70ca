/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Backward pass of the renderer: gradients of every primitive, and the
 * rendering weights that drive growth and pruning. Deterministic: no atomics,
 * fixed order of every sum, independent of the number of threads.
 */
#ifndef ADCGS_GRAD_RASTER_H
#define ADCGS_GRAD_RASTER_H

#include "render/render.h"
#include "splat/rows.h"

/** Gradients per slot, overwritten; arrays [n] with n the primitives' slots, 64-byte aligned, caller-owned. */
typedef struct adcgs_raster_grads {
    float *mean[3], *scale[3], *rotation[4], *opacity, *colour[3];
    float *weight; /**< sum over pixels of alpha*T: temporal significance Psi(k,t) (paper section 3.5) */
    /** length of (sum over pixels of |dL/du|, of |dL/dv|), each times half the image size; NULL: skipped, which saves time */
    float *screen;
} adcgs_raster_grads;

#define ADCGS_GRAD_ROWS (ADCGS_ROWS + 2) /* rows of primitives, weight, screen; definition */
/** All arrays in rows [ADCGS_GRAD_ROWS][n]: those of primitives, then weight and screen. */
static inline adcgs_raster_grads adcgs_raster_grads_of(float *rows, size_t n)
{
    const adcgs_slot_out o = adcgs_rows_at(rows, n, 0);
    adcgs_raster_grads g = {.opacity = o.opacity, .weight = rows + ADCGS_ROWS * n, .screen = rows + (ADCGS_ROWS + 1) * n};
    memcpy(g.mean, o.mean, sizeof g.mean);
    memcpy(g.scale, o.scale, sizeof g.scale);
    memcpy(g.rotation, o.rotation, sizeof g.rotation);
    memcpy(g.colour, o.colour, sizeof g.colour);
    return g;
}

typedef struct adcgs_raster_back adcgs_raster_back;
adcgs_status adcgs_raster_back_create(adcgs_raster_back **out, adcgs_cpu_level cpu, adcgs_pool *pool, adcgs_error *error);
void adcgs_raster_back_free(adcgs_raster_back **back);

/** raster must have just run forward with keep on these primitives and view. rgb, grad: the image and dL/d image, planar. */
adcgs_status adcgs_raster_backward(adcgs_raster_back *back, const adcgs_raster *raster, const adcgs_primitives *primitives,
                                   const adcgs_view *view, const float background[3], float screen_filter, const float *rgb,
                                   const float *grad, adcgs_raster_grads *out, adcgs_error *error);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Depth distortion: the content of a ray should lie at one depth. A few cameras can be matched by half-transparent layers at
 * different depths, which no camera between them matches. The penalty is part of the training loss only, not of a stream. Barron
 * et al. 2022, Mip-NeRF 360, CVPR; for splats Huang et al. 2024, 2D Gaussian splatting, SIGGRAPH. Here it is the variance, which
 * needs only two sums along a ray; the renderer computes them as if they were colours.
 */
#ifndef ADCGS_GRAD_DISTORTION_H
#define ADCGS_GRAD_DISTORTION_H

#include "grad/raster.h"

/**
 * Deviation of depth, relative to the harmonic mean of the visible depths, up to which the energy is quadratic. Chosen by hand,
 * not measured; the weight is measured on seven scenes (doc/log/densification.md, "Depth distortion").
 */
#define ADCGS_DISTORTION_SOFT 0.02f

/** Zero-initialise before use. */
typedef struct adcgs_distortion {
    size_t slots, pixels; /**< allocated sizes */
    float *rows;          /**< gradients [ADCGS_GRAD_ROWS][slots] */
    float *depth;         /**< [3][slots]: rendered in place of colours */
    float *image;         /**< [6][pixels]: the render and its gradient */
} adcgs_distortion;

void adcgs_distortion_clear(adcgs_distortion *distortion);

/**
 * Renders the primitives with raster, then adds to grads the gradient of weight times the mean over the view's pixels of A^2 ln(1
 * + V / SOFT^2). A is the coverage of a pixel by primitives (as a factor it has no gradient). V is the variance of u = 1 - m / z
 * over them with their blending weights, z the depth, and m its harmonic mean over all visible primitives. Where u differs,
 * cameras at the sides see parallax. *energy, unless NULL: that mean. Overwrites the data that raster kept of an earlier render.
 */
adcgs_status adcgs_distortion_add(adcgs_distortion *distortion, adcgs_raster *raster, adcgs_raster_back *back,
                                  const adcgs_primitives *primitives, const adcgs_view *view, float filter, float weight,
                                  const adcgs_raster_grads *grads, double *energy, adcgs_error *error);

#endif

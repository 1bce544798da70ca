/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Depth distortion: what a ray meets should lie at one depth. Few cameras can be pleased by layers of what is half transparent,
 * each in a place of its own, and then no camera between them is. A term of the training loss alone; a stream knows nothing
 * of it. Barron et al. 2022, Mip-NeRF 360, CVPR; for splats Huang et al. 2024, 2D Gaussian splatting, SIGGRAPH. Here it is the
 * variance, since that takes no more than two sums along a ray, which the renderer draws as if they were colours.
 */
#ifndef ADCGS_GRAD_DISTORTION_H
#define ADCGS_GRAD_DISTORTION_H

#include "grad/raster.h"

/** Deviation of depth, in parts of the depth in the middle of what is seen, up to which the energy is quadratic. */
#define ADCGS_DISTORTION_SOFT 0.02f

/** Zero-initialise before use. */
typedef struct adcgs_distortion {
    size_t slots, pixels; /**< that there is room for */
    float *rows;          /**< gradients [ADCGS_GRAD_ROWS][slots] */
    float *depth;         /**< [3][slots]: what is drawn for colours */
    float *image;         /**< [6][pixels]: what is drawn, its gradient */
} adcgs_distortion;

void adcgs_distortion_clear(adcgs_distortion *distortion);

/**
 * Draw the primitives with raster, then add to grads the gradient of weight times the mean over the view's pixels of
 * A^2 ln(1 + V / SOFT^2): A is what primitives cover of a pixel (as a factor it has no gradient), V the variance of u = 1 - m / z
 * over them, weighted as they blend, z the depth and m its harmonic mean over all that can be seen. Where u differs cameras to
 * the sides see things shift. *energy, unless NULL: that mean. What raster keeps of an earlier picture is lost.
 */
adcgs_status adcgs_distortion_add(adcgs_distortion *distortion, adcgs_raster *raster, adcgs_raster_back *back,
                                  const adcgs_primitives *primitives, const adcgs_view *view, float filter, float weight,
                                  const adcgs_raster_grads *grads, double *energy, adcgs_error *error);

#endif

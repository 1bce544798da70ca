/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The amount of detail in an image, which a model of a scene must represent.
 * Grain and smooth shading do not count.
 */
#ifndef ADCGS_METRIC_DETAIL_H
#define ADCGS_METRIC_DETAIL_H

#include "base/base.h"

#define ADCGS_DETAIL_LEAST (16.0 / 255) /**< rarely reached by noise of a decent camera; chosen by hand, not measured */

/**
 * Number of coefficients above ADCGS_DETAIL_LEAST in the orthonormal wavelet transform of an image's luma (Haar 1910; all
 * scales). These carry the visible content. The image is planar [3][height][width], range 0..1. A NaN, which marks masked pixels,
 * counts as mid-grey.
 */
adcgs_status adcgs_detail(const float *picture, int width, int height, uint32_t *details, adcgs_error *error);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * How much there is to see in a picture: what a model of a scene needs room for, and what grain and smooth shades need none for.
 */
#ifndef ADCGS_METRIC_DETAIL_H
#define ADCGS_METRIC_DETAIL_H

#include "base/base.h"

#define ADCGS_DETAIL_LEAST (16.0 / 255) /**< what noise of a decent camera hardly ever reaches */

/**
 * Coefficients of the orthonormal wavelet transform of a picture's luma (Haar 1910; all scales) beyond ADCGS_DETAIL_LEAST: how
 * many of them carry what is seen. The picture is planar [3][height][width], range 0..1; a value that is not a number, where a
 * picture is masked, counts as mid-grey.
 */
adcgs_status adcgs_detail(const float *picture, int width, int height, uint32_t *details, adcgs_error *error);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Rate-distortion curves: the mean difference in rate between two curves, and
 * the quality of a curve at a rate.
 */
#ifndef ADCGS_METRIC_CURVE_H
#define ADCGS_METRIC_CURVE_H

#include "base/base.h"

#define ADCGS_CURVE_MAX 64 /**< points of a curve; chosen by hand, not measured */

typedef struct adcgs_curve_point {
    double bytes;   /**< > 0 */
    double quality; /**< dB */
} adcgs_curve_point;

/**
 * Bjontegaard's mean difference in rate (ITU-T VCEG-M33, in its piecewise form). The logarithms of the bytes of both curves are
 * interpolated over quality: monotone piecewise cubic (Fritsch and Carlson) for a curve of 4 points or more, linear for fewer.
 * Their difference is averaged over the common range of quality. *percent < 0: test needs that much less than reference for the
 * same quality.
 *
 * Points may come in any order, 2 to ADCGS_CURVE_MAX of each curve. ADCGS_ERR_DATA if a curve has fewer points or two of the same
 * quality, if a value is not finite or a size not positive, or if the curves have no common range of quality.
 */
adcgs_status adcgs_bd_rate(const adcgs_curve_point *reference, int n_reference, const adcgs_curve_point *test, int n_test,
                           double *percent, adcgs_error *error);

/**
 * The best quality of a curve for at most this many bytes: that of a point, or of the line between neighbours (by size) over the
 * logarithm of the bytes. NaN below its smallest point, or without points.
 */
double adcgs_curve_quality(const adcgs_curve_point *points, int n, double bytes);

/** True if each point, by size, has more bytes and more quality than the previous one. 0 also for fewer than 2 points. */
int adcgs_curve_is_monotone(const adcgs_curve_point *points, int n);

#endif

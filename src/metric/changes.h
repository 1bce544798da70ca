/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Changes over time in the images of a static camera: above their noise, above
 * visibility, and large enough to be worth modelling. Images are planar
 * [3][height][width], range 0..1. NaN marks masked values, which are ignored.
 */
#ifndef ADCGS_METRIC_CHANGES_H
#define ADCGS_METRIC_CHANGES_H

#include "base/base.h"

typedef struct adcgs_changes adcgs_changes;

/** Uses the memory of eight images of floats. */
adcgs_status adcgs_changes_create(adcgs_changes **out, int width, int height, adcgs_error *error);
void adcgs_changes_free(adcgs_changes **changes);
/** Add the next image, in ascending time. */
void adcgs_changes_add(adcgs_changes *changes, const float *picture);

/**
 * Estimated standard deviation of the noise. The estimate may be low, down to half the true value if nothing moves. It assumes
 * that at least half of all values are static from one image to the next; slow changes do not count as noise.
 */
double adcgs_changes_noise(const adcgs_changes *changes);

/**
 * Smallest change of a value that counts: ADCGS_CHANGE_LEAST (temporal.h), lowered while smaller changes are worth modelling.
 * They are if their mean variance exceeds a quarter of mse, the mean square of the remaining errors. The result is at least the
 * range of noise, and `unseen`.
 */
double adcgs_changes_least(const adcgs_changes *changes, double unseen, double mse);

/**
 * region: [height][width], 1 where a value changes by more than `least`, else 0. As in temporal.h, most neighbours must change
 * too, and the region is dilated. A pixel that changes by 1.5 times `least`, and far above noise, needs no such neighbours, so
 * that moving objects of any size are kept.
 */
adcgs_status adcgs_changes_region(const adcgs_changes *changes, double least, uint8_t *region, adcgs_error *error);

#endif

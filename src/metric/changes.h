/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Where the pictures of a camera that stays where it is change over time: by more than their noise, by more than can be seen, and
 * by more than is not worth following. Pictures are planar [3][height][width], range 0..1; a value that is not a number, where a
 * picture is masked, is passed over.
 */
#ifndef ADCGS_METRIC_CHANGES_H
#define ADCGS_METRIC_CHANGES_H

#include "base/base.h"

typedef struct adcgs_changes adcgs_changes;

/** Space is that of eight pictures of floats. */
adcgs_status adcgs_changes_create(adcgs_changes **out, int width, int height, adcgs_error *error);
void adcgs_changes_free(adcgs_changes **changes);
/** The next picture, in ascending time. */
void adcgs_changes_add(adcgs_changes *changes, const float *picture);

/**
 * Standard deviation of the noise, or less: down to half of it where nothing moves. Half of all values, at least, are taken to
 * be at rest from one picture to the next; slow changes are none of it.
 */
double adcgs_changes_noise(const adcgs_changes *changes);

/**
 * From what on a change of a value counts: ADCGS_CHANGE_LEAST (temporal.h), or less where what changes by no more than that would
 * otherwise be worth following, since it is more than a quarter of mse, the mean square of the errors that are left; but at least
 * what noise does, and `unseen`.
 */
double adcgs_changes_least(const adcgs_changes *changes, double unseen, double mse);

/**
 * region: [height][width], 1 where something changes by more than `least`, else 0. As temporal.h has it, most of what is near
 * has to change, too, and what is farther about is taken in; but what changes by half as much more, and by much more than noise,
 * counts alone, so that nothing is too small to move.
 */
adcgs_status adcgs_changes_region(const adcgs_changes *changes, double least, uint8_t *region, adcgs_error *error);

#endif

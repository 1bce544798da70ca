/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Where a camera must be for points to lie where it shows them, though some are taken for others: the least squares of
 * distances in the picture, with weights that forget what does not fit, from poses that two points give (Fischler and Bolles
 * 1981, Random sample consensus, CACM 24).
 */
#ifndef ADCGS_STEREO_RESECT_H
#define ADCGS_STEREO_RESECT_H

#include "stereo/sight.h"

/** Pixels that a point lies from where the camera shows it; infinite behind it. */
double adcgs_sight_off(const adcgs_stereo_view *view, const adcgs_sight *sight);

/** Sights that are off by less than so many pixels. */
int adcgs_sights_near(const adcgs_stereo_view *view, const adcgs_sights *sights, double off);

/** Move a view, whose picture is not looked at, to where its sights have it; as many pixels as they may be off at first. */
void adcgs_resect(adcgs_stereo_view *view, const adcgs_sights *sights, double off);

/**
 * The same from anywhere. views: the other cameras, by their numbers in the sights: the view may be where they are, or where it
 * is said to be. What is drawn at random is so by `seed`.
 */
void adcgs_resect_anywhere(adcgs_stereo_view *view, const adcgs_sights *sights, const adcgs_stereo_view *views, uint64_t seed);

#endif

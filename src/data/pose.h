/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Checking camera poses and measuring where cameras look. */
#ifndef ADCGS_DATA_POSE_H
#define ADCGS_DATA_POSE_H

#include "data/scene.h"

#define ADCGS_POSE_TOLERANCE 1e-3 /**< largest entry of |R R^T - I| that counts as rounding of a rotation */

/**
 * Make R of a row-major 3x4 [R|c] orthonormal to rounding.
 * \return NULL, or what is wrong with it: not finite, singular, scaled, reflected, not orthonormal.
 */
const char *adcgs_pose_check(double pose[12]);
/** As adcgs_pose_check(), and from OpenGL axes (y up, looking along -z) to OpenCV axes. */
const char *adcgs_pose_from_opengl(double pose[12]);

/** The point nearest to all axes, drawn gently to the cameras' mean so that parallel axes have an answer too. n is not 0. */
void adcgs_pose_centre(const adcgs_scene_view *views, uint32_t n, double centre[3]);

/** Median distance of the cameras from the point nearest to all their axes; 0 if they share one position. */
adcgs_status adcgs_pose_median_distance(const adcgs_scene_view *views, uint32_t n, double *median, adcgs_error *error);

/** The world axis that is up in the pictures on the mean, as an adcgs_axes; unknown if that is x or z downwards. */
uint8_t adcgs_pose_axes(const adcgs_scene_view *views, uint32_t n);

#endif

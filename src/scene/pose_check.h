/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Checks of camera poses, and measures of the cameras' arrangement. */
#ifndef ADCGS_SCENE_POSE_CHECK_H
#define ADCGS_SCENE_POSE_CHECK_H

#include "scene/scene.h"

/** Largest entry of |R^T R - I| that counts as rounding of a rotation; chosen by hand, not measured. */
#define ADCGS_POSE_TOLERANCE 1e-3

/**
 * Makes R of a row-major 3x4 [R|c] orthonormal to rounding precision.
 * \return NULL, or the problem: not finite, singular, scaled, reflected, not orthonormal
 */
const char *adcgs_pose_check(double pose[12]);
/** Like adcgs_pose_check(); also converts from OpenGL axes (y up, looking along -z) to OpenCV axes. */
const char *adcgs_pose_from_opengl(double pose[12]);

/**
 * The point nearest to all optical axes, pulled slightly to the cameras' mean so that parallel axes have a solution. n is not
 * 0.
 */
void adcgs_pose_centre(const adcgs_scene_view *views, uint32_t n, double centre[3]);

/** Median distance of the cameras from the point nearest to all their optical axes; 0 if they share one position. */
adcgs_status adcgs_pose_median_distance(const adcgs_scene_view *views, uint32_t n, double *median, adcgs_error *error);

/** The world axis that points up in the images on average, as an adcgs_axes; unknown if this is x, or z downwards. */
uint8_t adcgs_pose_axes(const adcgs_scene_view *views, uint32_t n);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Rotations as three angles about fixed axes, one after the other: "xyz" turns
 * about x first. Known as Tait-Bryan angles; the naming is that of Nuke,
 * Blender and USD.
 */
#ifndef ADCGS_CAMERA_EULER_H
#define ADCGS_CAMERA_EULER_H

#include "camera/path.h"

/** Set the rotation of a row-major 3x4 pose from angles in degrees about x, y and z; its last column is unchanged. */
void adcgs_euler_to_pose(const double degrees[3], adcgs_rotation_order order, double pose[12]);
/** The angles of a pose, modulo 360 degrees nearest to the previous values in `degrees`. */
void adcgs_euler_from_pose(const double pose[12], adcgs_rotation_order order, double degrees[3]);

#endif

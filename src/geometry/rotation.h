/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Rotations and poses of cameras, in binary64. Quaternions are w, x, y, z. A
 * turn is an axis times half the angle, so that the quaternion is its
 * exponential. A matrix is converted to a quaternion by its largest component
 * (Shepperd, 1978). Vectors rotate about an axis by Rodrigues' formula.
 */
#ifndef ADCGS_GEOMETRY_ROTATION_H
#define ADCGS_GEOMETRY_ROTATION_H

#include "geometry/vector.h"

#include <adcgs/types.h>

/** Turn a vector by an angle in radians about an axis of length 1. */
void adcgs_rotate_about(const double axis[3], double angle, double v[3]);

/** The stream's up direction, of length 1; z if the stream has none. \return true if the stream has one */
int adcgs_find_up(const adcgs_info *info, double up[3]);

/**
 * A 3x4 camera-to-world matrix in OpenCV axes of an eye with the target in the image's centre. up need not be perpendicular to
 * the view.
 */
void adcgs_look_at(double pose[12], const double eye[3], const double target[3], const double up[3]);
/** The same for a viewing direction of length 1. */
void adcgs_look_along(double pose[12], const double eye[3], const double forward[3], const double up[3]);
/** Convert OpenCV axes (y down, looking along z) to OpenGL axes (y up, looking along -z), or back. */
void adcgs_pose_other_axes(double pose[12]);
/** Convert a 3x4 camera-to-world matrix to world-to-camera, or back: R^T, -R^T t. */
void adcgs_pose_invert(double pose[12]);

/** Stretch the camera's view to another size; the pixel aspect changes. */
void adcgs_camera_stretch(adcgs_camera *camera, int width, int height);
/**
 * Scale the camera's view to another size, centred, with the same pixel aspect. If the aspect ratios of the sizes differ, the
 * image shows the whole view and more around it. With fill, it shows a part of the view and nothing around it.
 */
void adcgs_camera_fit(adcgs_camera *camera, int width, int height, int fill);

/**
 * Project a point of the world into the camera's image, in pixels, centres at + 0.5. \return 0 outside the image, or if the depth
 * is at most `nearest`
 */
int adcgs_camera_sees(const adcgs_camera *camera, const double point[3], double nearest, double at[2]);

/** Rotation of a row-major 3x4 matrix with an orthonormal 3x3 part, and back; the last column is unchanged. */
void adcgs_rotation_from_pose(const double pose[12], double q[4]);
void adcgs_rotation_to_pose(const double q[4], double pose[12]);
/** out = a b; out may be either. */
void adcgs_rotation_multiply(const double a[4], const double b[4], double out[4]);
/** out = exp(t times turn). */
void adcgs_rotation_exp(const double turn[3], double t, double out[4]);
/** The shortest turn from a to b: b = a exp(turn), or its negative, which is the same rotation. */
void adcgs_rotation_between(const double a[4], const double b[4], double turn[3]);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/**
 * \file
 * Rotations and poses of cameras, in binary64. Quaternions are w, x, y, z; a turn is an axis times half the angle, so that the
 * quaternion is its exponential. From a matrix a quaternion comes by its largest component (Shepperd, 1978); about an axis
 * vectors turn by Rodrigues' formula.
 */
#ifndef ADCGS_CAMERA_ROTATION_H
#define ADCGS_CAMERA_ROTATION_H

#include "camera/vector.h"

#include <adcgs/types.h>

/** Turn a vector by an angle in radians about an axis of length 1. */
void adcgs_rotate_about(const double axis[3], double angle, double v[3]);

/** The direction that the stream calls up, of length 1; z if it does not say. \return whether it says. */
int adcgs_find_up(const adcgs_info *info, double up[3]);

/** A 3x4 camera-to-world matrix in OpenCV axes of an eye that sees the target in the middle; up need not be at right angles. */
void adcgs_look_at(double pose[12], const double eye[3], const double target[3], const double up[3]);
/** The same in a direction of length 1. */
void adcgs_look_along(double pose[12], const double eye[3], const double forward[3], const double up[3]);
/** From OpenCV axes (y down, looking along z) to OpenGL axes (y up, looking along -z), or back. */
void adcgs_pose_other_axes(double pose[12]);
/** From a 3x4 camera-to-world matrix to world-to-camera, or back: R^T, -R^T t. */
void adcgs_pose_invert(double pose[12]);

/** Stretch what the camera sees to another size: pixels change their shape. */
void adcgs_camera_stretch(adcgs_camera *camera, int width, int height);
/**
 * Enlarge or reduce what the camera sees to another size, its middle in the middle; pixels keep their shape. Where the sizes
 * are of different shapes, more is seen round it, so that all of the picture is there; fill: part of it is cut off, so that
 * there is nothing else.
 */
void adcgs_camera_fit(adcgs_camera *camera, int width, int height, int fill);

/**
 * Where a point of the world lies in the camera's picture, in pixels, centres at + 0.5. 0: beside it, or no farther before the
 * camera than `nearest`.
 */
int adcgs_camera_sees(const adcgs_camera *camera, const double point[3], double nearest, double at[2]);

/** Rotation of a row-major 3x4 matrix, whose 3x3 part is orthonormal, and back; the last column stays. */
void adcgs_rotation_from_pose(const double pose[12], double q[4]);
void adcgs_rotation_to_pose(const double q[4], double pose[12]);
/** out = a b; out may be either. */
void adcgs_rotation_multiply(const double a[4], const double b[4], double out[4]);
/** out = exp(t times turn). */
void adcgs_rotation_exp(const double turn[3], double t, double out[4]);
/** The shortest turn from a to b: b = a exp(turn), or its negative, which is the same rotation. */
void adcgs_rotation_between(const double a[4], const double b[4], double turn[3]);

#endif

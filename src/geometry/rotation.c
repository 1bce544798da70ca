/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Directions and rotations of cameras. */
#include "geometry/rotation.h"

#include "geometry/quaternion_matrix.h"

#include <math.h>
#include <string.h>

void adcgs_rotate_about(const double axis[3], double angle, double v[3])
{
    adcgs_v3_rotate(axis, sin(angle), cos(angle), v);
}

int adcgs_find_up(const adcgs_info *info, double up[3])
{
    const int y_up = strstr(info->axes, "y up") != NULL, y_down = strstr(info->axes, "y down") != NULL;
    up[0] = 0.0;
    up[1] = y_up ? 1.0 : y_down ? -1.0 : 0.0;
    up[2] = !y_up && !y_down;
    return y_up || y_down || strstr(info->axes, "z up") != NULL;
}

void adcgs_look_along(double pose[12], const double eye[3], const double forward[3], const double up[3])
{
    double right[3], down[3];
    adcgs_v3_cross(forward, up, right);
    adcgs_v3_normalise(right);
    adcgs_v3_cross(forward, right, down);
    for (int i = 0; i < 3; i++) {
        pose[4 * i] = right[i];
        pose[4 * i + 1] = down[i];
        pose[4 * i + 2] = forward[i];
        pose[4 * i + 3] = eye[i];
    }
}

void adcgs_look_at(double pose[12], const double eye[3], const double target[3], const double up[3])
{
    double forward[3];
    for (int i = 0; i < 3; i++)
        forward[i] = target[i] - eye[i];
    adcgs_v3_normalise(forward);
    adcgs_look_along(pose, eye, forward, up);
}

void adcgs_pose_other_axes(double pose[12])
{
    for (int i = 0; i < 3; i++) {
        pose[4 * i + 1] = 0.0 - pose[4 * i + 1];
        pose[4 * i + 2] = 0.0 - pose[4 * i + 2];
    }
}

void adcgs_pose_invert(double pose[12])
{
    double p[12];
    memcpy(p, pose, sizeof p);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            pose[4 * i + j] = p[4 * j + i];
        pose[4 * i + 3] = 0.0 - (p[i] * p[3] + p[4 + i] * p[7] + p[8 + i] * p[11]);
    }
}

void adcgs_camera_stretch(adcgs_camera *camera, int width, int height)
{
    const double x = (double)width / camera->width, y = (double)height / camera->height;
    camera->width = width;
    camera->height = height;
    camera->fx *= x;
    camera->cx *= x;
    camera->fy *= y;
    camera->cy *= y;
}

void adcgs_camera_fit(adcgs_camera *camera, int width, int height, int fill)
{
    const double x = (double)width / camera->width, y = (double)height / camera->height;
    const double scale = fill == (x < y) ? y : x;
    camera->fx *= scale;
    camera->fy *= scale;
    /* Equal aspect ratios avoid unnecessary rounding here. */
    camera->cx = camera->cx * scale + (x > scale || x < scale ? 0.5 * (width - camera->width * scale) : 0.0);
    camera->cy = camera->cy * scale + (y > scale || y < scale ? 0.5 * (height - camera->height * scale) : 0.0);
    camera->width = width;
    camera->height = height;
}

int adcgs_camera_sees(const adcgs_camera *c, const double point[3], double nearest, double at[2])
{
    const double *const m = c->cam_to_world;
    double p[3];
    for (int a = 0; a < 3; a++)
        p[a] = m[a] * (point[0] - m[3]) + m[4 + a] * (point[1] - m[7]) + m[8 + a] * (point[2] - m[11]);
    if (!(p[2] > nearest))
        return 0;
    at[0] = c->fx * p[0] / p[2] + c->cx;
    at[1] = c->fy * p[1] / p[2] + c->cy;
    return at[0] >= 0.0 && at[1] >= 0.0 && at[0] < c->width && at[1] < c->height;
}

void adcgs_rotation_from_pose(const double pose[12], double q[4])
{
    double m[9];
    for (int i = 0; i < 3; i++)
        memcpy(m + 3 * i, pose + 4 * i, 3 * sizeof *m);
    adcgs_quaternion_of(m, q);
}

void adcgs_rotation_to_pose(const double q[4], double pose[12])
{
    double m[9];
    adcgs_quaternion_matrix(q, m);
    for (int i = 0; i < 3; i++)
        memcpy(pose + 4 * i, m + 3 * i, 3 * sizeof *m);
}

void adcgs_rotation_multiply(const double a[4], const double b[4], double out[4])
{
    const double q[4] = {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
                         a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
                         a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
                         a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
    memcpy(out, q, sizeof q);
}

void adcgs_rotation_exp(const double turn[3], double t, double out[4])
{
    const double angle = t * sqrt(adcgs_v3_dot(turn, turn));
    const double per_turn = fabs(angle) > 1e-8 ? sin(angle) / angle * t : t;
    out[0] = cos(angle);
    for (int i = 0; i < 3; i++)
        out[1 + i] = per_turn * turn[i];
}

void adcgs_rotation_between(const double a[4], const double b[4], double turn[3])
{
    const double back[4] = {a[0], -a[1], -a[2], -a[3]};
    double q[4];
    adcgs_rotation_multiply(back, b, q);
    const double sine = sqrt(adcgs_v3_dot(q + 1, q + 1)), sign = q[0] < 0.0 ? -1.0 : 1.0;
    const double per_sine = sine > 1e-12 ? atan2(sine, fabs(q[0])) / sine : 0.0;
    for (int i = 0; i < 3; i++)
        turn[i] = sign * per_sine * q[1 + i];
}

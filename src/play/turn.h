/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Vectors of three, and the direction that a stream calls up: what moves cameras. */
#ifndef ADCGS_PLAY_TURN_H
#define ADCGS_PLAY_TURN_H

#include <adcgs/decoder.h>

#include <math.h>
#include <string.h>

static inline double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void cross(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static inline void normalise(double v[3])
{
    const double length = sqrt(dot(v, v));
    for (int i = 0; i < 3; i++)
        v[i] /= length;
}

/** Turn a vector about a unit vector. */
static inline void turn(const double axis[3], double angle, double v[3])
{
    double side[3];
    cross(axis, v, side);
    const double along = dot(axis, v) * (1.0 - cos(angle));
    for (int i = 0; i < 3; i++)
        v[i] = v[i] * cos(angle) + side[i] * sin(angle) + axis[i] * along;
}

/** The direction that the stream calls up, z if it does not say. \return whether it says. */
static inline int find_up(const adcgs_info *info, double up[3])
{
    const int y_up = strstr(info->axes, "y up") != NULL, y_down = strstr(info->axes, "y down") != NULL;
    up[0] = 0.0;
    up[1] = y_up - y_down;
    up[2] = !y_up && !y_down;
    return y_up || y_down || strstr(info->axes, "z up") != NULL;
}

#endif

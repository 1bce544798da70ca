/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A ball of radius 1 about the middle, covered with noise, for cameras outside or inside. */
#ifndef ADCGS_TESTS_BALL_H
#define ADCGS_TESTS_BALL_H

#include <math.h>
#include <stdint.h>

/** Smooth noise over the ball, 0..1. */
static inline double ball_shows(const double x[3], uint32_t seed)
{
    double sum = 0.0;
    int cell[3];
    double f[3];
    for (int a = 0; a < 3; a++) {
        cell[a] = (int)floor(12.0 * x[a]);
        f[a] = 12.0 * x[a] - cell[a];
    }
    for (int k = 0; k < 8; k++) {
        uint32_t h = seed;
        double weight = 1.0;
        for (int a = 0; a < 3; a++) {
            const int up = k >> a & 1;
            h = (h ^ (uint32_t)(cell[a] + up + 1000)) * 2654435761u;
            h ^= h >> 15;
            weight *= up ? f[a] : 1.0 - f[a];
        }
        sum += weight * (h >> 8) / 16777216.0;
    }
    return sum;
}

/** Intersects a ray with the ball: the near side from outside, the wall from inside. \return lengths of direction; 0: none. */
static inline double ball_hit(const double from[3], const double direction[3], double x[3])
{
    double dd = 0.0, dp = 0.0, pp = 0.0;
    for (int a = 0; a < 3; a++) {
        dd += direction[a] * direction[a];
        dp += direction[a] * from[a];
        pp += from[a] * from[a];
    }
    const double root = dp * dp - dd * (pp - 1.0);
    const double s = root > 0.0 ? (-dp + (pp < 1.0 ? 1.0 : -1.0) * sqrt(root)) / dd : 0.0;
    for (int a = 0; a < 3; a++)
        x[a] = from[a] + s * direction[a];
    return s;
}

#endif

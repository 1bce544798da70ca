/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Clips in which every attribute of some splats changes, for the tests of writers. */
#ifndef ADCGS_TESTS_MEDIA_CLIP_FRAMES_H
#define ADCGS_TESTS_MEDIA_CLIP_FRAMES_H

#include "random_splats.h"

#include <math.h>

enum { N = 200, FRAMES = 23 };

/** The quaternion after a turn about z. */
static inline void spin(adcgs_splats *s, uint32_t i, double angle)
{
    const double w = cos(0.5 * angle), z = sin(0.5 * angle);
    const double q[4] = {(double)s->rotation[0][i], (double)s->rotation[1][i], (double)s->rotation[2][i],
                         (double)s->rotation[3][i]};
    s->rotation[0][i] = (float)(w * q[0] - z * q[3]);
    s->rotation[1][i] = (float)(w * q[1] - z * q[2]);
    s->rotation[2][i] = (float)(w * q[2] + z * q[1]);
    s->rotation[3][i] = (float)(w * q[3] + z * q[0]);
}

/** Each attribute changes in every second, third, ... splat; the sign of quaternions changes at random. */
static inline void make_frames(adcgs_splats *frames, uint32_t n, uint32_t n_frames)
{
    uint64_t seed = 5;
    for (uint32_t f = 0; f < n_frames; f++) {
        frames[f] = random_splats(n, 1.0, 0.0, 77);
        for (uint32_t i = 0; i < n; i++) {
            adcgs_splats *const s = &frames[f];
            if (i % 2 == 0)
                s->mean[1][i] += 0.03f * (float)f;
            if (i % 3 == 0)
                spin(s, i, 0.4 * f);
            if (i % 5 == 0)
                s->colour[2][i] = 0.04f * (float)f;
            if (i % 7 == 0)
                s->opacity[i] = f % 4 ? 0.9f : 0.0f;
            if (i % 11 == 0)
                s->scale[0][i] *= (float)exp(0.05 * f);
            const float sign = any(&seed, -1.0, 1.0) < 0.0f ? -1.0f : 1.0f;
            for (int a = 0; a < 4; a++)
                s->rotation[a][i] *= sign;
        }
    }
}

static inline void free_frames(adcgs_splats *frames, uint32_t n)
{
    for (uint32_t f = 0; f < n; f++)
        adcgs_splats_free(&frames[f]);
}

#endif

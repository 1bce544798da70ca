/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Windows of images. */
#include "init/match_window.h"

#include <math.h>

/** Grey value at a position, pixel centres at + 0.5; NaN if unknown. */
static float grey_at(const adcgs_stereo_view *v, double x, double y)
{
    const double u = x - 0.5, w = y - 0.5;
    if (!(u >= 0 && w >= 0 && u < v->w - 1 && w < v->h - 1))
        return NAN;
    const int iu = (int)u, iv = (int)w;
    const float a = (float)(u - iu), b = (float)(w - iv), *p = v->pixels + 4 * ((size_t)iv * (size_t)v->w + (size_t)iu);
    const float *const q = p + 4 * (size_t)v->w;
    if (!(p[3] > ADCGS_STEREO_KNOWN && p[7] > ADCGS_STEREO_KNOWN && q[3] > ADCGS_STEREO_KNOWN && q[7] > ADCGS_STEREO_KNOWN))
        return NAN;
    return ((1 - b) * ((1 - a) * (p[0] + p[1] + p[2]) + a * (p[4] + p[5] + p[6])) +
            b * ((1 - a) * (q[0] + q[1] + q[2]) + a * (q[4] + q[5] + q[6]))) *
           (1.0f / 3);
}

float adcgs_window_sample(float out[ADCGS_WINDOW], const adcgs_stereo_view *v, const double at[2], const double right[2],
                          const double down[2])
{
    float sum = 0, square = 0;
    for (int y = 0; y < ADCGS_WINDOW_SIDE; y++)
        for (int x = 0; x < ADCGS_WINDOW_SIDE; x++) {
            const double i = x - ADCGS_WINDOW_SIDE / 2, j = y - ADCGS_WINDOW_SIDE / 2;
            const float g = grey_at(v, at[0] + i * right[0] + j * down[0], at[1] + i * right[1] + j * down[1]);
            out[y * ADCGS_WINDOW_SIDE + x] = g;
            sum += g;
        }
    const float mean = sum * (1.0f / ADCGS_WINDOW);
    for (int i = 0; i < ADCGS_WINDOW; i++) {
        out[i] -= mean;
        square += out[i] * out[i];
    }
    const float over = 1 / sqrtf(fmaxf(square, 1e-12f));
    for (int i = 0; i < ADCGS_WINDOW; i++)
        out[i] *= over;
    return square * (1.0f / ADCGS_WINDOW);
}

int adcgs_window_pass(const adcgs_stereo_view *from, const adcgs_stereo_view *to, int px, int py, double depth, double at[2],
                      double right[2], double down[2])
{
    double x[3], z, next[2], below[2];
    adcgs_stereo_rig_lift(from, px, py, depth, x);
    adcgs_stereo_rig_project(to, x, at, &z);
    if (!(z > 1e-6))
        return 0;
    adcgs_stereo_rig_lift(from, px + 1, py, depth, x);
    adcgs_stereo_rig_project(to, x, next, &z);
    if (!(z > 1e-6))
        return 0;
    adcgs_stereo_rig_lift(from, px, py + 1, depth, x);
    adcgs_stereo_rig_project(to, x, below, &z);
    if (!(z > 1e-6))
        return 0;
    for (int a = 0; a < 2; a++) {
        right[a] = next[a] - at[a];
        down[a] = below[a] - at[a];
    }
    return 1;
}

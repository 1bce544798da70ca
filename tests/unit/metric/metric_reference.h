/* SPDX-License-Identifier: BSD-2-Clause */
/** \file SSIM and MS-SSIM, computed directly from their definitions, and random images. */
#ifndef ADCGS_TESTS_METRIC_REFERENCE_H
#define ADCGS_TESTS_METRIC_REFERENCE_H

#include "base/base.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

static uint32_t seed = 1;

static inline float random_value(void)
{
    seed = seed * 1664525u + 1013904223u;
    return (float)(seed >> 8) / 16777216.0f;
}

/** A pixel of a channel, 0 beyond the edges. */
static inline double at(const float *plane, int width, int height, int x, int y)
{
    return x < 0 || y < 0 || x >= width || y >= height ? 0.0 : (double)plane[y * width + x];
}

/** The definition, written out: a two-dimensional window of 11x11 around every pixel. */
static inline double reference_ssim(const float *a, const float *b, int width, int height)
{
    double weight[11][11], sum = 0.0, total = 0.0;
    for (int i = 0; i < 11; i++)
        for (int j = 0; j < 11; j++)
            sum += weight[i][j] = exp(-((i - 5) * (i - 5) + (j - 5) * (j - 5)) / (2 * 1.5 * 1.5));
    for (int c = 0; c < 3; c++)
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++) {
                double ma = 0, mb = 0, aa = 0, bb = 0, ab = 0;
                for (int i = 0; i < 11; i++)
                    for (int j = 0; j < 11; j++) {
                        const double w = weight[i][j] / sum;
                        const double va = at(a + c * width * height, width, height, x + j - 5, y + i - 5);
                        const double vb = at(b + c * width * height, width, height, x + j - 5, y + i - 5);
                        ma += w * va;
                        mb += w * vb;
                        aa += w * va * va;
                        bb += w * vb * vb;
                        ab += w * va * vb;
                    }
                total += (2 * ma * mb + 1e-4) * (2 * (ab - ma * mb) + 9e-4) /
                         ((ma * ma + mb * mb + 1e-4) * (aa - ma * ma + bb - mb * mb + 9e-4));
            }
    return total / (3.0 * width * height);
}

/** Wang's definition, written out, for sides that all scales divide or exceed by a pixel: windows of 11x11 that stay inside. */
static inline double reference_ms_ssim(const float *a, const float *b, int width, int height, int scales)
{
    static const double exponents[5] = {0.0448, 0.2856, 0.3001, 0.2363, 0.1333};
    double mean = 0, sum_of_exponents = 0, window = 0;
    for (int i = 0; i < 121; i++)
        window += exp(-((i / 11 - 5) * (i / 11 - 5) + (i % 11 - 5) * (i % 11 - 5)) / 4.5);
    for (int i = 0; i < scales; i++)
        sum_of_exponents += exponents[i];
    for (int c = 0; c < 3; c++) {
        double product = 1;
        for (int scale = 0; scale < scales; scale++) {
            /* A pixel of a scale is the mean of its box of the first scale. */
            const int box = 1 << scale, w = (width + box - 1) / box, h = (height + box - 1) / box;
            double *p[2] = {calloc((size_t)(w * h), sizeof(double)), calloc((size_t)(w * h), sizeof(double))}, sum = 0;
            for (int y = 0; y < h * box; y++)
                for (int x = 0; x < w * box; x++)
                    for (int k = 0; k < 2; k++) {
                        const float *plane = (k ? b : a) + c * width * height;
                        p[k][y / box * w + x / box] +=
                            (double)plane[ADCGS_MIN(y, height - 1) * width + ADCGS_MIN(x, width - 1)] / (box * box);
                    }
            for (int y = 5; y < h - 5; y++)
                for (int x = 5; x < w - 5; x++) {
                    double ma = 0, mb = 0, aa = 0, bb = 0, ab = 0;
                    for (int i = -5; i <= 5; i++)
                        for (int j = -5; j <= 5; j++) {
                            const double weight = exp(-(i * i + j * j) / 4.5) / window;
                            const double va = p[0][(y + i) * w + x + j], vb = p[1][(y + i) * w + x + j];
                            ma += weight * va;
                            mb += weight * vb;
                            aa += weight * va * va;
                            bb += weight * vb * vb;
                            ab += weight * va * vb;
                        }
                    const double structure = (2 * (ab - ma * mb) + 9e-4) / (aa - ma * ma + bb - mb * mb + 9e-4);
                    const double luminance = (2 * ma * mb + 1e-4) / (ma * ma + mb * mb + 1e-4);
                    sum += scale + 1 < scales ? structure : structure * luminance;
                }
            product *= pow(sum / ((w - 10) * (h - 10)), exponents[scale] / (scales < 5 ? sum_of_exponents : 1));
            free(p[0]);
            free(p[1]);
        }
        mean += product / 3;
    }
    return mean;
}

#endif

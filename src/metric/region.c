/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Regions of an image, by counts along rows, then columns. */
#include "metric/region.h"

/** out: for each of n values, `stride` apart, the sum of the values of in within `reach`. */
static void sum_near(const uint8_t *in, uint8_t *out, int n, size_t stride, int reach)
{
    for (int i = 0; i < n; i++) {
        const int last = ADCGS_MIN(i + reach, n - 1);
        uint8_t sum = 0;
        for (int j = ADCGS_MAX(i - reach, 0); j <= last; j++)
            sum = (uint8_t)(sum + in[(size_t)j * stride]);
        out[(size_t)i * stride] = sum;
    }
}

/** Replace each pixel of the region by the number of its pixels within reach. */
static void count_near(uint8_t *region, uint8_t *scratch, int width, int height, int reach)
{
    const size_t row = (size_t)width;
    for (size_t y = 0; y < (size_t)height; y++)
        sum_near(region + y * row, scratch + y * row, width, 1, reach);
    for (size_t x = 0; x < row; x++)
        sum_near(scratch + x, region + x, height, row, reach);
}

/** Number of pixels, in a row of n, within reach of the i-th. */
static int row_near(int i, int n, int reach)
{
    return ADCGS_MIN(i + reach, n - 1) - ADCGS_MAX(i - reach, 0) + 1;
}

void adcgs_region_majority(uint8_t *region, uint8_t *scratch, int width, int height, int reach)
{
    count_near(region, scratch, width, height, reach);
    for (size_t i = 0; i < (size_t)width * (size_t)height; i++) {
        const int x = (int)(i % (size_t)width), y = (int)(i / (size_t)width);
        region[i] = 2 * region[i] > row_near(x, width, reach) * row_near(y, height, reach);
    }
}

void adcgs_region_dilate(uint8_t *region, uint8_t *scratch, int width, int height, int reach)
{
    count_near(region, scratch, width, height, reach);
    for (size_t i = 0; i < (size_t)width * (size_t)height; i++)
        region[i] = region[i] > 0;
}

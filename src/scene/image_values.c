/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Values of images in 8 or 16 bits. */
#include "config.h"

#include "scene/image_values.h"

#include <math.h>

#define FULL 65535.0f /* largest 16-bit value; arithmetic */
#define FULL_8 255.0f /* largest 8-bit value; arithmetic: x / 255 is 257 x / 65535 */
#define LEVEL 257     /* step in 16 bits for one level of 8 bits; arithmetic: 65535 / 255 */

static int is_wide(const float *values, size_t n)
{
    int wide = 0;
    for (size_t i = 0; i < n; i++)
        wide |= !(values[i] >= 0.0f && values[i] <= 1.0f);
    return wide;
}

static inline uint16_t to_16(float value)
{
    return (uint16_t)(value * FULL + 0.5f);
}

/** A narrower value never overtakes its source. */
uint8_t adcgs_values_narrow(float *values, size_t n)
{
    uint32_t between = 0;
    if (is_wide(values, n))
        return sizeof *values;
    for (size_t i = 0; i < n; i++) {
        const uint16_t value = to_16(values[i]);
        between |= value % LEVEL;
        memcpy((char *)values + i * sizeof value, &value, sizeof value);
    }
    for (size_t i = 0; !between && i < n; i++) {
        uint16_t value;
        memcpy(&value, (char *)values + i * sizeof value, sizeof value);
        ((uint8_t *)values)[i] = (uint8_t)(value / LEVEL);
    }
    return between ? 2 : 1;
}

static inline void widen(float *to, size_t step, const void *values, int bytes, size_t n)
{
    for (size_t i = 0; bytes == 1 && i < n; i++)
        to[i * step] = (float)((const uint8_t *)values)[i] / FULL_8;
    for (size_t i = 0; bytes == 2 && i < n; i++)
        to[i * step] = (float)((const uint16_t *)values)[i] / FULL;
    for (size_t i = 0; bytes == 4 && i < n; i++)
        to[i * step] = ((const float *)values)[i];
}

void adcgs_values_widen(float *to, size_t step, const void *values, int bytes, size_t n)
{
    if (step == 1) /* each iteration of training does this for an image: the compiler vectorises it */
        widen(to, 1, values, bytes, n);
    else
        widen(to, step, values, bytes, n);
}

float adcgs_value_round(float value)
{
    return (float)to_16(fminf(fmaxf(value, 0.0f), 1.0f)) / FULL;
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Procedural textures: functions of a point in an object's own coordinates only. */
#include "synthetic/texture.h"

#include "synthetic/sine.h"

/* Largest integer not above x, for |x| < 2^31; no libm. */
static int floor_int(double x)
{
    const int i = (int)x;
    return x < (double)i ? i - 1 : i;
}

double adcgs_texture_random(int x, int y, int z, uint32_t seed)
{
    uint32_t h = seed * 0x9e3779b1u + (uint32_t)x * 0x85ebca6bu;
    h = (h ^ h >> 15) * 0x2c1b3c6du + (uint32_t)y * 0xc2b2ae35u;
    h = (h ^ h >> 13) * 0x297a2d39u + (uint32_t)z * 0x27d4eb2fu;
    h = (h ^ h >> 16) * 0x7feb352du;
    h ^= h >> 15;
    return (double)(h >> 8) / 16777216.0;
}

static double smooth(double f)
{
    return f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
}

static double blend(double a, double b, double f)
{
    return a + (b - a) * f;
}

static double corner(const int cell[3], int x, int y, int z, uint32_t seed)
{
    return adcgs_texture_random(cell[0] + x, cell[1] + y, cell[2] + z, seed);
}

double adcgs_texture_noise(const double point[3], uint32_t seed)
{
    int i[3];
    double f[3];
    for (int a = 0; a < 3; a++) {
        i[a] = floor_int(point[a]);
        f[a] = smooth(point[a] - (double)i[a]);
    }
    double z[2];
    for (int k = 0; k < 2; k++) {
        const double y0 = blend(corner(i, 0, 0, k, seed), corner(i, 1, 0, k, seed), f[0]);
        const double y1 = blend(corner(i, 0, 1, k, seed), corner(i, 1, 1, k, seed), f[0]);
        z[k] = blend(y0, y1, f[1]);
    }
    return blend(z[0], z[1], f[2]);
}

static double octaves(const double point[3], uint32_t seed)
{
    double sum = 0.0, weight = 0.5, scale = 1.0;
    for (uint32_t o = 0; o < 3; o++) {
        const double p[3] = {point[0] * scale, point[1] * scale, point[2] * scale};
        sum += weight * adcgs_texture_noise(p, seed + o);
        weight *= 0.5;
        scale *= 2.0;
    }
    return sum / 0.875;
}

static double dots(const double p[3])
{
    double r2 = 0.0;
    for (int a = 0; a < 3; a++) {
        const double d = p[a] - (double)floor_int(p[a]) - 0.5;
        r2 += d * d;
    }
    const double edge = (0.18 - r2) * 12.0;
    return edge <= 0.0 ? 0.0 : edge >= 1.0 ? 1.0 : smooth(edge);
}

double adcgs_texture_mix(const adcgs_trace_object *object, const double point[3])
{
    /* The offset keeps cell borders off the symmetry planes of shapes, where rounding would select the cell. */
    double p[3];
    for (int a = 0; a < 3; a++)
        p[a] = point[a] * object->frequency + 0.3125;
    switch (object->texture) {
    case ADCGS_TEXTURE_CHECKER:
        return (double)((floor_int(p[0]) + floor_int(p[1]) + floor_int(p[2])) & 1);
    case ADCGS_TEXTURE_STRIPES:
        return 0.5 + 0.5 * adcgs_trace_sin(p[0] + 0.5 * p[2]);
    case ADCGS_TEXTURE_NOISE:
        return octaves(p, object->seed);
    case ADCGS_TEXTURE_RINGS:
        return 0.5 + 0.5 * adcgs_trace_sin((point[0] * point[0] + point[1] * point[1]) * object->frequency);
    case ADCGS_TEXTURE_PATCHES:
        return adcgs_texture_random(floor_int(p[0]), floor_int(p[1]), floor_int(p[2]), object->seed);
    case ADCGS_TEXTURE_DOTS:
        return dots(p);
    default:
        return 0.0;
    }
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Synthetic splats and cameras for the tests and benchmarks of the renderer. */
#ifndef TESTS_PIXELS_SCENE_H
#define TESTS_PIXELS_SCENE_H

#include "render/render.h"

#include <math.h>
#include <stdlib.h>

/* xorshift64*: the same splats on every machine. */
static inline double scene_uniform(uint64_t *state)
{
    *state ^= *state >> 12;
    *state ^= *state << 25;
    *state ^= *state >> 27;
    return (double)((*state * 0x2545f4914f6cdd1dull) >> 11) * 0x1p-53;
}

static inline double scene_normal(uint64_t *state)
{
    double sum = -6.0;
    for (int i = 0; i < 12; i++)
        sum += scene_uniform(state);
    return sum;
}

/** Writable arrays of primitives: 14 arrays of n floats in one block. */
typedef struct scene_splats {
    uint32_t n;
    float *data;
} scene_splats;

enum { SCENE_MEAN = 0, SCENE_SCALE = 3, SCENE_ROTATION = 6, SCENE_OPACITY = 10, SCENE_COLOUR = 11, SCENE_ARRAYS = 14 };

static inline scene_splats scene_create(uint32_t n)
{
    const uint32_t slots = (n + 63) / 64 * 64;
    scene_splats s = {slots, adcgs_alloc(NULL, (size_t)slots * SCENE_ARRAYS + 64, sizeof(float), NULL)};
    for (uint32_t i = 0; i < slots; i++) {
        s.data[(size_t)SCENE_ROTATION * slots + i] = 1.0f;
        for (int a = SCENE_SCALE; a < SCENE_ROTATION; a++)
            s.data[(size_t)a * slots + i] = 1.0f;
    }
    return s;
}

static inline float *scene_array(const scene_splats *s, int array)
{
    return s->data + (size_t)array * s->n;
}

static inline adcgs_primitives scene_primitives(const scene_splats *s)
{
    adcgs_primitives p = {.n = s->n, .opacity = scene_array(s, SCENE_OPACITY)};
    for (int i = 0; i < 3; i++) {
        p.mean[i] = scene_array(s, SCENE_MEAN + i);
        p.scale[i] = scene_array(s, SCENE_SCALE + i);
        p.colour[i] = scene_array(s, SCENE_COLOUR + i);
    }
    for (int i = 0; i < 4; i++)
        p.rotation[i] = scene_array(s, SCENE_ROTATION + i);
    return p;
}

static inline void scene_random_rotation(const scene_splats *s, uint32_t i, uint64_t *state)
{
    double q[4], norm = 1e-9;
    for (int a = 0; a < 4; a++) {
        q[a] = scene_normal(state);
        norm += q[a] * q[a];
    }
    for (int a = 0; a < 4; a++)
        scene_array(s, SCENE_ROTATION + a)[i] = (float)(q[a] / sqrt(norm));
}

/**
 * n splats on a shell, on a wall and in the volume, in front of scene_camera(): anisotropic log-normal scales, half of the
 * opacities low and half high. overlap is about the number of splats over a pixel.
 */
static inline scene_splats scene_room(uint32_t n, double overlap, uint64_t seed)
{
    scene_splats s = scene_create(n);
    uint64_t state = seed * 0x9e3779b97f4a7c15ull + 1;
    const double base = 0.0195 * sqrt(overlap * 500.0 / (double)n);
    for (uint32_t i = 0; i < n; i++) {
        const double kind = scene_uniform(&state);
        double p[3];
        if (kind < 0.4) {
            double norm = 1e-9;
            for (int a = 0; a < 3; a++) {
                p[a] = scene_normal(&state);
                norm += p[a] * p[a];
            }
            for (int a = 0; a < 3; a++)
                p[a] *= 0.8 / sqrt(norm);
        } else {
            for (int a = 0; a < 3; a++)
                p[a] = 2.0 * scene_uniform(&state) - 1.0;
            if (kind < 0.7)
                p[2] = 1.0 + 0.02 * p[2];
        }
        for (int a = 0; a < 3; a++) {
            scene_array(&s, SCENE_MEAN + a)[i] = (float)p[a];
            scene_array(&s, SCENE_SCALE + a)[i] = (float)(base * exp(0.6 * scene_normal(&state)));
            scene_array(&s, SCENE_COLOUR + a)[i] = (float)scene_uniform(&state);
        }
        scene_random_rotation(&s, i, &state);
        const double o = scene_uniform(&state);
        scene_array(&s, SCENE_OPACITY)[i] = (float)(i & 1 ? 0.02 + 0.2 * o : 0.6 + 0.39 * o);
    }
    return s;
}

/** Looks along +z at the cube [-1,1]^3 from a distance of 3.2. */
static inline adcgs_camera scene_camera(int width, int height)
{
    adcgs_camera c = {.width = width, .height = height, .near_plane = 0.05};
    c.fx = c.fy = 1.15 * (width > height ? width : height);
    c.cx = 0.5 * width;
    c.cy = 0.5 * height;
    c.cam_to_world[0] = c.cam_to_world[5] = c.cam_to_world[10] = 1.0;
    c.cam_to_world[11] = -3.2;
    return c;
}

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Scale penalty. */
#include "fmodel/scale_penalty.h"

#include <math.h>

/* Minimum distance of a primitive from a viewpoint, scene units; chosen by hand, not measured. */
static const float NEAREST = 0.05f;
/* Number of primitives processed together in the search for viewpoints; a group, definition. */
enum { PIECE = 64 };

/* Minimum opacity; fainter primitives, such as those outside their lifetime, do not count; chosen by hand, not measured. */
static const float THERE = 1e-6f;

static float distance2(const float a[3], const float b[3])
{
    return (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]);
}

/** Adds the midpoints between a camera and its two nearest other cameras. */
static void add_between(adcgs_viewpoints *p, uint32_t n, uint32_t i)
{
    uint32_t best[2] = {i, i};
    for (uint32_t j = 0; j < n; j++) {
        const float d = distance2(p->x[i], p->x[j]);
        if (j == i)
            continue;
        if (best[0] == i || d < distance2(p->x[i], p->x[best[0]])) {
            best[1] = best[0];
            best[0] = j;
        } else if (best[1] == i || d < distance2(p->x[i], p->x[best[1]])) {
            best[1] = j;
        }
    }
    for (int k = 0; k < 2; k++, p->n++)
        for (int a = 0; a < 3; a++)
            p->x[p->n][a] = 0.5f * (p->x[i][a] + p->x[best[k]][a]);
}

adcgs_status adcgs_viewpoints_create(adcgs_viewpoints *p, const float (*camera)[3], uint32_t n_cameras, adcgs_error *error)
{
    p->n = 0;
    p->x = adcgs_alloc(NULL, 3 * (size_t)n_cameras, sizeof *p->x, error);
    if (!p->x)
        return adcgs_alloc_status(error);
    for (uint32_t i = 0; i < n_cameras; i++) {
        uint32_t j = 0;
        while (j < p->n && memcmp(p->x[j], camera[i], sizeof camera[i]) != 0)
            j++;
        if (j == p->n)
            memcpy(p->x[p->n++], camera[i], sizeof camera[i]);
    }
    const uint32_t n = p->n;
    for (uint32_t i = 0; i < n; i++)
        add_between(p, n, i);
    return ADCGS_OK;
}

void adcgs_viewpoints_clear(adcgs_viewpoints *p)
{
    adcgs_free(NULL, p->x);
    *p = (adcgs_viewpoints){.n = 0};
}

/**
 * Scale of areas as seen from the nearest viewpoint relative to distance 1, for `some` primitives from `first`; 1 without
 * viewpoints. The inner loop is over primitives, and avoids fminf() with its NaN rules, so that compilers can vectorise it.
 */
static void nearness(float near[PIECE], const adcgs_viewpoints *p, const adcgs_primitives *primitives, uint32_t first,
                     uint32_t some)
{
    for (uint32_t l = 0; l < PIECE; l++)
        near[l] = p->n ? INFINITY : 1;
    for (uint32_t j = 0; j < p->n; j++) {
        const float *x = primitives->mean[0] + first, *y = primitives->mean[1] + first, *z = primitives->mean[2] + first;
        const float a = p->x[j][0], b = p->x[j][1], c = p->x[j][2];
        for (uint32_t l = 0; l < some; l++) {
            const float d = (x[l] - a) * (x[l] - a) + (y[l] - b) * (y[l] - b) + (z[l] - c) * (z[l] - c);
            near[l] = d < near[l] ? d : near[l];
        }
    }
    for (uint32_t l = 0; l < PIECE; l++)
        near[l] = 1 / fmaxf(near[l], NEAREST * NEAREST);
}

double adcgs_scale_penalty(const adcgs_primitives *primitives, const adcgs_viewpoints *viewpoints, float weight,
                           float *const scale[3])
{
    const float *x = primitives->scale[0], *y = primitives->scale[1], *z = primitives->scale[2];
    uint32_t n = 0;
    double area = 0;
    for (uint32_t i = 0; i < primitives->n; i++)
        n += primitives->opacity[i] > THERE;
    const float share = weight / (3 * (float)ADCGS_MAX(n, 1u));
    for (uint32_t first = 0; first < primitives->n; first += PIECE) {
        const uint32_t some = ADCGS_MIN(primitives->n - first, PIECE);
        float near[PIECE];
        nearness(near, viewpoints, primitives, first, some);
        for (uint32_t i = first; i < first + some; i++) {
            if (!(primitives->opacity[i] > THERE))
                continue;
            const float each = share * near[i - first];
            area += (double)each * (double)(x[i] * y[i] + y[i] * z[i] + z[i] * x[i]);
            scale[0][i] += each * (y[i] + z[i]);
            scale[1][i] += each * (z[i] + x[i]);
            scale[2][i] += each * (x[i] + y[i]);
        }
    }
    return area;
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Splats in memory, and conversion from a decoder's primitives. */
#include "config.h"

#include "media/splats/splats.h"

#include "media/splats/offset.h"

#include <math.h>
#include <stdlib.h>

#define ARRAYS 14 /* of floats per splat; arithmetic, 3 + 3 + 4 + 1 + 3 */
#define ALIGN 64  /* bytes; definition (splats.h) */

static void place(adcgs_splats *s, float *block, size_t slots)
{
    float **const arrays[ARRAYS] = {&s->mean[0],  &s->mean[1],     &s->mean[2],     &s->scale[0],    &s->scale[1],
                                    &s->scale[2], &s->rotation[0], &s->rotation[1], &s->rotation[2], &s->rotation[3],
                                    &s->opacity,  &s->colour[0],   &s->colour[1],   &s->colour[2]};
    for (size_t i = 0; i < ARRAYS; i++)
        *arrays[i] = block + i * slots;
    for (size_t i = 0; i < slots; i++)
        s->scale[0][i] = s->scale[1][i] = s->scale[2][i] = s->rotation[0][i] = 1.0f;
    s->block = block;
}

adcgs_status adcgs_splats_alloc(adcgs_splats *splats, uint64_t n, const char *path, adcgs_error *error)
{
    *splats = (adcgs_splats){0};
    if (n > ADCGS_SPLATS_MAX)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %llu splats, expected at most %u", path, (unsigned long long)n,
                          ADCGS_SPLATS_MAX);
    const size_t slots = ((size_t)n + 63) / 64 * 64 + 64 * !n, bytes = ARRAYS * slots * sizeof(float);
    float *block = aligned_alloc(ALIGN, bytes);
    if (!block)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %llu splats", path, (unsigned long long)n);
    memset(block, 0, bytes);
    place(splats, block, slots);
    splats->n = (uint32_t)n;
    return ADCGS_OK;
}

void adcgs_splats_free(adcgs_splats *splats)
{
    free(splats->block);
    free(splats->harmonics);
    *splats = (adcgs_splats){0};
}

/** Number of coefficients per channel above degree 0. */
static size_t coefficients(int degree)
{
    return (size_t)((degree + 1) * (degree + 1) - 1);
}

/** Copy a part's harmonics behind `first` splats; coefficients of higher degrees are already zero. */
static void join_harmonics(adcgs_splats *out, uint32_t first, const adcgs_splats *part)
{
    const size_t to = coefficients(out->degree), from = coefficients(part->degree);
    for (size_t i = 0; i < (size_t)3 * part->n && from; i++)
        memcpy(out->harmonics + (3 * (size_t)first + i) * to, part->harmonics + i * from, from * sizeof *out->harmonics);
}

static void join_arrays(adcgs_splats *out, uint32_t first, const adcgs_splats *part)
{
    const size_t bytes = part->n * sizeof(float);
    for (int a = 0; a < 3; a++) {
        memcpy(out->mean[a] + first, part->mean[a], bytes);
        memcpy(out->scale[a] + first, part->scale[a], bytes);
        memcpy(out->colour[a] + first, part->colour[a], bytes);
    }
    for (int a = 0; a < 4; a++)
        memcpy(out->rotation[a] + first, part->rotation[a], bytes);
    memcpy(out->opacity + first, part->opacity, bytes);
}

adcgs_status adcgs_splats_join(adcgs_splats *out, const adcgs_splats *parts, size_t n, const char *path, adcgs_error *error)
{
    uint64_t total = 0;
    uint32_t first = 0;
    int degree = 0;
    *out = (adcgs_splats){0};
    for (size_t i = 0; i < n; i++) {
        total += parts[i].n;
        degree = ADCGS_MAX(degree, parts[i].degree);
        if (parts[i].antialiased != parts->antialiased)
            return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: some splats are antialiased and some are not", path);
    }
    ADCGS_TRY(adcgs_splats_alloc(out, total, path, error));
    out->degree = degree;
    out->axes = parts->axes;
    out->antialiased = parts->antialiased;
    out->harmonics = degree ? calloc((size_t)total * 3 * coefficients(degree), sizeof *out->harmonics) : NULL;
    if (degree && !out->harmonics) {
        adcgs_splats_free(out);
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %llu splats", path, (unsigned long long)total);
    }
    for (size_t i = 0; i < n; first += parts[i++].n) {
        join_arrays(out, first, &parts[i]);
        join_harmonics(out, first, &parts[i]);
    }
    return ADCGS_OK;
}

adcgs_status adcgs_splats_copy(adcgs_splats *out, const adcgs_splats *splats, const char *path, adcgs_error *error)
{
    ADCGS_TRY(adcgs_splats_join(out, splats, 1, path, error));
    memcpy(out->offset, splats->offset, sizeof out->offset);
    return ADCGS_OK;
}

void adcgs_splats_primitives(const adcgs_splats *splats, adcgs_primitives *out)
{
    *out = (adcgs_primitives){.n = (splats->n + 63) / 64 * 64, .opacity = splats->opacity};
    for (int i = 0; i < 3; i++) {
        out->mean[i] = splats->mean[i];
        out->scale[i] = splats->scale[i];
        out->colour[i] = splats->colour[i];
    }
    for (int i = 0; i < 4; i++)
        out->rotation[i] = splats->rotation[i];
}

int adcgs_splats_take_one(adcgs_splats *out, uint32_t to, const adcgs_primitives *p, uint32_t from, const double origin[3],
                          double scale)
{
    if (!(p->opacity[from] > 0.0f))
        return 0;
    int finite = 1;
    out->opacity[to] = p->opacity[from];
    for (int a = 0; a < 3; a++) {
        out->mean[a][to] = (float)(origin[a] + scale * (double)p->mean[a][from]);
        out->scale[a][to] = (float)(scale * (double)p->scale[a][from]);
        out->colour[a][to] = p->colour[a][from];
        finite &= isfinite(out->mean[a][to]) && isnormal(out->scale[a][to]);
    }
    for (int a = 0; a < 4; a++)
        out->rotation[a][to] = p->rotation[a][from];
    return finite;
}

adcgs_status adcgs_splats_take(adcgs_splats *out, const adcgs_primitives *primitives, const double origin[3], double scale,
                               const double *offset, const char *path, adcgs_error *error)
{
    uint32_t n = 0;
    double near_by[3];
    ADCGS_TRY(adcgs_splats_alloc(out, primitives->n, path, error));
    if (offset)
        memcpy(out->offset, offset, sizeof out->offset);
    else
        adcgs_offset_of(out->offset, origin, scale);
    for (int a = 0; a < 3; a++)
        near_by[a] = origin[a] - out->offset[a];
    for (uint32_t i = 0; i < primitives->n; i++)
        n += (uint32_t)adcgs_splats_take_one(out, n, primitives, i, near_by, scale);
    for (uint32_t i = n; i < out->n; i++) /* a dropped primitive may have been stored here */
        out->opacity[i] = 0.0f;
    out->n = n;
    return ADCGS_OK;
}

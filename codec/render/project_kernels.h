/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Body of the projection kernel: projects 64 slots at a time, then stores the visible ones as records. */
#include "render/project.h"

#include <stdalign.h>

typedef struct lanes64 {
    alignas(64) float u[64], v[64], a[64], b[64], c[64], log2_opacity[64], z[64];
    alignas(64) float slope[64], width[64], ym[64], y_right[64];
    alignas(64) int32_t x0[64], x1[64], y0[64], y1[64], drawn[64];
} lanes64;

/* Twice the natural logarithm of the ratio by which alpha may fall. The margin covers the rounding of the blend, which grows
 * with the condition number of the covariance, so that culling never changes the image. */
static inline float reach(float log2_opacity, float condition)
{
    return 0x1.62e43p+0f * ((log2_opacity - ADCGS_POWER_MIN) + 0x1p-9f) * fmaf(condition, 0x1p-19f, 1.0f);
}

static inline int32_t tile_below(int ok, float pixel, float tiles)
{
    return (int32_t)adcgs_clampf(ok ? pixel * 0x1p-4f : 0.0f, 0.0f, tiles);
}

static void project_lanes(lanes64 *o, const adcgs_project_job *job, uint32_t first)
{
    const adcgs_primitives *s = job->primitives;
    const adcgs_view view = *job->view;
    const float filter = job->filter, tiles_x = (float)job->tiles_x, tiles_y = (float)job->tiles_y;
    const float *mx = s->mean[0] + first, *my = s->mean[1] + first, *mz = s->mean[2] + first;
    const float *sx = s->scale[0] + first, *sy = s->scale[1] + first, *sz = s->scale[2] + first;
    const float *qw = s->rotation[0] + first, *qx = s->rotation[1] + first;
    const float *qy = s->rotation[2] + first, *qz = s->rotation[3] + first;
    const float *opacity = s->opacity + first;
    for (int l = 0; l < 64; l++) {
        adcgs_projection g;
        adcgs_project_centre(&g, &view, mx[l], my[l], mz[l]);
        adcgs_quaternion_matrix(g.rot, qw[l], qx[l], qy[l], qz[l]);
        adcgs_project_shape(&g, &view, filter, sx[l], sy[l], sz[l]);
        const int ok = adcgs_project_drawn(&g, &view, opacity[l]);
        const float inv = 1.0f / g.det, cp = g.p * inv, cq = g.q * inv, cr = g.r * inv;
        const float log2_opacity = adcgs_log2(opacity[l]);
        o->u[l] = g.u;
        o->v[l] = g.v;
        o->z[l] = g.z;
        o->a[l] = (-0.5f * ADCGS_LOG2E) * cr;
        o->b[l] = ADCGS_LOG2E * cq;
        o->c[l] = (-0.5f * ADCGS_LOG2E) * cp;
        o->log2_opacity[l] = log2_opacity;
        const float k = reach(log2_opacity, g.p * cr);
        const float xm = sqrtf(k * g.p), ym = sqrtf(k * g.r), ir = 1.0f / g.r;
        o->slope[l] = g.q * ir;
        o->width[l] = sqrtf(g.det) * ir;
        o->ym[l] = ym;
        o->y_right[l] = g.q * xm / g.p;
        /* The centres of the affected pixels lie in [u - xm, u + xm]. */
        const float ex = fmaf(xm + fabsf(g.u), 0x1p-20f, 0x1p-5f), ey = fmaf(ym + fabsf(g.v), 0x1p-20f, 0x1p-5f);
        const int32_t x0 = tile_below(ok, g.u - (xm + ex) + 0.5f, tiles_x), x1 = tile_below(ok, g.u + (xm + ex) + 15.5f, tiles_x);
        const int32_t y0 = tile_below(ok, g.v - (ym + ey) + 0.5f, tiles_y), y1 = tile_below(ok, g.v + (ym + ey) + 15.5f, tiles_y);
        o->x0[l] = x0;
        o->x1[l] = x1;
        o->y0[l] = y0;
        o->y1[l] = y1;
        o->drawn[l] = ok & (x0 < x1) & (y0 < y1);
    }
}

static uint32_t project(const adcgs_project_job *job, uint32_t first, uint32_t at)
{
    lanes64 o;
    const adcgs_primitives *s = job->primitives;
    uint32_t n = at;
    project_lanes(&o, job, first);
    for (uint32_t l = 0; l < 64; l++) {
        if (!o.drawn[l])
            continue;
        adcgs_splat2d *record = job->splats + n;
        record->x = o.u[l];
        record->y = o.v[l];
        record->a = o.a[l];
        record->b = o.b[l];
        record->c = o.c[l];
        record->log2_opacity = o.log2_opacity[l];
        for (int c = 0; c < 3; c++)
            record->rgb[c] = s->colour[c][first + l];
        record->depth = o.z[l];
        record->tile[0] = (uint16_t)o.x0[l];
        record->tile[1] = (uint16_t)o.y0[l];
        record->tile[2] = (uint16_t)o.x1[l];
        record->tile[3] = (uint16_t)o.y1[l];
        record->slot = first + l;
        job->outlines[n] = (adcgs_outline){o.slope[l], o.width[l], o.ym[l], o.y_right[l]};
        job->areas[n] = (uint32_t)((o.x1[l] - o.x0[l]) * (o.y1[l] - o.y0[l]));
        job->keys[n] = (uint64_t)adcgs_float_bits(o.z[l]) << 32 | n;
        n++;
    }
    return n - at;
}

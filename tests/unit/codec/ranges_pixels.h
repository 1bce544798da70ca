/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Projection and blending by the specification's text, splat by splat and pixel by pixel without tiles. Each intermediate number
 * is checked against its range in annex "Numerical bounds".
 */
#ifndef TESTS_RANGES_PIXELS_H
#define TESTS_RANGES_PIXELS_H

#include "base/fmath.h"
#include "render/render.h"

#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <setjmp.h>
#include <cmocka.h>

/** The reason for not rendering a splat, or DRAWN. */
typedef enum verdict { DRAWN, BEHIND, FAINT, ASIDE, FLAT_OR_VAST, VERDICTS } verdict;

typedef struct drawn_splat {
    float u, v, z, a, b, c, l;
    float colour[3];
    uint32_t slot;
} drawn_splat;

/** NaN is in no range. */
static inline float ranges_inside(const char *what, float x, double low, double high)
{
    if (!(x >= low && x <= high))
        fail_msg("%s is %a, expected %a to %a", what, (double)x, low, high);
    return x;
}

static inline void ranges_rotation(float m[3][3], float w, float x, float y, float z)
{
    const float x2 = x + x, y2 = y + y, z2 = z + z;
    const float rows[3][3] = {{fmaf(-y2, y, fmaf(-z2, z, 1.0f)), fmaf(x2, y, -(w * z2)), fmaf(x2, z, w * y2)},
                              {fmaf(x2, y, w * z2), fmaf(-x2, x, fmaf(-z2, z, 1.0f)), fmaf(y2, z, -(w * x2))},
                              {fmaf(x2, z, -(w * y2)), fmaf(y2, z, w * x2), fmaf(-x2, x, fmaf(-y2, y, 1.0f))}};
    memcpy(m, rows, sizeof rows);
}

/** f: two rows, of the image's axes; l: x/z and y/z, limited. */
static inline void ranges_footprint(float f[2][3], const adcgs_view *view, const adcgs_primitives *s, uint32_t i, float iz,
                                    const float l[2])
{
    const float *const turn = view->rotation;
    float axes[3][3];
    ranges_rotation(axes, s->rotation[0][i], s->rotation[1][i], s->rotation[2][i], s->rotation[3][i]);
    for (int r = 0; r < 2; r++) {
        const float along = (r ? view->fy : view->fx) * iz, across = along * l[r];
        float m[3];
        for (int j = 0; j < 3; j++)
            m[j] = fmaf(-across, turn[6 + j], along * turn[3 * r + j]);
        for (int j = 0; j < 3; j++) {
            const float sum = fmaf(m[2], axes[2][j], fmaf(m[1], axes[1][j], m[0] * axes[0][j]));
            f[r][j] = ranges_inside("footprint.any", sum * s->scale[j][i], -0x1p106, 0x1p106);
        }
    }
}

/** The numbers a, b and c of a rendered splat, from its covariance. */
static inline void ranges_conic(drawn_splat *o, float p, float q, float r)
{
    const float qq = q * q;
    const float determinant = ranges_inside("drawn.determinant", fmaf(p, r, -qq) + fmaf(-q, q, qq), 0x1p-58, 0x1p81);
    const float inverse = ranges_inside("drawn.inverse", 1.0f / determinant, 0x1p-81, 0x1p58);
    o->a = ranges_inside("drawn.a", -0x1.715476p-1f * (r * inverse), -0x1p37, -0x1p-41);
    o->b = ranges_inside("drawn.b", 0x1.715476p+0f * (q * inverse), -0x1p38, 0x1p38);
    o->c = ranges_inside("drawn.c", -0x1.715476p-1f * (p * inverse), -0x1p37, -0x1p-41);
}

static inline verdict ranges_shape(drawn_splat *o, const adcgs_view *view, const adcgs_primitives *s, uint32_t i, float filter,
                                   float iz, const float l[2])
{
    float f[2][3];
    ranges_footprint(f, view, s, i, iz, l);
    const float p = fmaf(f[0][2], f[0][2], fmaf(f[0][1], f[0][1], fmaf(f[0][0], f[0][0], filter)));
    const float r = fmaf(f[1][2], f[1][2], fmaf(f[1][1], f[1][1], fmaf(f[1][0], f[1][0], filter)));
    assert_true(p >= 0 && r >= 0); /* possibly infinite, never NaN */
    if (!(p >= 0x1p-20f && p <= 0x1p40f && r >= 0x1p-20f && r <= 0x1p40f))
        return FLAT_OR_VAST;
    const float q = 0x1.ffff8p-1f * fmaf(f[0][2], f[1][2], fmaf(f[0][1], f[1][1], f[0][0] * f[1][0]));
    ranges_conic(o, p, ranges_inside("drawn.q", q, -0x1p40, 0x1p40), r);
    return DRAWN;
}

static inline float ranges_coordinate(const adcgs_view *view, const adcgs_primitives *s, uint32_t i, int axis)
{
    const float *const row = view->rotation + 3 * axis;
    float x = view->translation[axis];
    for (int a = 0; a < 3; a++)
        x = fmaf(row[a], s->mean[a][i], x);
    return ranges_inside("point.camera", x, -0x1p31, 0x1p31);
}

static inline verdict ranges_project(drawn_splat *o, const adcgs_view *view, const adcgs_primitives *s, uint32_t i, float filter)
{
    const float x = ranges_coordinate(view, s, i, 0), y = ranges_coordinate(view, s, i, 1), z = ranges_coordinate(view, s, i, 2);
    if (!(z > view->near_plane))
        return BEHIND;
    if (!(s->opacity[i] >= 0x1.010102p-8f))
        return FAINT;
    const float iz = ranges_inside("point.iz", 1.0f / z, 0x1p-31, 0x1p30);
    const float tx = ranges_inside("point.tx", x * iz, -0x1p61, 0x1p61), ty = ranges_inside("point.tx", y * iz, -0x1p61, 0x1p61);
    o->z = z;
    o->slot = i;
    o->u = ranges_inside("point.u", fmaf(view->fx, tx, view->cx), -0x1p85, 0x1p85);
    o->v = ranges_inside("point.u", fmaf(view->fy, ty, view->cy), -0x1p85, 0x1p85);
    if (!(o->u >= -0x1p20f && o->u <= 0x1p20f && o->v >= -0x1p20f && o->v <= 0x1p20f))
        return ASIDE;
    o->l = ranges_inside("the logarithm of an opacity", adcgs_log2(s->opacity[i]), -0x1.ffa37cp+2, -0x1p-7);
    for (int c = 0; c < 3; c++)
        o->colour[c] = s->colour[c][i];
    const float l[2] = {adcgs_clampf(tx, view->limit[0], view->limit[1]), adcgs_clampf(ty, view->limit[2], view->limit[3])};
    return ranges_shape(o, view, s, i, filter, iz, l);
}

static inline int ranges_compare(const void *a, const void *b)
{
    const drawn_splat *const x = a, *const y = b;
    return x->z != y->z ? (x->z < y->z ? -1 : 1) : x->slot < y->slot ? -1 : x->slot > y->slot;
}

/** A pixel, and the number of splats that changed it. */
typedef struct blended {
    float x, y, t, colour[3];
    int layers;
} blended;

static inline void ranges_blend_pixel(blended *pixel, const drawn_splat *s)
{
    const float dx = pixel->x - s->u, dy = pixel->y - s->v;
    const float power = fmaf(dx, fmaf(s->a, dx, s->b * dy), fmaf(s->c * dy, dy, s->l));
    ranges_inside("power", power, -0x1p81, -0x1p-7);
    if (!(power >= -0x1.ffa37cp+2f))
        return;
    const float alpha = ranges_inside("blend.alpha", ranges_opacity_of(power), 0x1p-8, 1 - 0x1p-8), weight = alpha * pixel->t;
    for (int c = 0; c < 3; c++)
        pixel->colour[c] = ranges_inside("blend.colour", fmaf(s->colour[c], weight, pixel->colour[c]), -0x1p10, 0x1p10);
    pixel->t = ranges_inside("transmittance", fmaf(-alpha, pixel->t, pixel->t), 0, pixel->t);
    pixel->layers++;
}

/** Sixteen pixels, row by row. */
static inline void ranges_blend_block(blended pixels[16], const adcgs_view *view, const drawn_splat *splats, uint32_t n, int x,
                                      int y)
{
    for (int i = 0; i < 16; i++)
        pixels[i] = (blended){.x = (float)(x + (i & 3)) + 0.5f,
                              .y = (float)(y + (i >> 2)) + 0.5f,
                              .t = x + (i & 3) < view->width && y + (i >> 2) < view->height};
    for (uint32_t s = 0; s < n; s++) {
        int light = 0;
        for (int i = 0; i < 16; i++)
            light |= pixels[i].t >= 0x1.a36e2ep-14f;
        if (!light)
            return;
        for (int i = 0; i < 16; i++)
            ranges_blend_pixel(pixels + i, splats + s);
    }
}

#endif

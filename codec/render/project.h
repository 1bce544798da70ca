/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Projection of one Gaussian (spec clause "Projection"), straight-line so that
 * a loop over lanes vectorises. The forward and the backward pass share it.
 */
#ifndef ADCGS_RENDER_PROJECT_H
#define ADCGS_RENDER_PROJECT_H

#include "base/fmath.h"
#include "render/render.h"

/** log2(1/255): a splat adds nothing to a pixel if log2 of its alpha there is below this. */
#define ADCGS_POWER_MIN -0x1.ffa37cp+2f
/** 1/255: a splat with an opacity below this is not rendered. */
#define ADCGS_OPACITY_MIN 0x1.010102p-8f
/** Keeps the screen covariance invertible for the thinnest splats: its condition number stays below 2^18. */
#define ADCGS_SHEAR 0x1.ffff8p-1f
/** A pixel block is finished when all its transmittances are below this. */
#define ADCGS_T_MIN 0x1.a36e2ep-14f

#define ADCGS_LOG2E 0x1.715476p+0f

typedef struct adcgs_projection {
    float x, y, z;      /* camera coordinates */
    float iz, tx, ty;   /* 1/z, x/z, y/z */
    float lx, ly;       /* x/z and y/z, limited */
    float jx, jy;       /* fx/z, fy/z */
    float m[2][3];      /* Jacobian times view rotation */
    float rot[3][3];    /* rotation of the Gaussian */
    float mr[2][3];     /* m * rot */
    float f[2][3];      /* m * rot * diag(scale): the covariance is f f^T */
    float u, v;         /* centre in pixels */
    float p, q, r, det; /* screen covariance [p q; q r] and its determinant */
} adcgs_projection;

static inline void adcgs_quaternion_matrix(float rot[3][3], float w, float x, float y, float z)
{
    const float x2 = x + x, y2 = y + y, z2 = z + z;
    rot[0][0] = fmaf(-y2, y, fmaf(-z2, z, 1.0f));
    rot[0][1] = fmaf(x2, y, -(w * z2));
    rot[0][2] = fmaf(x2, z, w * y2);
    rot[1][0] = fmaf(x2, y, w * z2);
    rot[1][1] = fmaf(-x2, x, fmaf(-z2, z, 1.0f));
    rot[1][2] = fmaf(y2, z, -(w * x2));
    rot[2][0] = fmaf(x2, z, -(w * y2));
    rot[2][1] = fmaf(y2, z, w * x2);
    rot[2][2] = fmaf(-x2, x, fmaf(-y2, y, 1.0f));
}

static inline void adcgs_project_centre(adcgs_projection *o, const adcgs_view *view, float mx, float my, float mz)
{
    const float *r = view->rotation, *t = view->translation;
    o->x = fmaf(r[2], mz, fmaf(r[1], my, fmaf(r[0], mx, t[0])));
    o->y = fmaf(r[5], mz, fmaf(r[4], my, fmaf(r[3], mx, t[1])));
    o->z = fmaf(r[8], mz, fmaf(r[7], my, fmaf(r[6], mx, t[2])));
    o->iz = 1.0f / o->z;
    o->tx = o->x * o->iz;
    o->ty = o->y * o->iz;
    o->u = fmaf(view->fx, o->tx, view->cx);
    o->v = fmaf(view->fy, o->ty, view->cy);
}

/* Needs the centre and rot. */
static inline void adcgs_project_shape(adcgs_projection *o, const adcgs_view *view, float filter, float sx, float sy, float sz)
{
    const float *r = view->rotation;
    o->lx = adcgs_clampf(o->tx, view->limit[0], view->limit[1]);
    o->ly = adcgs_clampf(o->ty, view->limit[2], view->limit[3]);
    o->jx = view->fx * o->iz;
    o->jy = view->fy * o->iz;
    const float kx = o->jx * o->lx, ky = o->jy * o->ly;
    const float scale[3] = {sx, sy, sz};
    for (int j = 0; j < 3; j++) {
        o->m[0][j] = fmaf(-kx, r[6 + j], o->jx * r[j]);
        o->m[1][j] = fmaf(-ky, r[6 + j], o->jy * r[3 + j]);
    }
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 3; j++) {
            o->mr[i][j] = fmaf(o->m[i][2], o->rot[2][j], fmaf(o->m[i][1], o->rot[1][j], o->m[i][0] * o->rot[0][j]));
            o->f[i][j] = o->mr[i][j] * scale[j];
        }
    o->p = fmaf(o->f[0][2], o->f[0][2], fmaf(o->f[0][1], o->f[0][1], fmaf(o->f[0][0], o->f[0][0], filter)));
    o->r = fmaf(o->f[1][2], o->f[1][2], fmaf(o->f[1][1], o->f[1][1], fmaf(o->f[1][0], o->f[1][0], filter)));
    o->q = ADCGS_SHEAR * fmaf(o->f[0][2], o->f[1][2], fmaf(o->f[0][1], o->f[1][1], o->f[0][0] * o->f[1][0]));
    /* p r - q^2 with an error of one rounding, even under cancellation. */
    const float qq = o->q * o->q;
    o->det = fmaf(o->p, o->r, -qq) + fmaf(-o->q, o->q, qq);
}

/* Whether the splat is rendered at all; NaN means no. */
static inline int adcgs_project_drawn(const adcgs_projection *o, const adcgs_view *view, float opacity)
{
    return (o->z > view->near_plane) & (opacity >= ADCGS_OPACITY_MIN) & (o->u >= -0x1p20f) & (o->u <= 0x1p20f) &
           (o->v >= -0x1p20f) & (o->v <= 0x1p20f) & (o->p >= 0x1p-20f) & (o->p <= 0x1p40f) & (o->r >= 0x1p-20f) &
           (o->r <= 0x1p40f);
}

#endif

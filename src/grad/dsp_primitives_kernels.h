/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * From the outputs of networks to the primitives of a group of anchors, for one CPU level. The formulas are those of the
 * specification's clause "Primitives".
 */
#ifndef ADCGS_GRAD_DSP_PRIMITIVES_KERNELS_H
#define ADCGS_GRAD_DSP_PRIMITIVES_KERNELS_H

#include "base/fmath.h"
#include "grad/dsp.h"
#include "grad/dsp_vectors.h"

#include <math.h>

/** Rotation matrix of a unit quaternion, row-major, per lane. */
#define ROTATION(r, w, x, y, z)                                                                            \
    const float r##00 = 1 - 2 * (y * y + z * z), r##01 = 2 * (x * y - w * z), r##02 = 2 * (x * z + w * y); \
    const float r##10 = 2 * (x * y + w * z), r##11 = 1 - 2 * (x * x + z * z), r##12 = 2 * (y * z - w * x); \
    const float r##20 = 2 * (x * z - w * y), r##21 = 2 * (y * z + w * x), r##22 = 1 - 2 * (x * x + y * y)

/** Values of an anchor shared by its primitives. */
typedef struct anchor_terms {
    float extent[3][LANES], base[3][LANES];               /* exp(Sigma_v) */
    float move[3][LANES], grow[3][LANES], tint[3][LANES]; /* deltas of F_omega */
    float own[4][LANES];                                  /* rotation by F_omega */
    float q[4][LANES];                                    /* total rotation, with the body's */
    float body[4][LANES], from[3][LANES];         /* rotation of the body; translation before it, minus the body's centre */
    float norm[LANES];                            /* length of (1, r) */
    float pace[LANES], u[LANES], presence[LANES]; /* of lifetimes */
} anchor_terms;

/**
 * Position and presence of an anchor in its lifetime: it moves with its velocity, and its presence has a flat top with steep
 * ends.
 */
static void ISA(span_forward)(anchor_terms *a, const adcgs_group_io *io)
{
    for (int l = 0; l < LANES; l++)
        a->presence[l] = 1;
    if (!io->spans)
        return;
    const float *restrict middle = io->sigma + ADCGS_SPAN_MIDDLE * LANES, *restrict pace = io->sigma + ADCGS_SPAN_PACE * LANES;
    for (int l = 0; l < LANES; l++) {
        a->pace[l] = adcgs_exp(adcgs_clampf(pace[l], -8, 8));
        a->u[l] = adcgs_clampf((io->t - (middle[l] * 0.125f + 0.5f)) * a->pace[l], -4, 4);
        const float square = a->u[l] * a->u[l];
        a->presence[l] = io->moving[l] != 0 ? adcgs_exp(-(square * square)) : 1;
    }
    for (int c = 0; c < 3; c++)
        for (int l = 0; l < LANES; l++)
            a->move[c][l] += io->sigma[(ADCGS_SPAN_VELOCITY + c) * LANES + l] * 0.125f * a->u[l] * io->moving[l];
}

/* Products of quaternions: a b, conj(a) b, or a conj(b). */
/* clang-format off */
#define PRODUCT(c, a, b, i, j)                                                                        \
    const float c##0 = a##0 * b##0 - (i) * (j) * (a##1 * b##1 + a##2 * b##2 + a##3 * b##3);           \
    const float c##1 = (j) * a##0 * b##1 + (i) * a##1 * b##0 + (i) * (j) * (a##2 * b##3 - a##3 * b##2); \
    const float c##2 = (j) * a##0 * b##2 + (i) * a##2 * b##0 + (i) * (j) * (a##3 * b##1 - a##1 * b##3); \
    const float c##3 = (j) * a##0 * b##3 + (i) * a##3 * b##0 + (i) * (j) * (a##1 * b##2 - a##2 * b##1)
/* clang-format on */
#define QUATERNION(name, from) const float name##0 = from[0][l], name##1 = from[1][l], name##2 = from[2][l], name##3 = from[3][l]

/** Moves and rotates anchors with their rigid bodies. */
static void ISA(body_forward)(anchor_terms *a, const adcgs_group_io *io)
{
    float to[3][LANES];
    for (int l = 0; l < LANES; l++) {
        static const adcgs_body_place still = {.q = {1, 0, 0, 0}};
        const adcgs_body_place *p = io->body[l] && io->moving[l] != 0 ? &io->pose[io->body[l] - 1] : &still;
        for (int c = 0; c < 4; c++)
            a->body[c][l] = p->q[c];
        for (int c = 0; c < 3; c++) {
            a->from[c][l] = a->move[c][l] - p->centre[c];
            to[c][l] = p->to[c];
        }
    }
    for (int l = 0; l < LANES; l++) {
        QUATERNION(b, a->body);
        QUATERNION(o, a->own);
        ROTATION(r, b0, b1, b2, b3);
        PRODUCT(q, b, o, 1, 1);
        const float x = a->from[0][l], y = a->from[1][l], z = a->from[2][l];
        a->move[0][l] = r00 * x + r01 * y + r02 * z + to[0][l];
        a->move[1][l] = r10 * x + r11 * y + r12 * z + to[1][l];
        a->move[2][l] = r20 * x + r21 * y + r22 * z + to[2][l];
        a->q[0][l] = q0;
        a->q[1][l] = q1;
        a->q[2][l] = q2;
        a->q[3][l] = q3;
    }
}

static void ISA(anchor_forward)(anchor_terms *a, const adcgs_group_io *io)
{
    for (int c = 0; c < 3; c++)
        for (int l = 0; l < LANES; l++) {
            a->extent[c][l] = adcgs_exp(adcgs_clampf(io->sigma[c * LANES + l], -16, 8));
            a->base[c][l] = adcgs_exp(adcgs_clampf(io->sigma[(3 + c) * LANES + l], -16, 8));
        }
    const float *om = io->omega;
    for (int c = 0; c < 3; c++)
        for (int l = 0; l < LANES; l++) {
            a->move[c][l] = om ? om[c * LANES + l] * io->moving[l] : 0;
            a->grow[c][l] = om ? adcgs_exp(adcgs_clampf(om[(3 + c) * LANES + l] * io->moving[l], -8, 8)) : 1;
            a->tint[c][l] = om ? om[(6 + c) * LANES + l] * io->moving[l] : 0;
        }
    const int turn = om && io->rotation;
    for (int l = 0; l < LANES; l++) {
        const float x = turn ? om[9 * LANES + l] * io->moving[l] : 0;
        const float y = turn ? om[10 * LANES + l] * io->moving[l] : 0;
        const float z = turn ? om[11 * LANES + l] * io->moving[l] : 0;
        const float norm = sqrtf(1 + x * x + y * y + z * z), inverse = 1 / norm;
        a->norm[l] = norm;
        a->own[0][l] = inverse;
        a->own[1][l] = x * inverse;
        a->own[2][l] = y * inverse;
        a->own[3][l] = z * inverse;
    }
    ISA(span_forward)(a, io);
    if (io->body)
        ISA(body_forward)(a, io);
    else
        memcpy(a->q, a->own, sizeof a->q);
}

static void ISA(primitives)(const adcgs_group_io *io)
{
    anchor_terms a;
    ISA(anchor_forward)(&a, io);
    for (int k = 0; k < io->k; k++) {
        const float *restrict th = io->theta + (size_t)k * ADCGS_THETA_OUT * LANES;
        const float *restrict va = io->varpi ? io->varpi + (size_t)k * ADCGS_VARPI_OUT * LANES : NULL;
        const float *restrict keep = io->keep + k * LANES;
        float *restrict m0 = io->mean[0] + k * LANES, *restrict m1 = io->mean[1] + k * LANES,
                        *restrict m2 = io->mean[2] + k * LANES;
        for (int l = 0; l < LANES; l++) {
            const float ox = th[l] * a.extent[0][l], oy = th[LANES + l] * a.extent[1][l], oz = th[2 * LANES + l] * a.extent[2][l];
            const float w = a.q[0][l], x = a.q[1][l], y = a.q[2][l], z = a.q[3][l];
            ROTATION(r, w, x, y, z);
            const float px = io->x[l] + ox, py = io->x[LANES + l] + oy, pz = io->x[2 * LANES + l] + oz;
            m0[l] = a.move[0][l] + (r00 * px + r01 * py + r02 * pz);
            m1[l] = a.move[1][l] + (r10 * px + r11 * py + r12 * pz);
            m2[l] = a.move[2][l] + (r20 * px + r21 * py + r22 * pz);
        }
        for (int c = 0; c < 3; c++) {
            float *restrict scale = io->scale[c] + k * LANES;
            for (int l = 0; l < LANES; l++)
                scale[l] = adcgs_clampf(a.base[c][l] * adcgs_sigmoid(th[(3 + c) * LANES + l]) * a.grow[c][l], 0x1p-20f, 0x1p10f);
        }
        float *restrict qw = io->rot[0] + k * LANES, *restrict qx = io->rot[1] + k * LANES;
        float *restrict qy = io->rot[2] + k * LANES, *restrict qz = io->rot[3] + k * LANES;
        for (int l = 0; l < LANES; l++) {
            const float vw = th[6 * LANES + l] + 1, vx = th[7 * LANES + l], vy = th[8 * LANES + l], vz = th[9 * LANES + l];
            const float inverse = 1 / sqrtf(vw * vw + vx * vx + vy * vy + vz * vz + 1e-12f);
            const float pw = vw * inverse, px = vx * inverse, py = vy * inverse, pz = vz * inverse;
            const float w = a.q[0][l], x = a.q[1][l], y = a.q[2][l], z = a.q[3][l];
            qw[l] = w * pw - x * px - y * py - z * pz;
            qx[l] = w * px + x * pw + y * pz - z * py;
            qy[l] = w * py - x * pz + y * pw + z * px;
            qz[l] = w * pz + x * py - y * px + z * pw;
        }
        for (int c = 0; c < 3; c++) {
            float *restrict rgb = io->rgb[c] + k * LANES;
            for (int l = 0; l < LANES; l++)
                rgb[l] = io->colour[c * LANES + l] + th[(10 + c) * LANES + l] + a.tint[c][l] +
                         (va ? va[(1 + c) * LANES + l] * io->moving[l] : 0);
        }
        float *restrict opacity = io->opacity + k * LANES;
        for (int l = 0; l < LANES; l++) {
            const float logit = th[13 * LANES + l] + (va ? va[l] * io->moving[l] : 0);
            opacity[l] = 0.99f * adcgs_sigmoid(logit) * keep[l] * a.presence[l];
        }
    }
}

#endif

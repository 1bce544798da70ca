/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Gradients of a group's primitives, back to the outputs of networks and the features of anchors, for one CPU level.
 */
#ifndef ADCGS_GRAD_DSP_PRIMITIVES_BACK_KERNELS_H
#define ADCGS_GRAD_DSP_PRIMITIVES_BACK_KERNELS_H

#include "grad/dsp_primitives_kernels.h"

/** Gradients of the anchors, summed over a group's primitives. */
typedef struct anchor_grads {
    float move[3][LANES], grow[3][LANES], tint[3][LANES];
    float m[9][LANES]; /* sum of dL/dmean (x) canonical mean: gradient of the rotation matrix */
    float q[4][LANES]; /* gradient of the anchor's quaternion through the primitives' */
    float presence[LANES];
} anchor_grads;

static void ISA(primitive_mean_back)(const anchor_terms *a, anchor_grads *s, const adcgs_group_io *io, const adcgs_group_grad *g,
                                     int k)
{
    const float *restrict th = io->theta + (size_t)k * ADCGS_THETA_OUT * LANES;
    float *restrict dt = g->theta + (size_t)k * ADCGS_THETA_OUT * LANES;
    const float *restrict g0 = g->mean[0] + k * LANES, *restrict g1 = g->mean[1] + k * LANES,
                          *restrict g2 = g->mean[2] + k * LANES;
    float *restrict ds = g->sigma;
    for (int l = 0; l < LANES; l++) {
        const float ox = th[l] * a->extent[0][l], oy = th[LANES + l] * a->extent[1][l], oz = th[2 * LANES + l] * a->extent[2][l];
        const float w = a->q[0][l], x = a->q[1][l], y = a->q[2][l], z = a->q[3][l];
        ROTATION(r, w, x, y, z);
        s->move[0][l] += g0[l];
        s->move[1][l] += g1[l];
        s->move[2][l] += g2[l];
        const float fx = r00 * g0[l] + r10 * g1[l] + r20 * g2[l];
        const float fy = r01 * g0[l] + r11 * g1[l] + r21 * g2[l];
        const float fz = r02 * g0[l] + r12 * g1[l] + r22 * g2[l];
        dt[l] = fx * a->extent[0][l];
        dt[LANES + l] = fy * a->extent[1][l];
        dt[2 * LANES + l] = fz * a->extent[2][l];
        ds[l] += fx * ox;
        ds[LANES + l] += fy * oy;
        ds[2 * LANES + l] += fz * oz;
        const float px = io->x[l] + ox, py = io->x[LANES + l] + oy, pz = io->x[2 * LANES + l] + oz;
        s->m[0][l] += g0[l] * px;
        s->m[1][l] += g0[l] * py;
        s->m[2][l] += g0[l] * pz;
        s->m[3][l] += g1[l] * px;
        s->m[4][l] += g1[l] * py;
        s->m[5][l] += g1[l] * pz;
        s->m[6][l] += g2[l] * px;
        s->m[7][l] += g2[l] * py;
        s->m[8][l] += g2[l] * pz;
    }
}

static void ISA(primitive_rotation_back)(const anchor_terms *a, anchor_grads *s, const adcgs_group_io *io,
                                         const adcgs_group_grad *g, int k)
{
    const float *restrict th = io->theta + (size_t)k * ADCGS_THETA_OUT * LANES;
    float *restrict dt = g->theta + (size_t)k * ADCGS_THETA_OUT * LANES;
    const float *restrict gw = g->rot[0] + k * LANES, *restrict gx = g->rot[1] + k * LANES;
    const float *restrict gy = g->rot[2] + k * LANES, *restrict gz = g->rot[3] + k * LANES;
    for (int l = 0; l < LANES; l++) {
        const float vw = th[6 * LANES + l] + 1, vx = th[7 * LANES + l], vy = th[8 * LANES + l], vz = th[9 * LANES + l];
        const float inverse = 1 / sqrtf(vw * vw + vx * vx + vy * vy + vz * vz + 1e-12f);
        const float pw = vw * inverse, px = vx * inverse, py = vy * inverse, pz = vz * inverse;
        const float w = a->q[0][l], x = a->q[1][l], y = a->q[2][l], z = a->q[3][l];
        /* conj(anchor) times g: gradient of the primitive's own quaternion */
        const float hw = w * gw[l] + x * gx[l] + y * gy[l] + z * gz[l];
        const float hx = w * gx[l] - x * gw[l] - y * gz[l] + z * gy[l];
        const float hy = w * gy[l] + x * gz[l] - y * gw[l] - z * gx[l];
        const float hz = w * gz[l] - x * gy[l] + y * gx[l] - z * gw[l];
        const float along = pw * hw + px * hx + py * hy + pz * hz;
        dt[6 * LANES + l] = (hw - pw * along) * inverse;
        dt[7 * LANES + l] = (hx - px * along) * inverse;
        dt[8 * LANES + l] = (hy - py * along) * inverse;
        dt[9 * LANES + l] = (hz - pz * along) * inverse;
        /* g times conj(primitive): gradient of the anchor's quaternion */
        s->q[0][l] += gw[l] * pw + gx[l] * px + gy[l] * py + gz[l] * pz;
        s->q[1][l] += -gw[l] * px + gx[l] * pw - gy[l] * pz + gz[l] * py;
        s->q[2][l] += -gw[l] * py + gx[l] * pz + gy[l] * pw - gz[l] * px;
        s->q[3][l] += -gw[l] * pz - gx[l] * py + gy[l] * px + gz[l] * pw;
    }
}

static void ISA(primitive_rest_back)(const anchor_terms *a, anchor_grads *s, const adcgs_group_io *io, const adcgs_group_grad *g,
                                     int k)
{
    const float *restrict th = io->theta + (size_t)k * ADCGS_THETA_OUT * LANES;
    float *restrict dt = g->theta + (size_t)k * ADCGS_THETA_OUT * LANES;
    const float *restrict va = io->varpi ? io->varpi + (size_t)k * ADCGS_VARPI_OUT * LANES : NULL;
    float *restrict dv = io->varpi ? g->varpi + (size_t)k * ADCGS_VARPI_OUT * LANES : NULL;
    for (int c = 0; c < 3; c++) {
        const float *restrict gs = g->scale[c] + k * LANES;
        for (int l = 0; l < LANES; l++) {
            const float sg = adcgs_sigmoid(th[(3 + c) * LANES + l]);
            const float t = gs[l] * a->base[c][l] * sg * a->grow[c][l]; /* dL/d log scale */
            dt[(3 + c) * LANES + l] = t * (1 - sg);
            s->grow[c][l] += t;
            g->sigma[(3 + c) * LANES + l] += t;
        }
        const float *restrict gc = g->rgb[c] + k * LANES;
        for (int l = 0; l < LANES; l++) {
            dt[(10 + c) * LANES + l] = gc[l];
            s->tint[c][l] += gc[l];
            g->colour[c * LANES + l] += gc[l];
            if (dv)
                dv[(1 + c) * LANES + l] = gc[l] * io->moving[l];
        }
    }
    const float *restrict go = g->opacity + k * LANES, *restrict keep = io->keep + k * LANES;
    for (int l = 0; l < LANES; l++) {
        const float sg = adcgs_sigmoid(th[13 * LANES + l] + (va ? va[l] * io->moving[l] : 0));
        const float whole = go[l] * keep[l] * 0.99f * sg, t = whole * (1 - sg) * a->presence[l];
        s->presence[l] += whole;
        dt[13 * LANES + l] = t;
        if (dv)
            dv[l] = t * io->moving[l];
    }
}

/**
 * Converts the gradients of an anchor's total motion to those of the motion before its body, in place, and adds to the sums for
 * the body. With R = B O of the body and F_omega: for B, dR O^T; for O, B^T dR; quaternions likewise.
 */
static void ISA(body_back)(const anchor_terms *a, anchor_grads *s, const adcgs_group_io *io, const adcgs_group_grad *g)
{
    float sums[16][LANES];
    for (int l = 0; l < LANES; l++) {
        QUATERNION(b, a->body);
        QUATERNION(o, a->own);
        QUATERNION(d, s->q);
        ROTATION(r, b0, b1, b2, b3);
        ROTATION(w, o0, o1, o2, o3);
        PRODUCT(e, d, o, 1, -1);
        PRODUCT(f, b, d, -1, 1);
        const float x = s->move[0][l], y = s->move[1][l], z = s->move[2][l];
        const float v[3] = {a->from[0][l], a->from[1][l], a->from[2][l]}, way[3] = {x, y, z};
        for (int i = 0; i < 3; i++) {
            const float m0 = s->m[3 * i][l], m1 = s->m[3 * i + 1][l], m2 = s->m[3 * i + 2][l];
            sums[3 * i][l] = m0 * w00 + m1 * w01 + m2 * w02 + way[i] * v[0];
            sums[3 * i + 1][l] = m0 * w10 + m1 * w11 + m2 * w12 + way[i] * v[1];
            sums[3 * i + 2][l] = m0 * w20 + m1 * w21 + m2 * w22 + way[i] * v[2];
            sums[13 + i][l] = way[i];
        }
        for (int j = 0; j < 3; j++) {
            const float m0 = s->m[j][l], m1 = s->m[3 + j][l], m2 = s->m[6 + j][l];
            s->m[j][l] = r00 * m0 + r10 * m1 + r20 * m2;
            s->m[3 + j][l] = r01 * m0 + r11 * m1 + r21 * m2;
            s->m[6 + j][l] = r02 * m0 + r12 * m1 + r22 * m2;
        }
        sums[9][l] = e0;
        sums[10][l] = e1;
        sums[11][l] = e2;
        sums[12][l] = e3;
        s->q[0][l] = f0;
        s->q[1][l] = f1;
        s->q[2][l] = f2;
        s->q[3][l] = f3;
        s->move[0][l] = r00 * x + r10 * y + r20 * z;
        s->move[1][l] = r01 * x + r11 * y + r21 * z;
        s->move[2][l] = r02 * x + r12 * y + r22 * z;
    }
    for (int l = 0; l < LANES; l++) {
        if (!io->body[l] || io->moving[l] == 0)
            continue;
        adcgs_body_grad *to = &g->body[io->body[l] - 1];
        for (int i = 0; i < 9; i++)
            to->m[i] += sums[i][l];
        for (int i = 0; i < 4; i++)
            to->q[i] += sums[9 + i][l];
        for (int i = 0; i < 3; i++)
            to->way[i] += sums[13 + i][l];
    }
}

static void ISA(omega_back)(const anchor_terms *a, const anchor_grads *s, const adcgs_group_io *io, const adcgs_group_grad *g)
{
    float *restrict d = g->omega;
    for (int c = 0; c < 3; c++)
        for (int l = 0; l < LANES; l++) {
            d[c * LANES + l] = s->move[c][l] * io->moving[l];
            d[(3 + c) * LANES + l] = s->grow[c][l] * io->moving[l];
            d[(6 + c) * LANES + l] = s->tint[c][l] * io->moving[l];
        }
    if (!io->rotation)
        return;
    for (int l = 0; l < LANES; l++) {
        const float w = a->own[0][l], x = a->own[1][l], y = a->own[2][l], z = a->own[3][l];
        const float m00 = s->m[0][l], m01 = s->m[1][l], m02 = s->m[2][l], m10 = s->m[3][l], m11 = s->m[4][l];
        const float m12 = s->m[5][l], m20 = s->m[6][l], m21 = s->m[7][l], m22 = s->m[8][l];
        const float gw = s->q[0][l] + 2 * (z * (m10 - m01) + y * (m02 - m20) + x * (m21 - m12));
        const float gx = s->q[1][l] + 2 * (y * (m01 + m10) + z * (m02 + m20) + w * (m21 - m12) - 2 * x * (m11 + m22));
        const float gy = s->q[2][l] + 2 * (x * (m01 + m10) + z * (m12 + m21) + w * (m02 - m20) - 2 * y * (m00 + m22));
        const float gz = s->q[3][l] + 2 * (x * (m02 + m20) + y * (m12 + m21) + w * (m10 - m01) - 2 * z * (m00 + m11));
        const float along = w * gw + x * gx + y * gy + z * gz, turn = io->moving[l] / a->norm[l];
        d[9 * LANES + l] = (gx - x * along) * turn;
        d[10 * LANES + l] = (gy - y * along) * turn;
        d[11 * LANES + l] = (gz - z * along) * turn;
    }
}

static void ISA(span_back)(const anchor_terms *a, const anchor_grads *s, const adcgs_group_io *io, const adcgs_group_grad *g)
{
    const float *restrict velocity = io->sigma + ADCGS_SPAN_VELOCITY * LANES;
    float *restrict d = g->sigma + ADCGS_SPAN_VELOCITY * LANES;
    for (int l = 0; l < LANES; l++) {
        const float u = a->u[l], inside = u > -4 && u < 4 ? io->moving[l] : 0;
        float du = -4 * u * u * u * a->presence[l] * s->presence[l];
        for (int c = 0; c < 3; c++) {
            du += 0.125f * s->move[c][l] * velocity[c * LANES + l];
            d[c * LANES + l] += 0.125f * s->move[c][l] * u * io->moving[l];
        }
        d[(ADCGS_SPAN_MIDDLE - ADCGS_SPAN_VELOCITY) * LANES + l] -= 0.125f * a->pace[l] * du * inside;
        d[(ADCGS_SPAN_PACE - ADCGS_SPAN_VELOCITY) * LANES + l] += u * du * inside;
    }
}

static void ISA(primitives_back)(const adcgs_group_io *io, const adcgs_group_grad *grad)
{
    anchor_terms a;
    anchor_grads s;
    memset(&s, 0, sizeof s);
    const float *restrict pull = io->omega ? grad->pull : NULL;
    ISA(anchor_forward)(&a, io);
    for (int k = 0; k < io->k; k++) {
        ISA(primitive_mean_back)(&a, &s, io, grad, k);
        ISA(primitive_rotation_back)(&a, &s, io, grad, k);
        ISA(primitive_rest_back)(&a, &s, io, grad, k);
    }
    if (io->body)
        ISA(body_back)(&a, &s, io, grad);
    if (io->spans)
        ISA(span_back)(&a, &s, io, grad);
    for (int i = 0; pull && i < 12 * LANES; i++) /* for F_omega only */
        (i < 3 * LANES ? s.move[i / LANES] : s.m[i / LANES - 3])[i % LANES] += pull[i];
    if (io->omega)
        ISA(omega_back)(&a, &s, io, grad);
}

#endif

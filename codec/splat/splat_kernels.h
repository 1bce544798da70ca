/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Body of the kernels from network outputs to primitives (spec clause
 * "Primitives"). Every loop runs over 64 independent lanes without branches,
 * so that compilers vectorise it for their CPU level.
 */
#include "base/fmath.h"
#include "splat/quaternion.h"
#include "splat/splat_isa.h"

#define LANES for (int l = 0; l < ADCGS_LANES; l++)

static void anchor(adcgs_anchor_lanes *a, const float *sigma, int spans)
{
    for (int c = 0; c < 3; c++)
        LANES {
            a->extent[c][l] = adcgs_exp(adcgs_clampf(sigma[c * ADCGS_LANES + l], -16.0f, 8.0f));
            a->scale[c][l] = adcgs_exp(adcgs_clampf(sigma[(3 + c) * ADCGS_LANES + l], -16.0f, 8.0f));
        }
    if (!spans)
        return;
    for (int c = 0; c < 3; c++)
        LANES
            a->velocity[c][l] = sigma[(ADCGS_SPAN_VELOCITY + c) * ADCGS_LANES + l] * 0.125f;
    LANES {
        a->middle[l] = fmaf(sigma[ADCGS_SPAN_MIDDLE * ADCGS_LANES + l], 0.125f, 0.5f);
        a->pace[l] = adcgs_exp(adcgs_clampf(sigma[ADCGS_SPAN_PACE * ADCGS_LANES + l], -8.0f, 8.0f));
    }
}

static void predict(adcgs_slot_lanes *s, const adcgs_anchor_lanes *a, const float *out)
{
    for (int c = 0; c < 3; c++)
        LANES {
            s->offset[c][l] = out[c * ADCGS_LANES + l] * a->extent[c][l];
            s->scale[c][l] = a->scale[c][l] * adcgs_sigmoid(out[(3 + c) * ADCGS_LANES + l]);
            s->colour[c][l] = a->colour[c][l] + out[(10 + c) * ADCGS_LANES + l];
        }
    LANES {
        const float w = out[6 * ADCGS_LANES + l] + 1.0f, x = out[7 * ADCGS_LANES + l];
        const float y = out[8 * ADCGS_LANES + l], z = out[9 * ADCGS_LANES + l];
        const float n = adcgs_norm2(w, x, y, z), root = sqrtf(n);
        const int ok = adcgs_usable_norm(n);
        s->q[0][l] = ok ? w / root : 1.0f;
        s->q[1][l] = ok ? x / root : 0.0f;
        s->q[2][l] = ok ? y / root : 0.0f;
        s->q[3][l] = ok ? z / root : 0.0f;
        s->logit[l] = out[13 * ADCGS_LANES + l];
    }
}

static inline float final_mean(float x)
{
    return adcgs_clampf(x, -0x1p15f, 0x1p15f);
}

static inline float final_scale(float x)
{
    return adcgs_clampf(x, 0x1p-20f, 0x1p10f);
}

static inline float final_colour(float x)
{
    return adcgs_clampf(x, -0x1p8f, 0x1p8f);
}

static inline float final_opacity(float logit, int32_t present)
{
    const float o = 0.99f * adcgs_sigmoid(logit);
    return present ? o : 0.0f;
}

static void place(const adcgs_slot_out *to, const adcgs_slot_lanes *s, const adcgs_anchor_lanes *a, const int32_t *present)
{
    for (int c = 0; c < 3; c++) {
        float *restrict mean = to->mean[c], *restrict scale = to->scale[c], *restrict colour = to->colour[c];
        LANES {
            mean[l] = final_mean(a->position[c][l] + s->offset[c][l]);
            scale[l] = final_scale(s->scale[c][l]);
            colour[l] = final_colour(s->colour[c][l]);
        }
    }
    for (int c = 0; c < 4; c++)
        memcpy(to->rotation[c], s->q[c], sizeof s->q[c]);
    float *restrict opacity = to->opacity;
    LANES
        opacity[l] = final_opacity(s->logit[l], present[l]);
}

/* The rotation 1 + r0 i + r1 j + r2 k, normalised, and its matrix. */
static void turn(adcgs_anchor_motion *m, const float *r)
{
    LANES {
        const float n = adcgs_norm2(1.0f, r[l], r[ADCGS_LANES + l], r[2 * ADCGS_LANES + l]), root = sqrtf(n);
        const int ok = adcgs_usable_norm(n);
        const float w = ok ? 1.0f / root : 1.0f, x = ok ? r[l] / root : 0.0f, y = ok ? r[ADCGS_LANES + l] / root : 0.0f;
        const float z = ok ? r[2 * ADCGS_LANES + l] / root : 0.0f;
        float matrix[9];
        adcgs_rotation_matrix(matrix, w, x, y, z);
        m->q[0][l] = w;
        m->q[1][l] = x;
        m->q[2][l] = y;
        m->q[3][l] = z;
        m->matrix[0][l] = matrix[0];
        m->matrix[1][l] = matrix[1];
        m->matrix[2][l] = matrix[2];
        m->matrix[3][l] = matrix[3];
        m->matrix[4][l] = matrix[4];
        m->matrix[5][l] = matrix[5];
        m->matrix[6][l] = matrix[6];
        m->matrix[7][l] = matrix[7];
        m->matrix[8][l] = matrix[8];
    }
}

/* Rotate positions or offsets by rotation matrices; in, out: [3][64]. */
static void turn_vector(float *restrict out, const float *restrict in, const float matrix[9][ADCGS_LANES])
{
    const float *x = in, *y = in + ADCGS_LANES, *z = in + 2 * ADCGS_LANES;
    for (int c = 0; c < 3; c++) {
        const float *r0 = matrix[3 * c], *r1 = matrix[3 * c + 1], *r2 = matrix[3 * c + 2];
        LANES
            out[c * ADCGS_LANES + l] = fmaf(r2[l], z[l], fmaf(r1[l], y[l], r0[l] * x[l]));
    }
}

/* Products of quaternions: the rotation q, then the rotation r; not normalised again. out, q: [4][64]. */
static void turn_quaternion(float *restrict out, const float r[4][ADCGS_LANES], const float *restrict q)
{
    LANES {
        const float rw = r[0][l], rx = r[1][l], ry = r[2][l], rz = r[3][l];
        const float w = q[l], x = q[ADCGS_LANES + l], y = q[2 * ADCGS_LANES + l], z = q[3 * ADCGS_LANES + l];
        out[l] = fmaf(-rz, z, fmaf(-ry, y, fmaf(-rx, x, rw * w)));
        out[ADCGS_LANES + l] = fmaf(-rz, y, fmaf(ry, z, fmaf(rx, w, rw * x)));
        out[2 * ADCGS_LANES + l] = fmaf(rz, x, fmaf(ry, w, fmaf(-rx, z, rw * y)));
        out[3 * ADCGS_LANES + l] = fmaf(rz, w, fmaf(-ry, x, fmaf(rx, y, rw * z)));
    }
}

/* Restore the previous values of rows where an anchor has no body. */
static void keep_bodiless(float *restrict changed, const float *restrict before, const int32_t *restrict has, int rows)
{
    for (int c = 0; c < rows * ADCGS_LANES; c += ADCGS_LANES)
        LANES
            changed[c + l] = has[l] ? changed[c + l] : before[c + l];
}

/* An anchor's motion since the middle of its lifetime, and the weight of its lifetime. */
static void live(adcgs_anchor_motion *m, const adcgs_anchor_lanes *a, float t)
{
    float u[ADCGS_LANES];
    LANES {
        u[l] = adcgs_clampf((t - a->middle[l]) * a->pace[l], -4.0f, 4.0f);
        const float square = u[l] * u[l];
        m->presence[l] = adcgs_exp(-(square * square));
    }
    for (int c = 0; c < 3; c++)
        LANES
            m->position[c][l] = fmaf(a->velocity[c][l], u[l], m->position[c][l]);
}

/* Anchors move with their bodies. */
static void carry(adcgs_anchor_motion *m, const adcgs_body_lanes *b)
{
    float from[3][ADCGS_LANES], to[3][ADCGS_LANES];
    for (int c = 0; c < 3; c++)
        LANES
            from[c][l] = m->position[c][l] - b->centre[c][l];
    turn_vector(to[0], from[0], b->matrix);
    for (int c = 0; c < 3; c++)
        LANES
            to[c][l] += b->place[c][l];
    keep_bodiless(to[0], m->position[0], b->has, 3);
    memcpy(m->position, to, sizeof to);
}

static void motion(adcgs_anchor_motion *m, const adcgs_anchor_lanes *a, const float *out, const adcgs_movers *movers,
                   const adcgs_body_lanes *bodies, float t)
{
    memcpy(m->position, a->position, sizeof m->position);
    for (int c = 0; movers->coarse && c < 3; c++)
        LANES {
            m->scale[c][l] = adcgs_exp(adcgs_clampf(out[(3 + c) * ADCGS_LANES + l], -8.0f, 8.0f));
            m->colour[c][l] = out[(6 + c) * ADCGS_LANES + l];
        }
    if (movers->rotation) {
        turn(m, out + 9 * ADCGS_LANES);
        turn_vector(m->position[0], a->position[0], (const float(*)[ADCGS_LANES])m->matrix);
    }
    for (int c = 0; movers->coarse && c < 3; c++)
        LANES
            m->position[c][l] += out[c * ADCGS_LANES + l];
    if (movers->spans)
        live(m, a, t);
    if (bodies)
        carry(m, bodies);
}

/* Orientations after the anchor's rotation and its body's. */
static void deform_rotation(const adcgs_slot_out *to, const adcgs_slot_lanes *s, const adcgs_anchor_motion *m, int rotation,
                            const adcgs_body_lanes *bodies, const int32_t *moves)
{
    float turned[4][ADCGS_LANES], carried[4][ADCGS_LANES];
    const float *q = s->q[0];
    if (rotation) {
        turn_quaternion(turned[0], m->q, q);
        q = turned[0];
    }
    if (bodies) {
        turn_quaternion(carried[0], bodies->q, q);
        keep_bodiless(carried[0], q, bodies->has, 4);
        q = carried[0];
    }
    for (int c = 0; c < 4; c++) {
        float *restrict out = to->rotation[c];
        LANES
            out[l] = moves[l] ? q[c * ADCGS_LANES + l] : out[l];
    }
}

/* Offsets after the same rotations, [3][64]: the canonical offsets, or one of the two buffers. */
static const float *deform_offset(float *turned, float *carried, const adcgs_slot_lanes *s, const adcgs_anchor_motion *m,
                                  int rotation, const adcgs_body_lanes *bodies)
{
    const float *offset = s->offset[0];
    if (rotation) {
        turn_vector(turned, offset, m->matrix);
        offset = turned;
    }
    if (bodies) {
        turn_vector(carried, offset, bodies->matrix);
        keep_bodiless(carried, offset, bodies->has, 3);
        offset = carried;
    }
    return offset;
}

static void deform_shape(const adcgs_slot_out *to, const adcgs_slot_lanes *s, const adcgs_anchor_motion *m,
                         const adcgs_movers *movers, const adcgs_body_lanes *bodies, const int32_t *moves)
{
    float turned[3 * ADCGS_LANES], carried[3 * ADCGS_LANES];
    const float *offsets = deform_offset(turned, carried, s, m, movers->rotation, bodies);
    if (movers->rotation || bodies)
        deform_rotation(to, s, m, movers->rotation, bodies, moves);
    for (int c = 0; c < 3; c++) {
        const float *offset = offsets + (size_t)c * ADCGS_LANES;
        float *restrict mean = to->mean[c], *restrict scale = to->scale[c];
        LANES {
            const float x = final_mean(m->position[c][l] + offset[l]);
            mean[l] = moves[l] ? x : mean[l];
        }
        for (int l = 0; movers->coarse && l < ADCGS_LANES; l++) {
            const float size = final_scale(s->scale[c][l] * m->scale[c][l]);
            scale[l] = moves[l] ? size : scale[l];
        }
    }
}

static void deform(const adcgs_slot_out *to, const adcgs_slot_lanes *s, const adcgs_anchor_motion *m, const adcgs_movers *movers,
                   const adcgs_body_lanes *bodies, const float *fine, const int32_t *present, const int32_t *moves)
{
    if (movers->coarse || movers->spans || bodies)
        deform_shape(to, s, m, movers, bodies, moves);
    for (int c = 0; c < 3; c++) {
        float *restrict colour = to->colour[c];
        LANES {
            float value = s->colour[c][l];
            value = movers->coarse ? value + m->colour[c][l] : value;
            value = final_colour(fine ? value + fine[(1 + c) * ADCGS_LANES + l] : value);
            colour[l] = moves[l] ? value : colour[l];
        }
    }
    if (!fine && !movers->spans)
        return;
    float *restrict opacity = to->opacity;
    LANES {
        float o = final_opacity(fine ? s->logit[l] + fine[l] : s->logit[l], present[l]);
        o = movers->spans ? o * m->presence[l] : o;
        opacity[l] = moves[l] ? o : opacity[l];
    }
}

static void position_code(float *out, const float *x, int octaves)
{
    for (int a = 0; a < 3; a++)
        for (int o = 0; o < octaves; o++) {
            const float factor = (float)(1 << o);
            float *restrict sine = out + ((size_t)a * (size_t)octaves + (size_t)o) * (2 * ADCGS_LANES);
            float *restrict cosine = sine + ADCGS_LANES;
            LANES
                adcgs_sincospi(x[a * ADCGS_LANES + l] * factor, &sine[l], &cosine[l]);
        }
}

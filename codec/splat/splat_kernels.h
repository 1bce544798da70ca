/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Body of the kernels from network outputs to primitives (spec clause
 * "Primitives"). Every loop is over 64 independent lanes and without branches,
 * so that compilers vectorise it for the CPU level it is compiled for.
 */
#include "base/fmath.h"
#include "splat/splat_isa.h"

#define LANES for (int l = 0; l < ADCGS_LANES; l++)

/* A quaternion whose squared norm is outside cannot be normalised; it becomes the identity. */
static inline int usable_norm(float n)
{
    return n >= 0x1p-40f && n <= 0x1p100f;
}

static inline float norm2(float w, float x, float y, float z)
{
    return fmaf(z, z, fmaf(y, y, fmaf(x, x, w * w)));
}

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
        LANES a->velocity[c][l] = sigma[(ADCGS_SPAN_VELOCITY + c) * ADCGS_LANES + l] * 0.125f;
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
        const float n = norm2(w, x, y, z), root = sqrtf(n);
        const int ok = usable_norm(n);
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
    LANES opacity[l] = final_opacity(s->logit[l], present[l]);
}

/* The rotation 1 + r0 i + r1 j + r2 k, normalised, and its matrix. */
static void turn(adcgs_anchor_motion *m, const float *r)
{
    LANES {
        const float n = norm2(1.0f, r[l], r[ADCGS_LANES + l], r[2 * ADCGS_LANES + l]), root = sqrtf(n);
        const int ok = usable_norm(n);
        const float w = ok ? 1.0f / root : 1.0f, x = ok ? r[l] / root : 0.0f, y = ok ? r[ADCGS_LANES + l] / root : 0.0f;
        const float z = ok ? r[2 * ADCGS_LANES + l] / root : 0.0f, x2 = x + x, y2 = y + y, z2 = z + z;
        m->q[0][l] = w;
        m->q[1][l] = x;
        m->q[2][l] = y;
        m->q[3][l] = z;
        m->matrix[0][l] = fmaf(-y2, y, fmaf(-z2, z, 1.0f));
        m->matrix[1][l] = fmaf(x2, y, -(w * z2));
        m->matrix[2][l] = fmaf(x2, z, w * y2);
        m->matrix[3][l] = fmaf(x2, y, w * z2);
        m->matrix[4][l] = fmaf(-x2, x, fmaf(-z2, z, 1.0f));
        m->matrix[5][l] = fmaf(y2, z, -(w * x2));
        m->matrix[6][l] = fmaf(x2, z, -(w * y2));
        m->matrix[7][l] = fmaf(y2, z, w * x2);
        m->matrix[8][l] = fmaf(-x2, x, fmaf(-y2, y, 1.0f));
    }
}

/* A position or an offset turned by the anchor's rotation. */
static void turn_vector(float out[3][ADCGS_LANES], const float in[3][ADCGS_LANES], const adcgs_anchor_motion *m)
{
    for (int c = 0; c < 3; c++) {
        const float *r0 = m->matrix[3 * c], *r1 = m->matrix[3 * c + 1], *r2 = m->matrix[3 * c + 2];
        LANES out[c][l] = fmaf(r2[l], in[2][l], fmaf(r1[l], in[1][l], r0[l] * in[0][l]));
    }
}

/* An anchor's way since the middle of its life, and how much of it is there. */
static void live(adcgs_anchor_motion *m, const adcgs_anchor_lanes *a, float t)
{
    float u[ADCGS_LANES];
    LANES {
        u[l] = adcgs_clampf((t - a->middle[l]) * a->pace[l], -4.0f, 4.0f);
        const float square = u[l] * u[l];
        m->presence[l] = adcgs_exp(-(square * square));
    }
    for (int c = 0; c < 3; c++)
        LANES m->position[c][l] = fmaf(a->velocity[c][l], u[l], m->position[c][l]);
}

static void motion(adcgs_anchor_motion *m, const adcgs_anchor_lanes *a, const float *out, const adcgs_movers *movers, float t)
{
    memcpy(m->position, a->position, sizeof m->position);
    for (int c = 0; movers->coarse && c < 3; c++)
        LANES {
            m->scale[c][l] = adcgs_exp(adcgs_clampf(out[(3 + c) * ADCGS_LANES + l], -8.0f, 8.0f));
            m->colour[c][l] = out[(6 + c) * ADCGS_LANES + l];
        }
    if (movers->rotation) {
        turn(m, out + 9 * ADCGS_LANES);
        turn_vector(m->position, a->position, m);
    }
    for (int c = 0; movers->coarse && c < 3; c++)
        LANES m->position[c][l] += out[c * ADCGS_LANES + l];
    if (movers->spans)
        live(m, a, t);
}

/* Product of the anchor's rotation and the primitive's; not normalised again. */
static void turn_quaternion(const adcgs_slot_out *to, const adcgs_slot_lanes *s, const adcgs_anchor_motion *m,
                            const int32_t *moves)
{
    float *restrict ow = to->rotation[0], *restrict ox = to->rotation[1];
    float *restrict oy = to->rotation[2], *restrict oz = to->rotation[3];
    LANES {
        const float rw = m->q[0][l], rx = m->q[1][l], ry = m->q[2][l], rz = m->q[3][l];
        const float w = s->q[0][l], x = s->q[1][l], y = s->q[2][l], z = s->q[3][l];
        const float pw = fmaf(-rz, z, fmaf(-ry, y, fmaf(-rx, x, rw * w)));
        const float px = fmaf(-rz, y, fmaf(ry, z, fmaf(rx, w, rw * x)));
        const float py = fmaf(rz, x, fmaf(ry, w, fmaf(-rx, z, rw * y)));
        const float pz = fmaf(rz, w, fmaf(-ry, x, fmaf(rx, y, rw * z)));
        ow[l] = moves[l] ? pw : ow[l];
        ox[l] = moves[l] ? px : ox[l];
        oy[l] = moves[l] ? py : oy[l];
        oz[l] = moves[l] ? pz : oz[l];
    }
}

static void deform_shape(const adcgs_slot_out *to, const adcgs_slot_lanes *s, const adcgs_anchor_motion *m,
                         const adcgs_movers *movers, const int32_t *moves)
{
    float turned[3][ADCGS_LANES];
    if (movers->rotation) {
        turn_vector(turned, s->offset, m);
        turn_quaternion(to, s, m, moves);
    }
    for (int c = 0; c < 3; c++) {
        const float *offset = movers->rotation ? turned[c] : s->offset[c];
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
                   const float *fine, const int32_t *present, const int32_t *moves)
{
    if (movers->coarse || movers->spans)
        deform_shape(to, s, m, movers, moves);
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
            LANES adcgs_sincospi(x[a * ADCGS_LANES + l] * factor, &sine[l], &cosine[l]);
        }
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Primitives against an evaluation one by one that follows the specification's text, bit for bit, on every CPU level and for
 * several numbers of threads. The elementary functions against the C library's.
 */
#include "base/cpu_detect.h"
#include "base/fmath.h"
#include "model/model_priv.h"
#include "random_model.h"
#include "splat/floatnet.h"
#include "splat/splat.h"
#include "splat/steps.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <cmocka.h>

/* ---- The reference ---- */

static const double PI = 3.14159265358979323846;

typedef struct primitive {
    float v[14]; /* mean, scale, rotation, opacity, colour */
} primitive;

static float weight(const adcgs_layer *l, uint32_t row, uint32_t column)
{
    return adcgs_tensor_value(&l->w, (size_t)row * l->w.cols + column);
}

static float bent(float x)
{
    return x < 0.0f ? x * 0x1p-6f : x;
}

/* Layers after the first; h holds the first one's sums and becomes the outputs. */
static void later_layers(const adcgs_net *net, float *h)
{
    float next[ADCGS_NET_WIDTH_MAX];
    for (int i = 1; i < net->n_layers; i++) {
        const adcgs_layer *l = &net->layer[i];
        if (i == 1)
            for (uint32_t j = 0; j < l->w.cols; j++)
                h[j] = bent(h[j]);
        for (uint32_t o = 0; o < l->w.rows; o++) {
            float sum = adcgs_tensor_value(&l->b, o);
            for (uint32_t j = 0; j < l->w.cols; j++)
                sum = fmaf(weight(l, o, j), h[j], sum);
            next[o] = i + 1 == net->n_layers ? sum : l->residual ? h[o] + bent(sum) : bent(sum);
        }
        memcpy(h, next, l->w.rows * sizeof *h);
    }
}

static void normalise(float q[4])
{
    float n = q[0] * q[0];
    for (int i = 1; i < 4; i++)
        n = fmaf(q[i], q[i], n);
    const int ok = n >= 0x1p-40f && n <= 0x1p100f;
    for (int i = 0; i < 4; i++)
        q[i] = ok ? q[i] / sqrtf(n) : i == 0 ? 1.0f : 0.0f;
}

/* E_q of an anchor directly from its numbers; of: index of a group of channels, 0 Sigma_v, 1 C_v, 2 + c chunk c of f_g. */
static int step_index(const adcgs_model *m, uint32_t anchor, uint32_t of)
{
    const adcgs_net *net = &m->net[ADCGS_ROLE_ENTROPY_STEPS];
    int32_t h[ADCGS_NET_WIDTH_MAX], acc[ADCGS_NET_WIDTH_MAX];
    for (uint32_t i = 0; i < m->params.n_fv; i++)
        h[i] = adcgs_clip(adcgs_shr(m->fv[(size_t)anchor * m->params.n_fv + i], net->in_shift), 2047);
    for (int l = 0; l < net->n_layers; l++) {
        const adcgs_layer *layer = &net->layer[l];
        for (uint32_t o = 0; o < layer->w.rows; o++) {
            acc[o] = layer->b.m[o];
            for (uint32_t i = 0; i < layer->w.cols; i++)
                acc[o] += layer->w.m[(size_t)o * layer->w.cols + i] * h[i];
            acc[o] = adcgs_shr(acc[o], layer->shift);
        }
        for (uint32_t o = 0; l + 1 < net->n_layers && o < layer->w.rows; o++) {
            const int32_t v = acc[o] < 0 ? adcgs_shr(acc[o], 6) : acc[o];
            h[o] = adcgs_clip(layer->residual ? h[o] + v : v, 2047);
        }
    }
    return adcgs_clip(acc[of], 16);
}

/* The value of a latent. Its step adapts to the anchor if the model has E_q. */
static float valued(const adcgs_model *m, uint32_t anchor, uint32_t of, int16_t yq, float d)
{
    const float factor = m->params.adaptive_steps ? adcgs_step_factor(step_index(m, anchor, of)) : 1.0f;
    const float step = d * factor;
    return (float)yq * step;
}

static void evaluate_prediction(const adcgs_model *m, uint32_t anchor, int k, float *out)
{
    const adcgs_net *net = &m->net[ADCGS_ROLE_PREDICTION];
    const adcgs_params *p = &m->params;
    const uint32_t slots = p->k > 1 ? p->k : 0;
    for (uint32_t o = 0; o < net->layer[0].w.rows; o++) {
        float sum = adcgs_tensor_value(&net->layer[0].b, o);
        for (uint32_t i = 0; i < p->n_fv; i++)
            sum = fmaf(weight(&net->layer[0], o, i), (float)m->fv[(size_t)anchor * p->n_fv + i] * m->d_fv[i], sum);
        if (slots)
            sum += weight(&net->layer[0], o, p->n_fv + (uint32_t)k);
        for (uint32_t i = 0; i < p->n_fg; i++)
            sum = fmaf(weight(&net->layer[0], o, p->n_fv + slots + i),
                       valued(m, anchor, 2 + i / (p->n_fg / p->chunks), m->fg[((size_t)anchor * p->k + (size_t)k) * p->n_fg + i],
                              m->d_fg[i]),
                       sum);
        out[o] = sum;
    }
    later_layers(net, out);
}

static void evaluate_time(const adcgs_model *m, float t, float *out)
{
    const adcgs_tensor *z = &m->net[ADCGS_ROLE_TIME].layer[0].w;
    const float u = t * (float)(z->rows - 1);
    uint32_t i = 0;
    while (i + 2 < z->rows && (float)(i + 1) <= u)
        i++;
    const float r = u - (float)i, s = 1 - r;
    for (uint32_t j = 0; j < z->cols; j++) {
        float row[4]; /* four rows, from the one before t's interval */
        for (uint32_t k = 0; k < 4; k++)
            row[k] = i + k > 0 && i + k <= z->rows ? adcgs_tensor_value(z, (size_t)(i + k - 1) * z->cols + j) : 0;
        if (z->rows == 1 || !m->params.smooth_time) {
            out[j] = z->rows == 1 ? row[1] : fmaf(r, row[2] - row[1], row[1]);
            continue;
        }
        if (i == 0)
            row[0] = 2 * row[1] - row[2];
        if (i + 2 == z->rows)
            row[3] = 2 * row[2] - row[1];
        float sum = s * s * s * (float)(1.0 / 6) * row[0];
        sum = fmaf(fmaf(r * r, 0.5f * r - 1, (float)(2.0 / 3)), row[1], sum);
        sum = fmaf(fmaf(s * s, 0.5f * s - 1, (float)(2.0 / 3)), row[2], sum);
        out[j] = fmaf(r * r * r * (float)(1.0 / 6), row[3], sum);
    }
}

static void evaluate_deformation(const adcgs_model *m, int role, uint32_t anchor, const float *time, float *out)
{
    const adcgs_net *net = &m->net[role];
    const adcgs_params *p = &m->params;
    float x[6 * ADCGS_OCTAVES_MAX + ADCGS_NV_MAX];
    uint32_t n = 0;
    if (role == ADCGS_ROLE_FINE)
        for (uint32_t a = 0; a < 3; a++)
            for (int o = 0; o < p->octaves; o++, n += 2)
                adcgs_sincospi(ldexpf((float)(2 * m->pos[3 * (size_t)anchor + a] + 1), o - m->depth - 1), &x[n], &x[n + 1]);
    if (role == ADCGS_ROLE_COARSE || p->fine_uses_fv)
        for (uint32_t i = 0; i < p->n_fv; i++)
            x[n++] = (float)m->fv[(size_t)anchor * p->n_fv + i] * m->d_fv[i];
    for (uint32_t o = 0; o < net->layer[0].w.rows; o++) {
        float still = 0.0f, moving = adcgs_tensor_value(&net->layer[0].b, o);
        for (uint32_t i = 0; i < n; i++)
            still = fmaf(weight(&net->layer[0], o, i), x[i], still);
        for (uint32_t i = 0; i < p->time_width; i++)
            moving = fmaf(weight(&net->layer[0], o, n + i), time[i], moving);
        out[o] = still + moving;
    }
    later_layers(net, out);
}

static void turn(const float r[4], float position[3], float offset[3], float q[4])
{
    const float w = r[0], x = r[1], y = r[2], z = r[3], x2 = x + x, y2 = y + y, z2 = z + z;
    const float m[9] = {fmaf(-y2, y, fmaf(-z2, z, 1.0f)), fmaf(x2, y, -(w * z2)), fmaf(x2, z, w * y2),    fmaf(x2, y, w * z2),
                        fmaf(-x2, x, fmaf(-z2, z, 1.0f)), fmaf(y2, z, -(w * x2)), fmaf(x2, z, -(w * y2)), fmaf(y2, z, w * x2),
                        fmaf(-x2, x, fmaf(-y2, y, 1.0f))};
    const float p[3] = {position[0], position[1], position[2]}, o[3] = {offset[0], offset[1], offset[2]};
    const float s[4] = {q[0], q[1], q[2], q[3]};
    for (int a = 0; a < 3; a++) {
        position[a] = fmaf(m[3 * a + 2], p[2], fmaf(m[3 * a + 1], p[1], m[3 * a] * p[0]));
        offset[a] = fmaf(m[3 * a + 2], o[2], fmaf(m[3 * a + 1], o[1], m[3 * a] * o[0]));
    }
    q[0] = fmaf(-z, s[3], fmaf(-y, s[2], fmaf(-x, s[1], w * s[0])));
    q[1] = fmaf(-z, s[2], fmaf(y, s[3], fmaf(x, s[0], w * s[1])));
    q[2] = fmaf(z, s[1], fmaf(y, s[0], fmaf(-x, s[3], w * s[2])));
    q[3] = fmaf(z, s[0], fmaf(-y, s[1], fmaf(x, s[2], w * s[3])));
}

/* The motion of an anchor from the middle of its lifetime; returns its presence. */
static float live(const adcgs_model *m, uint32_t anchor, float t, float position[3])
{
    float s[5];
    for (size_t c = 0; c < 5; c++)
        s[c] = valued(m, anchor, 0, m->sigma[11 * (size_t)anchor + 6 + c], m->d_sigma[6 + c]);
    const float since = t - fmaf(s[3], 0.125f, 0.5f), pace = adcgs_exp(adcgs_clampf(s[4], -8.0f, 8.0f));
    const float u = adcgs_clampf(since * pace, -4.0f, 4.0f), u2 = u * u, u4 = u2 * u2;
    for (int a = 0; a < 3; a++)
        position[a] = fmaf(s[a] * 0.125f, u, position[a]);
    return adcgs_exp(-u4);
}

/* The motion of an anchor's body: about the centre of the box of all its voxels in its first tier, then the translation. */
static void take_along(const adcgs_model *m, uint32_t anchor, const float *time, float position[3], float offset[3], float q[4])
{
    const float *z = time + m->params.time_width + 7 * (m->body[anchor] - 1);
    float r[4] = {fmaf(z[0], 0.0625f, 1.0f), z[1] * 0.0625f, z[2] * 0.0625f, z[3] * 0.0625f}, centre[3];
    int tier = ADCGS_TIERS_MAX;
    normalise(r);
    for (uint32_t i = 0; i < m->n; i++)
        tier = m->body[i] == m->body[anchor] ? ADCGS_MIN(tier, m->tier[i]) : tier;
    for (size_t a = 0; a < 3; a++) {
        uint32_t low = UINT32_MAX, high = 0;
        for (uint32_t i = 0; i < m->n; i++)
            if (m->body[i] == m->body[anchor] && m->tier[i] == tier) {
                low = ADCGS_MIN(low, m->pos[3 * (size_t)i + a]);
                high = ADCGS_MAX(high, m->pos[3 * (size_t)i + a]);
            }
        centre[a] = fmaf((float)(low + high + 1), 0.5f * m->voxel, m->origin[a]);
        position[a] -= centre[a];
    }
    turn(r, position, offset, q);
    for (int a = 0; a < 3; a++)
        position[a] += centre[a] + z[4 + a] * 0.0625f;
}

static primitive evaluate(const adcgs_model *m, uint32_t anchor, int k, float t)
{
    float out[ADCGS_NET_WIDTH_MAX], coarse[ADCGS_NET_WIDTH_MAX], fine[ADCGS_NET_WIDTH_MAX];
    float time[ADCGS_TIME_WIDTH_MAX + ADCGS_BODIES_MAX * ADCGS_POSE_N];
    float position[3], offset[3], q[4];
    primitive r;
    const int moves = m->params.time_rows > 0 && !m->is_static[anchor];
    const int has_coarse = moves && m->net[ADCGS_ROLE_COARSE].present, has_fine = moves && m->net[ADCGS_ROLE_FINE].present;
    const size_t first = (m->params.spans ? 11 : 6) * (size_t)anchor;
    evaluate_prediction(m, anchor, k, out);
    if (moves)
        evaluate_time(m, t, time);
    if (has_coarse)
        evaluate_deformation(m, ADCGS_ROLE_COARSE, anchor, time, coarse);
    if (has_fine)
        evaluate_deformation(m, ADCGS_ROLE_FINE, anchor, time, fine);
    float logit = out[13];
    for (int a = 0; a < 3; a++) {
        const float extent = valued(m, anchor, 0, m->sigma[first + (size_t)a], m->d_sigma[a]);
        const float size = valued(m, anchor, 0, m->sigma[first + 3 + (size_t)a], m->d_sigma[3 + a]);
        position[a] = fmaf((float)(2 * m->pos[3 * (size_t)anchor + (size_t)a] + 1), 0.5f * m->voxel, m->origin[a]);
        offset[a] = out[a] * adcgs_exp(adcgs_clampf(extent, -16.0f, 8.0f));
        r.v[3 + a] = adcgs_exp(adcgs_clampf(size, -16.0f, 8.0f)) * adcgs_sigmoid(out[3 + a]);
        r.v[11 + a] = valued(m, anchor, 1, m->colour[3 * (size_t)anchor + (size_t)a], m->d_colour[a]) + out[10 + a];
    }
    for (int a = 0; a < 4; a++)
        q[a] = out[6 + a] + (a == 0 ? 1.0f : 0.0f);
    normalise(q);
    if (has_coarse) {
        float turned[4] = {1.0f, coarse[9], coarse[10], coarse[11]};
        normalise(turned);
        if (m->params.coarse_rotation)
            turn(turned, position, offset, q);
        for (int a = 0; a < 3; a++) {
            position[a] += coarse[a];
            r.v[3 + a] *= adcgs_exp(adcgs_clampf(coarse[3 + a], -8.0f, 8.0f));
            r.v[11 + a] += coarse[6 + a];
        }
    }
    const float presence = moves && m->params.spans ? live(m, anchor, t, position) : 1.0f;
    if (m->body[anchor])
        take_along(m, anchor, time, position, offset, q);
    if (has_fine) {
        logit += fine[4 * k];
        for (int a = 0; a < 3; a++)
            r.v[11 + a] += fine[4 * k + 1 + a];
    }
    for (int a = 0; a < 3; a++) {
        r.v[a] = adcgs_clampf(position[a] + offset[a], -0x1p15f, 0x1p15f);
        r.v[3 + a] = adcgs_clampf(r.v[3 + a], 0x1p-20f, 0x1p10f);
        r.v[11 + a] = adcgs_clampf(r.v[11 + a], -0x1p8f, 0x1p8f);
    }
    memcpy(r.v + 6, q, sizeof q);
    r.v[10] = 0.99f * adcgs_sigmoid(logit) * presence;
    return r;
}

/* ---- The tests ---- */

static void check_primitives(const adcgs_model *m, const adcgs_primitives *p, float t)
{
    const float *const arrays[] = {p->mean[0],  p->mean[1],     p->mean[2],     p->scale[0],    p->scale[1],
                                   p->scale[2], p->rotation[0], p->rotation[1], p->rotation[2], p->rotation[3],
                                   p->opacity,  p->colour[0],   p->colour[1],   p->colour[2]};
    const uint32_t k = m->params.k;
    assert_int_equal(p->n, (m->n + 63) / 64 * 64 * k);
    for (uint32_t slot = 0; slot < p->n; slot++) {
        const uint32_t anchor = slot / (64 * k) * 64 + slot % 64, j = slot / 64 % k;
        for (int a = 0; a < 14; a++)
            assert_true(fabsf(arrays[a][slot]) <= 0x1p15f);
        if (anchor >= m->n || !(m->mask[anchor] >> j & 1)) {
            assert_true(p->opacity[slot] == 0.0f);
            continue;
        }
        const primitive expected = evaluate(m, anchor, (int)j, t);
        for (int a = 0; a < 14; a++)
            if (adcgs_float_bits(arrays[a][slot]) != adcgs_float_bits(expected.v[a]))
                fail_msg("anchor %u, primitive %u, array %d: %a, expected %a", anchor, j, a, (double)arrays[a][slot],
                         (double)expected.v[a]);
    }
}

static void check_model(const adcgs_model *m, int threads, adcgs_cpu_level cpu)
{
    static const float times[] = {0.0f, 0.37f, 0.37f, 1.0f, 0.999999f, -3.0f, 2.0f};
    adcgs_pool *pool;
    adcgs_splat *splat;
    adcgs_primitives p;
    uint8_t digest[2][16];
    assert_int_equal(adcgs_pool_create(&pool, threads, NULL), ADCGS_OK);
    assert_int_equal(adcgs_splat_create(&splat, m, cpu, pool, NULL, NULL), ADCGS_OK);
    for (size_t i = 0; i < ADCGS_COUNTOF(times); i++) {
        assert_int_equal(adcgs_splat_at(splat, times[i], &p, NULL), ADCGS_OK);
        check_primitives(m, &p, adcgs_clampf(times[i], 0.0f, 1.0f));
        adcgs_splat_digest(m, &p, digest[i & 1]);
    }
    assert_int_equal(adcgs_splat_at(splat, NAN, &p, NULL), ADCGS_OK);
    check_primitives(m, &p, 0.0f);
    adcgs_splat_free(&splat);
    adcgs_pool_free(&pool);
}

/* Makes the first anchors static, and thus without lifetimes and bodies. */
static void stand_still(adcgs_model *m, uint32_t anchors)
{
    const size_t rows = (size_t)adcgs_sigma_rows(&m->params);
    memset(m->is_static, m->params.time_rows > 0, anchors);
    memset(m->body, 0, anchors);
    for (uint32_t i = 0; m->params.spans && i < anchors; i++)
        memset(m->sigma + i * rows + 6, 0, 5 * sizeof *m->sigma);
    assert_int_equal(adcgs_model_validate(m, NULL), ADCGS_OK);
}

static void clear_model(adcgs_model *m)
{
    adcgs_model_clear(m, NULL);
}

/* REQ-PRIM-005, REQ-PRIM-006, REQ-PRIM-008, REQ-PRIM-009, REQ-PRIM-010, REQ-PRIM-011, REQ-PRIM-012, REQ-PRIM-013,
   REQ-PRIM-014, REQ-PRIM-015, REQ-PRIM-016, REQ-PRIM-017, REQ-PRIM-018, REQ-PRIM-022 */
static void test_against_reference(void **state)
{
    uint64_t random = 5;
    for (int i = 0; i < 24; i++) {
        adcgs_params params;
        adcgs_model m;
        adcgs_error error = {0};
        adcgs_random_params(&params, i % 4 != 0, &random);
        if (adcgs_random_model(&m, &params, (uint32_t)adcgs_random_range(&random, 1, 200), 5, &random, &error) != ADCGS_OK)
            fail_msg("%s", error.text);
        if (i % 3 == 0) /* whole groups of static anchors */
            stand_still(&m, ADCGS_MIN(m.n, 128));
        for (adcgs_cpu_level cpu = ADCGS_CPU_SCALAR; cpu <= adcgs_cpu_best(); cpu++)
            check_model(&m, cpu == ADCGS_CPU_SCALAR ? 1 : 3, cpu);
        clear_model(&m);
    }
}

/* The largest weights and values of a valid model: no result may be infinite or NaN. */
/* REQ-PRIM-007, REQ-PRIM-017 */
static void test_extremes(void **state)
{
    uint64_t random = 6;
    for (int i = 0; i < 8; i++) {
        adcgs_params params;
        adcgs_model m;
        adcgs_random_params(&params, 1, &random);
        assert_int_equal(adcgs_random_model(&m, &params, 70, 4, &random, NULL), ADCGS_OK);
        for (int role = ADCGS_ROLE_PREDICTION; role < ADCGS_ROLES; role++)
            for (int l = 0; m.net[role].present && l < m.net[role].n_layers; l++) {
                adcgs_tensor *w = &m.net[role].layer[l].w;
                for (size_t j = 0; j < (size_t)w->rows * w->cols; j++)
                    w->m[j] = (int32_t)adcgs_float_bits(i & 1 && j & 1 ? -0x1.fffffep7f : 0x1.fffffep7f);
                w->mode = 1;
            }
        for (size_t j = 0; j < (size_t)m.n * params.n_fv; j++)
            m.fv[j] = i & 2 ? 32767 : -32767;
        const int rows = adcgs_sigma_rows(&params);
        for (uint32_t j = 0; j < m.n; j++)
            for (int c = 0; c < adcgs_sigma_coded(&m, j); c++)
                m.sigma[j * (size_t)rows + (size_t)c] = i & 4 ? 32767 : -32767;
        for (int c = 0; c < params.n_fv; c++)
            m.d_fv[c] = 0x1p10f;
        for (int c = 0; c < rows; c++)
            m.d_sigma[c] = 0x1p10f;
        for (adcgs_cpu_level cpu = ADCGS_CPU_SCALAR; cpu <= adcgs_cpu_best(); cpu++)
            check_model(&m, 1, cpu);
        clear_model(&m);
    }
}

/* A tensor whose numbers all have the same pattern. */
static void fill_tensor(adcgs_tensor *t, uint32_t rows, uint32_t cols, float value)
{
    adcgs_free(NULL, t->m);
    *t = (adcgs_tensor){.rows = rows, .cols = cols, .mode = 1, .m = adcgs_alloc(NULL, (size_t)rows * cols, 4, NULL)};
    assert_non_null(t->m);
    for (size_t i = 0; i < (size_t)rows * cols; i++)
        t->m[i] = (int32_t)adcgs_float_bits(value);
}

/* The largest network of a role: four layers of 512 rows, the inner ones residual, all numbers as large as allowed. */
static void fill_network(adcgs_model *m, int role, float value)
{
    adcgs_net *net = &m->net[role];
    uint32_t n_in, n_out;
    adcgs_role_shape(&m->params, role, &n_in, &n_out);
    net->present = 1;
    net->role = (uint8_t)role;
    net->n_layers = 4;
    for (int l = 0; l < 4; l++, n_in = ADCGS_NET_WIDTH_MAX) {
        const uint32_t rows = l < 3 ? ADCGS_NET_WIDTH_MAX : n_out;
        net->layer[l].residual = l == 1 || l == 2;
        fill_tensor(&net->layer[l].w, rows, n_in, value);
        fill_tensor(&net->layer[l].b, rows, 1, value);
    }
}

static void make_largest(adcgs_model *m, float value)
{
    uint64_t random = 8;
    adcgs_params params;
    adcgs_random_params(&params, 1, &random);
    assert_int_equal(adcgs_random_model(m, &params, 2, 4, &random, NULL), ADCGS_OK);
    for (int role = ADCGS_ROLE_PREDICTION; role < ADCGS_ROLE_TIME; role++)
        fill_network(m, role, value);
    for (size_t j = 0; j < (size_t)m->n * params.n_fv; j++)
        m->fv[j] = 32767;
    for (int c = 0; c < params.n_fv; c++)
        m->d_fv[c] = 0x1p10f;
    m->is_static[0] = 0;
}

/* REQ-BNDS-001, REQ-LATN-008 */
static void test_largest_networks(void **state)
{
    for (int sign = -1; sign <= 1; sign += 2) {
        adcgs_model m;
        adcgs_error error = {0};
        make_largest(&m, (float)sign * 0x1.fffffep7f);
        if (adcgs_model_validate(&m, &error) != ADCGS_OK)
            fail_msg("%s", error.text);
        for (adcgs_cpu_level cpu = ADCGS_CPU_SCALAR; cpu <= adcgs_cpu_best(); cpu++)
            check_model(&m, 1, cpu);
        clear_model(&m);
    }
}

/* Indices at both limits, and factors equal to the table: 2^(q/8), rounded once. */
/* REQ-LATN-011 */
static void test_adaptive_steps(void **state)
{
    uint64_t random = 9;
    for (int q = -16; q <= 16; q++) {
        assert_true(fabs(adcgs_step_factor(q) / exp2(q / 8.0) - 1) <= 0x1p-24);
        assert_true(q < -8 || adcgs_step_factor(q) == 2 * adcgs_step_factor(q - 8));
    }
    assert_true(adcgs_step_factor(0) == 1);
    for (int i = 0; i < 12; i++) {
        adcgs_params params;
        adcgs_model m;
        adcgs_random_params(&params, i % 2, &random);
        params.adaptive_steps = 1;
        params.n_fg = (uint8_t)(i % 3 * params.chunks);
        assert_int_equal(adcgs_random_model(&m, &params, 130, 4, &random, NULL), ADCGS_OK);
        adcgs_net *net = &m.net[ADCGS_ROLE_ENTROPY_STEPS];
        assert_int_equal(adcgs_net_outputs(net), i % 3 ? 2 + params.chunks : 2);
        for (uint32_t o = 0; i % 4 == 3 && o < adcgs_net_outputs(net); o++)
            net->layer[net->n_layers - 1].b.m[o] = o % 2 ? 5000000 : -5000000;
        net->layer[net->n_layers - 1].shift = (uint8_t)(i % 4 == 3 ? 0 : 10);
        assert_int_equal(adcgs_model_validate(&m, NULL), ADCGS_OK);
        for (adcgs_cpu_level cpu = ADCGS_CPU_SCALAR; cpu <= adcgs_cpu_best(); cpu++)
            check_model(&m, 3, cpu);
        net->sigma_offset = 1;
        assert_int_equal(adcgs_model_validate(&m, NULL), ADCGS_ERR_DATA);
        clear_model(&m);
    }
}

/* A model with one anchor that has a lifetime and a velocity, and one that is static. */
static void make_span(adcgs_model *m, int networks, float pace)
{
    uint64_t random = 10;
    adcgs_params params;
    adcgs_random_params(&params, 1, &random);
    params.spans = 1;
    params.adaptive_steps = params.n_fg = 0;
    assert_int_equal(adcgs_random_model(m, &params, 70, 4, &random, NULL), ADCGS_OK);
    for (int role = ADCGS_ROLE_COARSE; !networks && role <= ADCGS_ROLE_FINE; role++)
        adcgs_net_release(&m->net[role], NULL);
    const int16_t values[5] = {800, -1600, 80, 0, (int16_t)(pace * 100)};
    for (int c = 0; c < 5; c++)
        m->d_sigma[6 + c] = c < 4 ? 0.01f : 1.0f / 100;
    m->is_static[0] = 0;
    m->mask[0] = 1;
    memcpy(m->sigma + 6, values, sizeof values);
    m->is_static[1] = m->mask[1] = 1;
    memset(m->sigma + 11 + 6, 0, sizeof values);
}

static void at(const adcgs_model *m, float t, uint32_t anchor, float position[3], float *opacity)
{
    adcgs_splat *splat;
    adcgs_primitives p;
    assert_int_equal(adcgs_splat_create(&splat, m, ADCGS_CPU_AUTO, NULL, NULL, NULL), ADCGS_OK);
    assert_int_equal(adcgs_splat_at(splat, t, &p, NULL), ADCGS_OK);
    for (int a = 0; a < 3; a++)
        position[a] = p.mean[a][anchor];
    *opacity = p.opacity[anchor];
    adcgs_splat_free(&splat);
}

/* Meaning of a lifetime: an anchor moves in a straight line, is fully present in the middle, and fades equally on both sides. */
/* REQ-PRIM-013, REQ-PRIM-024, REQ-LATN-012 */
static void test_spans(void **state)
{
    adcgs_model m;
    float middle[3], early[3], late[3], there, before, behind;
    make_span(&m, 0, 2);
    assert_int_equal(adcgs_model_validate(&m, NULL), ADCGS_OK);
    at(&m, 0.5f, 0, middle, &there);
    at(&m, 0.375f, 0, early, &before);
    at(&m, 0.625f, 0, late, &behind);
    const float u = 0.125f * expf(2), way[3] = {8 * 0.125f, -16 * 0.125f, 0.8f * 0.125f};
    for (int a = 0; a < 3; a++) {
        const float roundings = 1e-6f * (4 + fabsf(middle[a]));
        assert_true(fabsf(late[a] - middle[a] - way[a] * u) < roundings);
        assert_true(fabsf(middle[a] - early[a] - way[a] * u) < roundings);
    }
    assert_true(before == behind && fabsf(behind / there - expf(-u * u * u * u)) < 1e-5f);
    at(&m, 1, 0, late, &behind);
    assert_true(behind >= 0 && behind < 1e-30f); /* practically gone, and at rest after 4 of its lengths */
    at(&m, 0, 1, early, &before);
    at(&m, 1, 1, late, &behind);
    assert_memory_equal(early, late, sizeof early); /* a static anchor has no end */
    assert_true(before == behind && before > 0);
    m.sigma[11 + 6] = 1;
    assert_int_equal(adcgs_model_validate(&m, NULL), ADCGS_ERR_DATA);
    clear_model(&m);
    for (int i = 0; i < 8; i++) { /* at the limits of the pace, and with every possible network */
        make_span(&m, i & 1, i & 2 ? 200 : -200);
        m.sigma[9] = i & 4 ? 32767 : 0;
        for (adcgs_cpu_level cpu = ADCGS_CPU_SCALAR; cpu <= adcgs_cpu_best(); cpu++)
            check_model(&m, 3, cpu);
        clear_model(&m);
    }
}

/* Sets Z so that a body at t = 1 has turned by a quarter about z and moved by (0.5, -1, 0.25); at t = 0 it is at rest. */
static void set_pose(adcgs_model *m, int body)
{
    const float turned[7] = {(cosf((float)PI / 4) - 1) * 16, 0, 0, sinf((float)PI / 4) * 16, 8, -16, 4};
    adcgs_tensor *z = &m->net[ADCGS_ROLE_TIME].layer[0].w;
    const uint32_t column = adcgs_pose_at(&m->params, body);
    z->mode = 1;
    z->e = 0;
    memset(z->m, 0, (size_t)z->rows * z->cols * sizeof *z->m);
    for (uint32_t c = 0; c < ADCGS_POSE_N; c++)
        z->m[z->cols + column + c] = (int32_t)adcgs_float_bits(turned[c]);
}

/* Three anchors of body 2 without networks of deformation, one of no body, one static; each with one primitive. */
static void make_body(adcgs_model *m)
{
    static const uint8_t bodies[5] = {2, 2, 2, 0, 0};
    uint64_t random = 12;
    adcgs_params params;
    adcgs_random_params(&params, 1, &random);
    params.spans = params.adaptive_steps = params.n_fg = 0;
    params.bodies = 2;
    params.time_rows = 2;
    assert_int_equal(adcgs_random_model(m, &params, 5, 4, &random, NULL), ADCGS_OK);
    for (int role = ADCGS_ROLE_COARSE; role <= ADCGS_ROLE_FINE; role++)
        adcgs_net_release(&m->net[role], NULL);
    memcpy(m->body, bodies, sizeof bodies);
    for (int i = 0; i < 5; i++) {
        m->is_static[i] = i == 4;
        m->mask[i] = 1;
    }
    adcgs_random_one_tier(m);
    set_pose(m, 2);
}

/* Meaning of a body: a quarter turn about the centre of the anchors' box, then the translation; nothing else changes. */
/* REQ-PRIM-013, REQ-PRIM-025, REQ-PRIM-026 */
static void test_bodies(void **state)
{
    adcgs_model m;
    make_body(&m);
    assert_int_equal(adcgs_model_validate(&m, NULL), ADCGS_OK);
    float centre[3];
    for (size_t a = 0; a < 3; a++) {
        const uint32_t p[3] = {m.pos[a], m.pos[3 + a], m.pos[6 + a]};
        const uint32_t low = ADCGS_MIN(p[0], ADCGS_MIN(p[1], p[2])), high = ADCGS_MAX(p[0], ADCGS_MAX(p[1], p[2]));
        centre[a] = m.origin[a] + m.voxel * 0.5f * (float)(low + high + 1);
    }
    for (uint32_t i = 0; i < 5; i++) {
        float rest[3], moved[3], before, behind;
        at(&m, 0, i, rest, &before);
        at(&m, 1, i, moved, &behind);
        const float x[3] = {rest[0] - centre[0], rest[1] - centre[1], rest[2] - centre[2]};
        const float there[3] = {centre[0] - x[1] + 0.5f, centre[1] + x[0] - 1, centre[2] + x[2] + 0.25f};
        for (int a = 0; a < 3; a++)
            assert_true(fabsf(moved[a] - (m.body[i] ? there[a] : rest[a])) <= (m.body[i] ? 1e-5f * (4 + fabsf(rest[a])) : 0));
        assert_true(before == behind);
    }
    for (adcgs_cpu_level cpu = ADCGS_CPU_SCALAR; cpu <= adcgs_cpu_best(); cpu++)
        check_model(&m, 3, cpu);
    m.body[4] = 1; /* a static anchor belongs to no body */
    assert_int_equal(adcgs_model_validate(&m, NULL), ADCGS_ERR_DATA);
    m.body[4] = 0;
    m.body[3] = 3;
    assert_int_equal(adcgs_model_validate(&m, NULL), ADCGS_ERR_DATA);
    clear_model(&m);
}

/* Bodies of any number, together with all other causes of motion. */
static void test_bodies_and_all(void **state)
{
    uint64_t random = 13;
    for (int i = 0; i < 12; i++) {
        adcgs_params params;
        adcgs_model m;
        adcgs_random_params(&params, 1, &random);
        params.bodies = (uint8_t)(1 + i * 5 % ADCGS_BODIES_MAX);
        params.spans = i & 1;
        params.coarse_rotation = i >> 1 & 1;
        params.n_fg = 0;
        assert_int_equal(adcgs_random_model(&m, &params, 150, 4, &random, NULL), ADCGS_OK);
        if (i % 3 == 0)
            adcgs_net_release(&m.net[ADCGS_ROLE_COARSE], NULL);
        if (i % 4 == 0)
            adcgs_net_release(&m.net[ADCGS_ROLE_FINE], NULL);
        m.net[ADCGS_ROLE_TIME].layer[0].w.e = m.net[ADCGS_ROLE_TIME].layer[0].w.mode ? 9 : 4; /* poses large enough to see */
        assert_int_equal(adcgs_model_validate(&m, NULL), ADCGS_OK);
        for (adcgs_cpu_level cpu = ADCGS_CPU_SCALAR; cpu <= adcgs_cpu_best(); cpu++)
            check_model(&m, 3, cpu);
        clear_model(&m);
    }
}

/* REQ-NETW-009 */
static void test_refused_networks(void **state)
{
    static const uint32_t patterns[] = {0x43800000u, 0xc3800000u, 0x7f800000u, 0xffc00000u, 0x00000001u, 0x807fffffu};
    adcgs_model m;
    make_largest(&m, 0x1p-3f);
    adcgs_net *net = &m.net[ADCGS_ROLE_COARSE];
    adcgs_tensor *w = &net->layer[3].w;
    w->m[1] = (int32_t)0x80000000u;
    assert_int_equal(adcgs_model_validate(&m, NULL), ADCGS_OK);
    for (size_t i = 0; i < ADCGS_COUNTOF(patterns); i++) {
        w->m[1] = (int32_t)patterns[i];
        assert_int_equal(adcgs_model_validate(&m, NULL), ADCGS_ERR_DATA);
    }
    w->m[1] = 0;
    for (int e = 0; e <= 41; e++) {
        const int32_t largest = e < 16 ? (1 << (8 + e)) - 1 : 0xffffff;
        for (size_t i = 0; i < (size_t)w->rows * w->cols; i++)
            w->m[i] = -largest;
        w->mode = 0;
        w->e = (uint8_t)e;
        assert_int_equal(adcgs_model_validate(&m, NULL), e <= 40 ? ADCGS_OK : ADCGS_ERR_DATA);
        w->m[2] = largest + 1;
        assert_int_equal(adcgs_model_validate(&m, NULL), ADCGS_ERR_DATA);
    }
    w->e = 20;
    w->m[2] = 0;
    for (int l = 0; l < 4; l++) {
        const uint8_t before = net->layer[l].residual;
        net->layer[l].residual = l == 0 || l == 3;
        assert_int_equal(adcgs_model_validate(&m, NULL), l == 0 || l == 3 ? ADCGS_ERR_DATA : ADCGS_OK);
        net->layer[l].residual = before;
    }
    clear_model(&m);
}

static void test_memory_limit(void **state)
{
    uint64_t random = 7;
    adcgs_params params;
    adcgs_model m;
    adcgs_splat *splat;
    adcgs_error error = {0};
    adcgs_random_params(&params, 1, &random);
    assert_int_equal(adcgs_random_model(&m, &params, 100, 4, &random, NULL), ADCGS_OK);
    for (uint64_t limit = 1; limit < 100000; limit *= 3) {
        adcgs_memory memory = {.limit = limit};
        assert_int_equal(adcgs_splat_create(&splat, &m, ADCGS_CPU_AUTO, NULL, &memory, &error), ADCGS_ERR_LIMIT);
        assert_null(splat);
        assert_int_equal(memory.used, 0);
    }
    clear_model(&m);
}

/* REQ-PRIM-001, REQ-PRIM-002, REQ-PRIM-003, REQ-PRIM-004 */
static void test_functions(void **state)
{
    for (int i = -1000000; i <= 1000000; i++) {
        const float x = (float)i * 1.2e-4f, y = (float)i * 1e-3f;
        float s, c;
        assert_true(fabs(adcgs_exp2(x) / exp2(x) - 1.0) < 1.0e-7);
        if (fabsf(x) < 86.0f)
            assert_true(fabs(adcgs_exp(x) / exp(x) - 1.0) < 1.5e-7);
        if (fabsf(x) < 32.0f)
            assert_true(fabs(adcgs_sigmoid(x) * (1.0 + exp(-(double)x)) - 1.0) < 2.5e-7);
        const double power = log2(adcgs_exp2(x));
        assert_true(fabs(adcgs_log2(adcgs_exp2(x)) - power) < 1.0e-7 * fmax(1.0, fabs(power)));
        adcgs_sincospi(y, &s, &c);
        assert_true(fabs(s - sin(PI * fmod(y, 2.0))) < 1.2e-7 && fabs(c - cos(PI * fmod(y, 2.0))) < 1.2e-7);
    }
    assert_true(adcgs_exp2(1e30f) == 0x1p127f && adcgs_exp2(-1e30f) == 0x1p-125f);
    assert_true(adcgs_sigmoid(1e30f) == 1.0f && adcgs_sigmoid(-1e30f) > 0.0f && adcgs_exp(0.0f) == 1.0f);
}

/* REQ-PRIM-010 */
static void test_position_code(void **state)
{
    static _Alignas(64) float x[3 * 64], code[6 * ADCGS_OCTAVES_MAX * 64];
    for (int i = 0; i < 192; i++)
        x[i] = (float)(2 * i + 1) * 0x1p-9f;
    adcgs_position_code(code, x, ADCGS_OCTAVES_MAX);
    for (int a = 0; a < 3; a++)
        for (int o = 0; o < ADCGS_OCTAVES_MAX; o++)
            for (int l = 0; l < 64; l++) {
                float s, c;
                adcgs_sincospi(ldexpf(x[a * 64 + l], o), &s, &c);
                assert_true(code[(a * ADCGS_OCTAVES_MAX + o) * 128 + l] == s &&
                            code[(a * ADCGS_OCTAVES_MAX + o) * 128 + 64 + l] == c);
            }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_functions),      cmocka_unit_test(test_position_code),    cmocka_unit_test(test_against_reference),
        cmocka_unit_test(test_extremes),       cmocka_unit_test(test_memory_limit),     cmocka_unit_test(test_largest_networks),
        cmocka_unit_test(test_adaptive_steps), cmocka_unit_test(test_refused_networks), cmocka_unit_test(test_spans),
        cmocka_unit_test(test_bodies),         cmocka_unit_test(test_bodies_and_all),
    };
    return cmocka_run_group_tests_name("splat", tests, NULL, NULL);
}

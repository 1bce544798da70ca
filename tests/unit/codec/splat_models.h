/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Models for the tests of primitives: random ones changed to have largest networks, lifetimes or bodies. */
#ifndef ADCGS_TESTS_SPLAT_MODELS_H
#define ADCGS_TESTS_SPLAT_MODELS_H

#include "splat_reference.h"

#include "model/model_priv.h"
#include "random_model.h"
#include "splat/splat.h"

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

/* Makes the first anchors static, and thus without lifetimes and bodies. */
static inline void stand_still(adcgs_model *m, uint32_t anchors)
{
    const size_t rows = (size_t)adcgs_sigma_rows(&m->params);
    memset(m->is_static, m->params.time_rows > 0, anchors);
    memset(m->body, 0, anchors);
    for (uint32_t i = 0; m->params.spans && i < anchors; i++)
        memset(m->sigma + i * rows + 6, 0, 5 * sizeof *m->sigma);
    assert_int_equal(adcgs_model_validate(m, NULL), ADCGS_OK);
}

static inline void clear_model(adcgs_model *m)
{
    adcgs_model_clear(m, NULL);
}

/* A tensor whose numbers all have the same pattern. */
static inline void fill_tensor(adcgs_tensor *t, uint32_t rows, uint32_t cols, float value)
{
    adcgs_free(NULL, t->m);
    *t = (adcgs_tensor){.rows = rows, .cols = cols, .mode = 1, .m = adcgs_alloc(NULL, (size_t)rows * cols, 4, NULL)};
    assert_non_null(t->m);
    for (size_t i = 0; i < (size_t)rows * cols; i++)
        t->m[i] = (int32_t)adcgs_float_bits(value);
}

/* The largest network of a role: four layers of 512 rows, the inner ones residual, all numbers as large as allowed. */
static inline void fill_network(adcgs_model *m, int role, float value)
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

static inline void make_largest(adcgs_model *m, float value)
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

/* A model with one anchor that has a lifetime and a velocity, and one that is static. */
static inline void make_span(adcgs_model *m, int networks, float pace)
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

static inline void at(const adcgs_model *m, float t, uint32_t anchor, float position[3], float *opacity)
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

/* Sets Z so that a body at t = 1 has turned by a quarter about z and moved by (0.5, -1, 0.25); at t = 0 it is at rest. */
static inline void set_pose(adcgs_model *m, int body)
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
static inline void make_body(adcgs_model *m)
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

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Primitives against an evaluation one by one that follows the specification's text, bit for bit, on every CPU level and for
 * several numbers of threads; the elementary functions against the C library's.
 */
#include "splat_models.h"

#include "base/cpu_detect.h"
#include "base/fmath.h"
#include "base/thread_pool.h"
#include "model/model_priv.h"
#include "splat/splat.h"
#include "splat/steps.h"

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

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

static const float times[] = {0.0f, 0.37f, 0.37f, 1.0f, 0.999999f, -3.0f, 2.0f, NAN};

/** The slow reference judges scalar kernels at all times, others at two. The digest of all kernels is the same at all times. */
static void check_level(const adcgs_model *m, int threads, adcgs_cpu_level cpu, uint8_t digests[ADCGS_COUNTOF(times)][16])
{
    adcgs_pool *pool;
    adcgs_splat *splat;
    adcgs_primitives p;
    uint8_t digest[16];
    assert_int_equal(adcgs_pool_create(&pool, threads, NULL), ADCGS_OK);
    assert_int_equal(adcgs_splat_create(&splat, m, cpu, pool, NULL, NULL), ADCGS_OK);
    for (size_t i = 0; i < ADCGS_COUNTOF(times); i++) {
        assert_int_equal(adcgs_splat_at(splat, times[i], &p, NULL), ADCGS_OK);
        if (cpu == ADCGS_CPU_SCALAR || i == 2 || i == 3)
            check_primitives(m, &p, isnan(times[i]) ? 0.0f : adcgs_clampf(times[i], 0.0f, 1.0f));
        adcgs_splat_digest(m, &p, cpu == ADCGS_CPU_SCALAR ? digests[i] : digest);
        if (cpu != ADCGS_CPU_SCALAR)
            assert_memory_equal(digest, digests[i], sizeof digest);
    }
    adcgs_splat_free(&splat);
    adcgs_pool_free(&pool);
}

static void check_model(const adcgs_model *m, int threads)
{
    uint8_t digests[ADCGS_COUNTOF(times)][16];
    for (adcgs_cpu_level cpu = ADCGS_CPU_SCALAR; cpu <= adcgs_cpu_best(); cpu++)
        check_level(m, cpu == ADCGS_CPU_SCALAR ? 1 : threads, cpu, digests);
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
        check_model(&m, 3);
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
        check_model(&m, 1);
        clear_model(&m);
    }
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
        check_model(&m, 1);
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
        check_model(&m, 3);
        net->sigma_offset = 1;
        assert_int_equal(adcgs_model_validate(&m, NULL), ADCGS_ERR_DATA);
        clear_model(&m);
    }
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
        check_model(&m, 3);
        clear_model(&m);
    }
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
    check_model(&m, 3);
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
        check_model(&m, 3);
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

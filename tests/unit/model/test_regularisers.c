/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The regularisers of training against direct evaluations and central differences: rigidity and its neighbours, area. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "train_fixture.h"

#include "fmodel/pass.h"
#include "fmodel/rigidity.h"
#include "fmodel/scale_penalty.h"
#include "grad/random.h"

#include <math.h>

/** Moves a place by the motion that F_omega gives. */
static void ref_motion(const double om[12], const double place[3], double out[3])
{
    double q[4] = {1, om[9], om[10], om[11]}, v[4] = {0, place[0], place[1], place[2]}, turned[4], back[4];
    normalise(q);
    const double conj[4] = {q[0], -q[1], -q[2], -q[3]};
    product(q, v, turned);
    product(turned, conj, back);
    for (int a = 0; a < 3; a++)
        out[a] = back[1 + a] + om[a];
}

/** The rigidity energy between neighbours, by its definition, in double. */
static double ref_rigid(const adcgs_rigidity *rigid, const adcgs_fmodel *f, double t)
{
    double energy = 0, om[ANCHORS][12];
    for (uint32_t i = 0; i < f->n; i++)
        ref_omega(f, i, t, om[i]);
    for (uint32_t i = 0; i < f->n; i++)
        for (int k = 0; k < ADCGS_RIGIDITY_NEAR; k++) {
            double y[3], by_i[3], by_j[3], length = 0, stretch = 0;
            if (rigid->near[i][k] < 0)
                continue;
            const uint32_t j = (uint32_t)rigid->near[i][k];
            if (f->moving[i] == 0 || f->moving[j] == 0)
                continue;
            for (int a = 0; a < 3; a++) {
                y[a] = place(f, j, a);
                length += pow(y[a] - place(f, i, a), 2);
            }
            ref_motion(om[i], y, by_i);
            ref_motion(om[j], y, by_j);
            for (int a = 0; a < 3; a++)
                stretch += pow(by_i[a] - by_j[a], 2);
            energy += 0.05 * log(1 + stretch / length / (0.05 * 0.05));
        }
    return energy / ADCGS_RIGIDITY_NEAR / f->n;
}

static const adcgs_rigidity *rigid_under_test;

static double rigid_energy(const adcgs_fmodel *f)
{
    return ref_rigid(rigid_under_test, f, 0.4f);
}

/** The k-th anchor to i by key, then number. The key is the distance or, if drawn, a random number of those within reach. */
static int32_t near_by_search(const adcgs_fmodel *f, uint32_t i, int drawn, int k)
{
    const double reach = (double)ADCGS_RIGIDITY_REACH / (double)f->voxel;
    uint8_t taken[ANCHORS] = {0};
    int32_t best = -1;
    for (int turn = 0; turn <= k; turn++) {
        uint64_t least = UINT64_MAX;
        best = -1;
        for (uint32_t j = 0; j < ANCHORS; j++) {
            uint64_t d = 0;
            for (int a = 0; a < 3; a++)
                d += (uint64_t)(((int64_t)f->pos[i][a] - f->pos[j][a]) * ((int64_t)f->pos[i][a] - f->pos[j][a]));
            const uint64_t key = drawn ? adcgs_random64(1, i, j) : d;
            if (j == i || taken[j] || (drawn && (double)d >= reach * reach) || key >= least)
                continue;
            least = key;
            best = (int32_t)j;
        }
        if (best >= 0)
            taken[best] = 1;
    }
    return best;
}

/** The neighbours equal those of an exhaustive search. */
static void test_neighbours(void **state)
{
    const fixture *x = *state;
    adcgs_rigidity rigid = {0};
    adcgs_error error;
    assert_int_equal(adcgs_rigidity_build(&rigid, x->f, NULL, &error), ADCGS_OK);
    for (uint32_t i = 0; i < ANCHORS; i++)
        for (int k = 0; k < ADCGS_RIGIDITY_NEAR; k++) {
            const int drawn = k >= ADCGS_RIGIDITY_CLOSE;
            assert_int_equal(rigid.near[i][k], near_by_search(x->f, i, drawn, drawn ? k - ADCGS_RIGIDITY_CLOSE : k));
        }
    adcgs_rigidity_clear(&rigid);
}

static void test_rigid(void **state)
{
    const fixture *x = *state;
    adcgs_rigidity rigid = {0};
    adcgs_error error;
    assert_int_equal(adcgs_rigidity_build(&rigid, x->f, NULL, &error), ADCGS_OK);
    rigid_under_test = &rigid;
    adcgs_pass_forward(x->pass, x->f, 0.4f, &(adcgs_pass_mode){.deform = ADCGS_DEFORM_ALL});
    clear_gradients(x->f);
    memset(x->pass->grad, 0, 16 * (size_t)x->pass->primitives.n * sizeof(float));
    assert_float_equal(adcgs_rigidity_pull(&rigid, x->pass, x->f, 1), rigid_energy(x->f), 1e-5);
    x->pass->pull = rigid.pull;
    adcgs_pass_backward(x->pass, x->f, ADCGS_DEFORM_ALL, 0, 0, 0, NULL);
    x->pass->pull = NULL;
    check_gradients(x->f, rigid_energy, 0);
    adcgs_rigidity_clear(&rigid);
}

/** Price of size: its value and gradient against a calculation by hand. Invisible primitives have neither. */
static void test_area(void **state)
{
    static const float sd[3][4] = {{1, 2, 5, 0.5f}, {2, 3, 7, 0.25f}, {4, 1, 9, 1}};
    static const float opacity[4] = {0.5f, 0.25f, 0, 0.99f};
    const float *const s[3] = {sd[0], sd[1], sd[2]};
    const adcgs_primitives primitives = {.n = 4, .scale = {sd[0], sd[1], sd[2]}, .opacity = opacity};
    float g[3][4] = {{1, 1, 1, 1}, {1, 1, 1, 1}, {1, 1, 1, 1}};
    double area = 0;
    for (int i = 0; i < 4; i++)
        area += i == 2 ? 0 : (double)(s[0][i] * s[1][i] + s[1][i] * s[2][i] + s[2][i] * s[0][i]);
    float *const to[3] = {g[0], g[1], g[2]};
    const double price = adcgs_scale_penalty(&primitives, &(adcgs_viewpoints){.n = 0}, 0.5f, to);
    assert_float_equal(price, 0.5 * area / 9, 1e-6);
    for (int a = 0; a < 3; a++)
        for (int i = 0; i < 4; i++)
            assert_float_equal(g[a][i], i == 2 ? 1 : 1 + 0.5f / 9 * (s[(a + 1) % 3][i] + s[(a + 2) % 3][i]), 1e-6);
}

/** The same with viewpoints, which include places between cameras: a closer primitive counts as larger. */
static void test_area_seen(void **state)
{
    static const float camera[5][3] = {{0, 0, 0}, {2, 0, 0}, {0, 0, 0}, {0, 6, 0}, {2, 0, 0}};
    static const float at[3][4] = {{1, 3, 0, 0}, {0.25f, 1, 0, 6.01f}, {0, 0, 0.1f, 0}}; /* one row per axis */
    static const float larger[4] = {16, 0.5f, 100, 400};
    static const float one[4] = {1, 1, 1, 1};
    const float *const mean[3] = {at[0], at[1], at[2]};
    adcgs_primitives primitives = {.n = 4, .scale = {one, one, one}, .opacity = one};
    float g[3][4] = {{0}};
    adcgs_viewpoints viewpoints = {.n = 0};
    adcgs_error error;
    memcpy(primitives.mean, mean, sizeof mean);
    assert_int_equal(adcgs_viewpoints_create(&viewpoints, camera, 5, &error), ADCGS_OK);
    assert_int_equal(viewpoints.n, 3 + 2 * 3);
    adcgs_scale_penalty(&primitives, &viewpoints, 3, (float *const[]){g[0], g[1], g[2]});
    for (int i = 0; i < 4; i++)
        assert_float_equal(g[0][i], 0.5f * larger[i], 1e-4);
    adcgs_viewpoints_clear(&viewpoints);
}

/** Many primitives before many viewpoints: each uses its nearest viewpoint, at any place in memory. */
static void test_area_many(void **state)
{
    (void)state;
    enum { MANY = 150, SEEN_FROM = 9 };
    static float mean[3][MANY], one[MANY], g[3][MANY], at[SEEN_FROM][3];
    adcgs_primitives primitives = {.n = MANY, .scale = {one, one, one}, .opacity = one};
    memset(g, 0, sizeof g);
    for (int a = 0; a < 3; a++)
        primitives.mean[a] = mean[a];
    for (int i = 0; i < 3 * MANY; i++)
        mean[i / MANY][i % MANY] = (float)adcgs_random_unit(7, 0, (uint64_t)i);
    for (int i = 0; i < 3 * SEEN_FROM; i++)
        at[i / 3][i % 3] = 2 * (float)adcgs_random_unit(7, 1, (uint64_t)i);
    for (int i = 0; i < MANY; i++)
        one[i] = 1;
    const adcgs_viewpoints viewpoints = {.n = SEEN_FROM, .x = at};
    adcgs_scale_penalty(&primitives, &viewpoints, 3 * MANY, (float *const[]){g[0], g[1], g[2]});
    for (int i = 0; i < MANY; i++) {
        double least = INFINITY;
        for (int j = 0; j < SEEN_FROM; j++)
            least = fmin(least, pow((double)(mean[0][i] - at[j][0]), 2) + pow((double)(mean[1][i] - at[j][1]), 2) +
                                    pow((double)(mean[2][i] - at[j][2]), 2));
        assert_float_equal(g[0][i], 2 / fmax(least, 0.0025), 1e-4 * (1 + 2 / fmax(least, 0.0025)));
    }
}

int main(void)
{
    int failed = 0;
    for (int level = ADCGS_CPU_SCALAR; level <= (int)adcgs_cpu_best(); level++) {
        void *const state = (void *)(uintptr_t)level;
        const struct CMUnitTest tests[] = {
            {"neighbours", test_neighbours, setup, teardown, state},
            {"rigid", test_rigid, setup, teardown, state},
            {"area", test_area, NULL, NULL, state},
            {"area with viewpoints", test_area_seen, NULL, NULL, state},
            {"area of many", test_area_many, NULL, NULL, state},
        };
        void *const lives = (void *)(uintptr_t)(level + WITH_SPANS);
        const struct CMUnitTest spans[] = {
            {"rigid with spans", test_rigid, setup, teardown, lives},
        };
        failed += cmocka_run_group_tests_name("regularisers", tests, NULL, NULL);
        failed += cmocka_run_group_tests_name("regularisers with spans", spans, NULL, NULL);
    }
    return failed;
}

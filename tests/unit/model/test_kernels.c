/* SPDX-License-Identifier: BSD-2-Clause */
/**
 * \file
 * Every kernel at every CPU level of this machine, on ordinary, wide and extreme numbers (zeros of both signs, subnormals, the
 * largest, infinities, NaN). Nothing is written outside the outputs.
 * - Kernels that determine the decoded result, and those that promise the same, give the bits of the portable ones. A NaN equals
 *   any other NaN.
 * - Other kernels of training give the results of the portable ones, except for the order of sums and fused products.
 * The integer networks' kernels are in test_net.c: their inputs are checked when a network is loaded.
 */
#include "config.h"

#include "kernel_calls.h"

#include "base/cpu_detect.h"
#include "grad/dsp.h"
#include "grad/loss.h"
#include "grad/raster.h"
#include "splat/splat_isa.h"
#include "unit/pixels_scene.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

/* ---- Kernels of the decoder ---- */

static void dense(call *c)
{
    adcgs_dense_dsp dsp;
    const int n_out = size_of(c, 40), n_in = size_of(c, 40) - 1;
    adcgs_dense_dsp_init(&dsp, c->level);
    const float *const w = given(c, (size_t)n_out * 40), *const x = given(c, (size_t)n_in * L);
    const float *const bias = given(c, (size_t)n_out);
    dsp.dense(output(c, (size_t)n_out * L), NULL, bias, w, 40, x, n_out, n_in);
    dsp.lrelu(added(c, (size_t)n_out * L), n_out);
    dsp.residual(added(c, (size_t)n_out * L), given(c, (size_t)n_out * L), n_out);
}

#define FLOATS(type) (sizeof(type) / sizeof(float))

/** Everything that may move anchors, alone and together. */
static adcgs_movers movers_of(const call *c)
{
    const int coarse = c->round % 3 > 0;
    return (adcgs_movers){coarse, coarse && c->round & 4, c->round & 1};
}

/** In some rounds, bodies that move some of the anchors. */
static const adcgs_body_lanes *bodies_of(call *c)
{
    adcgs_body_lanes *const bodies = (void *)given(c, FLOATS(adcgs_body_lanes));
    memcpy(bodies->has, flags(c), sizeof bodies->has);
    return c->round / 2 % 3 ? bodies : NULL;
}

static void anchors(call *c)
{
    adcgs_splat_dsp dsp;
    const int octaves = size_of(c, 8);
    const adcgs_movers movers = movers_of(c);
    adcgs_splat_dsp_init(&dsp, c->level);
    dsp.anchor((void *)added(c, FLOATS(adcgs_anchor_lanes)), given(c, ADCGS_SIGMA_MAX * L), movers.spans);
    const adcgs_anchor_lanes *const anchor = (const void *)given(c, FLOATS(adcgs_anchor_lanes));
    dsp.predict((void *)added(c, FLOATS(adcgs_slot_lanes)), anchor, given(c, 14 * L));
    dsp.motion((void *)added(c, FLOATS(adcgs_anchor_motion)), anchor, given(c, 12 * L), &movers, bodies_of(c), given(c, 1)[0]);
    dsp.position_code(output(c, (size_t)(6 * octaves) * L), given(c, 3 * L), octaves);
}

static void slots(call *c)
{
    adcgs_splat_dsp dsp;
    const adcgs_movers movers = movers_of(c);
    const adcgs_anchor_lanes *const anchor = (const void *)given(c, FLOATS(adcgs_anchor_lanes));
    const adcgs_slot_lanes *const slot = (const void *)given(c, FLOATS(adcgs_slot_lanes));
    const adcgs_anchor_motion *const motion = (const void *)given(c, FLOATS(adcgs_anchor_motion));
    const adcgs_body_lanes *const bodies = bodies_of(c);
    const float *const fine = given(c, 4 * L);
    const int32_t *const present = flags(c), *const moves = flags(c);
    adcgs_slot_out to;
    float *const rows = added(c, 14 * L);
    for (int i = 0; i < 3; i++) {
        to.mean[i] = rows + i * L;
        to.scale[i] = rows + (3 + i) * L;
        to.colour[i] = rows + (6 + i) * L;
    }
    for (int i = 0; i < 4; i++)
        to.rotation[i] = rows + (9 + i) * L;
    to.opacity = rows + 13 * L;
    adcgs_splat_dsp_init(&dsp, c->level);
    if (c->round & 1)
        dsp.place(&to, slot, anchor, present);
    const int fewer = (movers.coarse || movers.spans || bodies) && c->round & 2;
    dsp.deform(&to, slot, motion, &movers, bodies, fewer ? NULL : fine, present, moves);
}

/* ---- The renderer, and kernels of training with the same promise ---- */

static const float background[3] = {0.1f, 0.5f, 0.9f};

static adcgs_primitives splats(call *c, uint32_t n)
{
    adcgs_primitives p = {.n = n, .opacity = given(c, n)};
    for (int i = 0; i < 3; i++) {
        p.mean[i] = given(c, n);
        p.colour[i] = given(c, n);
        float *const scale = given(c, n);
        for (uint32_t k = 0; k < n; k++)
            scale[k] = c->kind == EXTREME ? fabsf(scale[k]) : 0.3f * fabsf(scale[k]);
        p.scale[i] = scale;
    }
    for (int i = 0; i < 4; i++)
        p.rotation[i] = given(c, n);
    for (uint32_t k = 0; k < n; k++) /* networks limit opacity to this range */
        ((float *)(uintptr_t)p.opacity)[k] = fminf(fmaxf(p.opacity[k], 0.0f), 0.99f);
    return p;
}

static void frames(call *c)
{
    static const double origin[3] = {0, 0, 0};
    const int width = 16 + size_of(c, 60), height = 16 + size_of(c, 60);
    const adcgs_camera camera = scene_camera(width, height);
    const adcgs_primitives p = splats(c, 256);
    const size_t values = 3 * (size_t)width * (size_t)height;
    float *const rgb = output(c, values);
    adcgs_raster *raster;
    adcgs_view view;
    assert_int_equal(adcgs_view_init(&view, &camera, origin, 1, NULL), ADCGS_OK);
    assert_int_equal(adcgs_raster_create(&raster, c->level, NULL, NULL, NULL), ADCGS_OK);
    assert_int_equal(adcgs_raster_forward(raster, &p, &view, background, 0.3f, rgb, 1, NULL), ADCGS_OK);
    if (c->kind != EXTREME) { /* values that are not numbers have no gradients */
        adcgs_raster_back *back;
        float *const to = output(c, (ADCGS_GRAD_ROWS - 1) * 256);
        adcgs_raster_grads grads = adcgs_raster_grads_of(to, 256);
        grads.screen = NULL;
        memset(to, 0, (ADCGS_GRAD_ROWS - 1) * 256 * sizeof *to);
        assert_int_equal(adcgs_raster_back_create(&back, c->level, NULL, NULL), ADCGS_OK);
        const float *const grad = given_of(c, values, ORDINARY);
        assert_int_equal(adcgs_raster_backward(back, raster, &p, &view, background, 0.3f, rgb, grad, &grads, NULL), ADCGS_OK);
        adcgs_raster_back_free(&back);
    }
    adcgs_raster_free(&raster);
}

static void loss(call *c)
{
    const int width = size_of(c, 300), height = size_of(c, 40);
    const size_t n = 3 * (size_t)width * (size_t)height;
    adcgs_loss *l;
    adcgs_loss_value value;
    const adcgs_loss_shares shares = {c->round & 1 ? 0.2f : 0.0f, c->round & 2 ? 0.7f : 0.0f};
    const float *const image = given(c, n), *const target = given(c, n);
    assert_int_equal(adcgs_loss_create(&l, c->level, NULL, NULL), ADCGS_OK);
    assert_int_equal(adcgs_loss_image(l, image, target, width, height, &shares, output(c, n), &value, NULL), ADCGS_OK);
    adcgs_loss_free(&l);
}

/* ---- Other kernels of training ---- */

static adcgs_train_dsp train_dsp(const call *c)
{
    adcgs_train_dsp dsp;
    adcgs_train_dsp_init(&dsp, c->level);
    return dsp;
}

static void weights(call *c)
{
    const adcgs_train_dsp dsp = train_dsp(c);
    const int n_out = size_of(c, 40), n_in = size_of(c, 150), tiles = size_of(c, 3);
    const float *const dy = given(c, (size_t)(tiles * n_out) * L), *const x = given(c, (size_t)(tiles * n_in) * L);
    dsp.weight_grad(added(c, (size_t)n_out * 150), 150, c->round & 1 ? added(c, (size_t)n_out) : NULL, dy, (size_t)n_out * L, x,
                    (size_t)n_in * L, tiles, n_out, n_in);
    const size_t many = (size_t)size_of(c, 1000);
    float *const p = added(c, many), *const g = added(c, many), *const m = added(c, many), *const v = added(c, many);
    for (size_t i = 0; i < many; i++)
        v[i] = fabsf(v[i]); /* a mean of squares */
    dsp.adam(p, g, m, v, many, 1e-3f, 1.5f, 3);
}

/** Bits as numbers. */
static void spread(float *to, const uint64_t *below, int n)
{
    for (int i = 0; i < n * L; i++)
        to[i] = (float)(below[i / L] >> i % L & 1);
}

static void rows(call *c)
{
    const adcgs_train_dsp dsp = train_dsp(c);
    const int n = size_of(c, 20);
    const size_t many = (size_t)n * L;
    const float *const step = constant(c, (size_t)n, 0.25f);
    dsp.lrelu_back(added(c, many), given(c, many), n);
    dsp.noise(output(c, many), given(c, many), step, n, (uint32_t)c->round);
    uint64_t below[20];
    dsp.hidden(output(c, many), below, given(c, many), c->round & 1 ? given(c, many) : NULL, n);
    spread(output(c, many), below, n);
}

/** A residual layer and its backward pass, wider than one batch. */
static void residual(call *c)
{
    const adcgs_train_dsp dsp = train_dsp(c);
    const int n = size_of(c, 80);
    const size_t many = (size_t)n * L;
    uint64_t below[80];
    const float *const bias = given(c, (size_t)n);
    const adcgs_square w = {n, given(c, (size_t)(n * n)), NULL};
    dsp.residual(&dsp, output(c, many), below, bias, &w, given(c, many));
    spread(output(c, many), below, n);
    const float *const dh = given(c, many);
    dsp.residual_back(&dsp, output(c, many), output(c, many), below, &w, dh, NULL);
    float *const both = added(c, many);
    dsp.residual_back(&dsp, both, output(c, many), below, &w, both, NULL);
}

static void rates(call *c)
{
    static adcgs_rate_table *table;
    const adcgs_train_dsp dsp = train_dsp(c);
    const int n = size_of(c, 8);
    const size_t many = (size_t)n * L;
    if (!table) {
        table = malloc(sizeof *table);
        assert_non_null(table);
        adcgs_rate_table_init(table);
    }
    adcgs_rate_io io = {.n = n,
                        .y = given(c, many),
                        .step = constant(c, (size_t)n, 0.25f),
                        .mu = given(c, many),
                        .si = given(c, many),
                        .weight = constant(c, L, 1),
                        .scale = 1,
                        .dy = added(c, many),
                        .dmu = output(c, many),
                        .dsi = output(c, many),
                        .table = table,
                        .x = c->round & 1 ? output(c, many) : NULL};
    *output(c, 1) = (float)dsp.rate(&io);
    if (c->kind == ORDINARY)
        return; /* a value half-way between two levels may go either way, which changes its bits by a step */
    io.mean = output(c, many);
    *output(c, 1) = (float)dsp.rate_exact(&io);
}

/* ---- Comparing ---- */

typedef struct subject {
    const char *name;
    void (*run)(call *c);
    int exact;
} subject;

static const subject subjects[] = {
    {"dense layers", dense, 1}, {"anchors", anchors, 1}, {"slots", slots, 1},
    {"frames", frames, 1},      {"loss", loss, 1},       {"weights", weights, 0},
    {"rows", rows, 0},          {"rates", rates, 0},     {"residual layers", residual, 1},
};

static int same(float a, float b)
{
    return !memcmp(&a, &b, sizeof a) || (isnan(a) && isnan(b));
}

/** Relative to the largest number of the output, since sums may cancel. */
static int close_enough(float a, float b, float largest)
{
    return same(a, b) || a == b || fabsf(a - b) <= 1e-4f * largest;
}

static void check_guards(const call *c, const char *what)
{
    for (int i = 0; i < c->n; i++) {
        const unsigned char *const before = (const void *)c->buffer[i].block;
        const unsigned char *const behind = (const void *)(c->buffer[i].block + GUARD + c->buffer[i].size);
        for (size_t k = 0; k < GUARD * sizeof(float); k++)
            if (before[k] != GUARD_BYTE || behind[k] != GUARD_BYTE)
                fail_msg("%s: level %d writes outside array %d, round %d", what, (int)c->level, i, c->round);
    }
}

static void compare(const subject *s, const call *expected, const call *c)
{
    for (int i = 0; i < c->n; i++) {
        const float *const a = expected->buffer[i].block + GUARD, *const b = c->buffer[i].block + GUARD;
        float largest = 0;
        for (size_t k = 0; k < c->buffer[i].size; k++)
            largest = fmaxf(largest, fabsf(a[k]));
        for (size_t k = 0; c->buffer[i].output && k < c->buffer[i].size; k++)
            if (!(s->exact ? same(a[k], b[k]) : c->kind != ORDINARY || close_enough(a[k], b[k], largest)))
                fail_msg("%s: array %d, number %zu of %zu is %a at level %d, expected %a; kind %d, round %d", s->name, i, k,
                         c->buffer[i].size, (double)b[k], (int)c->level, (double)a[k], (int)c->kind, c->round);
    }
}

static void drop(call *c)
{
    for (int i = 0; i < c->n; i++)
        adcgs_free(NULL, c->buffer[i].block);
}

static void check(const subject *s, kind k, int round)
{
    call portable = {.n = 0};
    for (adcgs_cpu_level level = ADCGS_CPU_SCALAR; level <= adcgs_cpu_best(); level++) {
        call c = {.level = level, .kind = k, .round = round, .state = 77 + (uint64_t)(100 * k + round)};
        s->run(&c);
        check_guards(&c, s->name);
        if (level == ADCGS_CPU_SCALAR) {
            portable = c;
            continue;
        }
        compare(s, &portable, &c);
        drop(&c);
    }
    drop(&portable);
}

static void test_subject(void **state)
{
    for (int k = 0; k < KINDS; k++)
        for (int round = 0; round < ROUNDS; round++)
            check(*state, (kind)k, round);
}

int main(void)
{
    struct CMUnitTest tests[ADCGS_COUNTOF(subjects)];
    for (size_t i = 0; i < ADCGS_COUNTOF(subjects); i++)
        tests[i] = (struct CMUnitTest){.name = subjects[i].name,
                                       .test_func = test_subject,
                                       .initial_state = (void *)(uintptr_t)&subjects[i]};
    return cmocka_run_group_tests_name("kernels", tests, NULL, NULL);
}

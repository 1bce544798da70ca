/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Elementary functions and the computation of splats, over the whole ranges of the specification's annex of bounds. Results are
 * finite, within these bounds and those of annex "Accuracy", and the same on every CPU level.
 */
#include "config.h"

#include "base/cpu_detect.h"
#include "base/fmath.h"
#include "base/strict.h"
#include "splat/quaternion.h"
#include "splat/splat_isa.h"
#include "ranges.h"

#include <float.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

enum { L = ADCGS_LANES, SAMPLES = ADCGS_STRICT_SAMPLES, ROUNDS = 6000 };

static const double PI = 3.14159265358979323846;

/* ---- Elementary functions ---- */

static double exact_sigmoid(double x)
{
    return 1 / (1 + exp(-x));
}

static double exact_sinpi(double x)
{
    return sin(PI * fmod(x, 2));
}

static double exact_cospi(double x)
{
    return cos(PI * fmod(x, 2));
}

static float sinpi(float x)
{
    float s, c;
    adcgs_sincospi(x, &s, &c);
    return s;
}

static float cospi(float x)
{
    float s, c;
    adcgs_sincospi(x, &s, &c);
    return c;
}

typedef struct function {
    const char *name;
    float (*computed)(float x);
    double (*exact)(double x);
    float low, high; /* its domain, or the part that is not clamped first */
    double places;   /* largest error, in places of the exact result's last digit; 0: not specified */
    double error;    /* largest error, relative or absolute as below */
    int relative;
    int falls; /* largest fall, in places, while the argument grows; -1: not specified */
} function;

/* The errors are those of annex "Accuracy", found with every number of these ranges. */
static const function functions[] = {
    {"exp", adcgs_exp, exp, -86, 88, 1.23, 1.03e-7, 1, 1},
    {"sigmoid", adcgs_sigmoid, exact_sigmoid, -32, 32, 2.49, 1.66e-7, 1, 2},
    {"log2", adcgs_log2, log2, 0x1.010102p-8f, 1, 2.65, 3.09e-7, 0, 0},
    {"sinpi", sinpi, exact_sinpi, 0, 0x1p20f, 0, 8.5e-8, 0, -1},
    {"cospi", cospi, exact_cospi, 0, 0x1p20f, 0, 8.5e-8, 0, -1},
    {"opacity_of", ranges_opacity_of, exp2, -0x1.ffa37cp+2f, -0x1p-7f, 54.1, 3.63e-6, 1, 1},
};

/* The index of a finite number in the order of all of them, and its inverse. */
static int64_t place_of(float x)
{
    const int64_t magnitude = adcgs_float_bits(x) & 0x7fffffff;
    return adcgs_float_bits(x) >> 31 ? -magnitude : magnitude;
}

static float at_place(int64_t place)
{
    return adcgs_bits_float(place < 0 ? (uint32_t)-place | 0x80000000u : (uint32_t)place);
}

/* One place of the last digit of a binary32 number near y. */
static double digit_of(double y)
{
    int exponent;
    frexp(y, &exponent);
    return ldexp(1, (exponent < -125 ? -125 : exponent) - 24);
}

static void check_value(const function *f, float x, float y)
{
    const double exact = f->exact(x), error = fabs(y - exact), places = error / digit_of(exact);
    if (!(error <= f->error * (f->relative ? fabs(exact) : 1)) || (f->places > 0 && places > f->places))
        fail_msg("%s(%a) is %a, expected %a, error %g or %g places", f->name, (double)x, (double)y, exact, error, places);
}

/* Numbers of the domain in order, `step` places apart. */
static void check_run(const function *f, int64_t from, int64_t to, int64_t step)
{
    int64_t before = INT64_MIN;
    for (int64_t i = from; i <= to; i += step) {
        const float x = at_place(i), y = f->computed(x);
        check_value(f, x, y);
        const int64_t place = place_of(y);
        if (f->falls >= 0 && before > place + f->falls)
            fail_msg("%s(%a) is %a, less than for the previous argument", f->name, (double)x, (double)y);
        before = place;
    }
}

/* Over the whole domain; at its ends and at random places of it, number by number. */
/* REQ-PRIM-001, REQ-PRIM-002, REQ-PRIM-003, REQ-PRIM-004, REQ-REND-007 */
static void test_functions(void **state)
{
    const char *const asked = getenv("ADCGS_FULL");
    const int full = asked && strcmp(asked, "1") == 0;
    uint64_t random = 41;
    (void)state;
    for (size_t n = 0; n < ADCGS_COUNTOF(functions); n++) {
        const function *const f = functions + n;
        const int64_t low = place_of(f->low), high = place_of(f->high);
        check_run(f, low, high, full ? 5 : 7919);
        check_run(f, low, low + 2000, 1);
        check_run(f, high - 2000, high, 1);
        for (int i = 0; i < 100; i++) {
            const int64_t from = place_of((float)ranges_between(&random, f->low, f->high));
            check_run(f, ADCGS_MAX(from - 300, low), ADCGS_MIN(from + 300, high), 1);
        }
    }
    for (float x = 0x1p-149f; x < INFINITY; x *= 1.7f) { /* arguments that are clamped first; results never leave their range */
        assert_true(adcgs_exp(x) >= 1 && adcgs_exp(x) <= 0x1p127f && adcgs_exp(-x) >= 0x1p-125f && adcgs_exp(-x) <= 1);
        assert_true(adcgs_sigmoid(x) >= 0.5f && adcgs_sigmoid(x) <= 1 && adcgs_sigmoid(-x) > 0 && adcgs_sigmoid(-x) <= 0.5f);
    }
}

static adcgs_strict_fn *strict_at(adcgs_cpu_level level)
{
#ifdef HAVE_AVX512
    if (level == ADCGS_CPU_AVX512)
        return adcgs_strict_avx512;
#endif
#ifdef HAVE_AVX2
    if (level == ADCGS_CPU_AVX2)
        return adcgs_strict_avx2;
#endif
    (void)level;
    return adcgs_strict_scalar;
}

/* The known-answer code takes any arguments: operations and functions are the same over all exponents, on every level. */
/* REQ-CONV-007, REQ-CONV-008, REQ-CONF-004 */
static void test_same_functions(void **state)
{
    static _Alignas(64) float expected[ADCGS_STRICT_FUNCTIONS][SAMPLES], got[ADCGS_STRICT_FUNCTIONS][SAMPLES];
    static _Alignas(64) float in[3][SAMPLES];
    uint64_t random = 42;
    (void)state;
    for (int round = 0; round < ROUNDS; round++) {
        const double low = round & 1 ? -149 : -30, high = round & 1 ? 60 : 20;
        for (int i = 0; i < 3 * SAMPLES; i++)
            in[i / SAMPLES][i % SAMPLES] = (float)ranges_signed(&random, low, high);
        for (int i = 0; i < SAMPLES; i++) /* divisors */
            in[1][i] = (float)ranges_size(&random, -126, 20);
        adcgs_strict_scalar(expected, in[0], in[1], in[2]);
        for (adcgs_cpu_level level = ADCGS_CPU_SCALAR; level <= adcgs_cpu_best(); level++) {
            strict_at(level)(got, in[0], in[1], in[2]);
            const size_t first = round & 1 ? 9 : 0; /* sines outside of their domain are not specified */
            assert_memory_equal(got[first], expected[first], (ADCGS_STRICT_FUNCTIONS - first) * sizeof got[0]);
            assert_memory_equal(got, expected, 7 * sizeof got[0]);
        }
    }
}

/* ---- The computation of splats ---- */

/* The inputs of a group of anchors: each anywhere in its range. */
typedef struct given {
    _Alignas(64) float sigma[11][L];
    float position[3][L], code[3][L], colour[3][L];
    float theta[14][L], omega[12][L], varpi[4][L];
    adcgs_body_lanes bodies;
    int32_t present[L], moves[L];
    float t;
    adcgs_movers movers;
    int octaves, with_bodies, with_fine;
} given;

/* The results. */
typedef struct made {
    _Alignas(64) adcgs_anchor_lanes anchor;
    adcgs_slot_lanes slot;
    adcgs_anchor_motion motion;
    float rows[ADCGS_ROWS * L];
    float code[6 * ADCGS_OCTAVES_MAX * L];
} made;

/* A position of an anchor or of a body's centre, and the place in the cube. */
static float draw_position(uint64_t *random)
{
    return (float)(ranges_chance(random, 0.5) ? ranges_size(random, -20, 32) : ranges_signed(random, -20, 15));
}

static float draw_place(uint64_t *random)
{
    const double from_a_side = ranges_size(random, -22, -1);
    return (float)(ranges_chance(random, 0.5) ? from_a_side : 1 - from_a_side);
}

static void draw_rows(float (*rows)[L], int n, double low, double high, uint64_t *random)
{
    for (int i = 0; i < n * L; i++)
        rows[i / L][i % L] = (float)ranges_signed(random, low, high);
}

/* A quaternion as `normalise` returns it, from components of independent sizes. */
static void draw_pose(adcgs_body_lanes *b, int l, uint64_t *random)
{
    float q[4], matrix[9];
    for (int c = 0; c < 4; c++)
        q[c] = fmaf((float)ranges_signed(random, -40, 10), 0x1p-4f, c == 0);
    const float n = adcgs_norm2(q[0], q[1], q[2], q[3]), root = sqrtf(n);
    for (int c = 0; c < 4; c++)
        b->q[c][l] = q[c] = adcgs_usable_norm(n) ? q[c] / root : (float)(c == 0);
    adcgs_rotation_matrix(matrix, q[0], q[1], q[2], q[3]);
    for (int c = 0; c < 9; c++)
        b->matrix[c][l] = matrix[c];
    for (int c = 0; c < 3; c++) {
        b->centre[c][l] = draw_position(random);
        b->place[c][l] = b->centre[c][l] + (float)ranges_signed(random, -44, 6);
    }
    b->has[l] = ranges_chance(random, 0.7);
}

static void draw(given *g, uint64_t *random)
{
    draw_rows(g->sigma, 11, -42, 27, random);
    draw_rows(g->colour, 3, -42, 27, random);
    draw_rows(g->theta, 14, -60, 92, random);
    draw_rows(g->omega, 12, -60, 91, random);
    draw_rows(g->varpi, 4, -60, 91, random);
    for (int l = 0; l < L; l++) {
        for (int c = 0; c < 3; c++) {
            g->position[c][l] = draw_position(random);
            g->code[c][l] = draw_place(random);
        }
        draw_pose(&g->bodies, l, random);
        g->present[l] = ranges_chance(random, 0.9);
        g->moves[l] = ranges_chance(random, 0.9);
    }
    g->t = (float)(ranges_chance(random, 0.5) ? ranges_between(random, 0, 1) : ranges_size(random, -60, 0));
    g->movers = (adcgs_movers){.coarse = ranges_chance(random, 0.7), .spans = ranges_chance(random, 0.5)};
    g->movers.rotation = g->movers.coarse && ranges_chance(random, 0.6);
    g->with_bodies = ranges_chance(random, 0.5);
    g->with_fine = ranges_chance(random, 0.7);
    g->octaves = 1 + (int)(scene_uniform(random) * ADCGS_OCTAVES_MAX * 0.999);
}

static void make(made *m, const given *g, adcgs_cpu_level level)
{
    adcgs_splat_dsp dsp;
    const adcgs_slot_out to = adcgs_rows_at(m->rows, L, 0);
    const adcgs_body_lanes *const bodies = g->with_bodies ? &g->bodies : NULL;
    memset(m, 0, sizeof *m);
    memcpy(m->anchor.position, g->position, sizeof g->position);
    memcpy(m->anchor.code, g->code, sizeof g->code);
    memcpy(m->anchor.colour, g->colour, sizeof g->colour);
    adcgs_splat_dsp_init(&dsp, level);
    dsp.anchor(&m->anchor, g->sigma[0], g->movers.spans);
    dsp.predict(&m->slot, &m->anchor, g->theta[0]);
    dsp.place(&to, &m->slot, &m->anchor, g->present);
    dsp.motion(&m->motion, &m->anchor, g->omega[0], &g->movers, bodies, g->t);
    dsp.deform(&to, &m->slot, &m->motion, &g->movers, bodies, g->with_fine ? g->varpi[0] : NULL, g->present, g->moves);
    dsp.position_code(m->code, g->code[0], g->octaves);
}

/* Checks magnitudes of n numbers; NaN is in no range. */
static void within(const char *what, const float *x, size_t n, double least, double most)
{
    for (size_t i = 0; i < n; i++)
        if (!(fabsf(x[i]) >= least && fabsf(x[i]) <= most))
            fail_msg("%s: %a, expected %a to %a", what, (double)x[i], least, most);
}

/* The ranges of annex "Numerical bounds". */
static void check_inside(const made *m, const given *g)
{
    within("rest.offset", m->slot.offset[0], sizeof m->slot.offset / sizeof(float), 0, 0x1p104);
    within("rest.scale", m->slot.scale[0], sizeof m->slot.scale / sizeof(float), 0x1p-70, 0x1p14);
    within("rest.colour", m->slot.colour[0], sizeof m->slot.colour / sizeof(float), 0, 0x1p92);
    within("moved.logit", m->slot.logit, L, 0, 0x1p93);
    within("body.position", m->motion.position[0], sizeof m->motion.position / sizeof(float), 0, 0x1p94);
    if (g->movers.spans)
        within("life.presence", m->motion.presence, L, 0x1p-125, 1);
    within("position code", m->code, (size_t)(6 * g->octaves) * L, 0, 1);
    within("mean", m->rows + ADCGS_ROW_MEAN * L, 3 * L, 0, 0x1p15);
    within("scale", m->rows + ADCGS_ROW_SCALE * L, 3 * L, 0x1p-20, 0x1p10);
    within("opacity", m->rows + ADCGS_ROW_OPACITY * L, L, 0, 0x1.fae148p-1);
    within("colour", m->rows + ADCGS_ROW_COLOUR * L, 3 * L, 0, 0x1p8);
    for (int l = 0; l < 4 * L; l++)
        assert_true(m->rows[ADCGS_ROW_SCALE * L + l % (3 * L)] > 0 && m->rows[ADCGS_ROW_OPACITY * L + l % L] >= 0);
}

/* Quaternions have length 1 after up to three rotations in a row without normalisation in between: annex "Accuracy". */
static double farthest;
static void check_lengths(const made *m)
{
    for (int l = 0; l < L; l++) {
        double n = 0;
        for (int c = 0; c < 4; c++)
            n += pow(m->rows[(ADCGS_ROW_ROTATION + c) * L + l], 2);
        farthest = fmax(farthest, fabs(sqrt(n) - 1));
        if (!(fabs(sqrt(n) - 1) <= 2.5e-7))
            fail_msg("quaternion of length %.9g, expected 1", sqrt(n));
    }
}

/* REQ-PRIM-005, REQ-PRIM-010, REQ-PRIM-015, REQ-PRIM-017, REQ-PRIM-024, REQ-PRIM-025, REQ-BNDS-001, REQ-CONF-004 */
static void test_splats(void **state)
{
    static given g;
    static made expected, got;
    uint64_t random = 43;
    (void)state;
    for (int round = 0; round < ROUNDS; round++) {
        draw(&g, &random);
        make(&expected, &g, ADCGS_CPU_SCALAR);
        check_inside(&expected, &g);
        check_lengths(&expected);
        for (adcgs_cpu_level level = ADCGS_CPU_SCALAR + 1; level <= adcgs_cpu_best(); level++) {
            make(&got, &g, level);
            if (memcmp(&got, &expected, sizeof got) != 0)
                fail_msg("round %d: splats of level %d differ", round, (int)level);
        }
    }
    print_message("largest error of a quaternion's length: %g\n", farthest);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_functions),
        cmocka_unit_test(test_same_functions),
        cmocka_unit_test(test_splats),
    };
    return cmocka_run_group_tests_name("ranges", tests, NULL, NULL);
}

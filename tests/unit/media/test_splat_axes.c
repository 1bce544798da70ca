/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The axes and the offset of written splats, in every format. */
#include "outside_files.h"

#include "random_splats.h"

#include "media/splats/offset.h"

#include <math.h>

static const char *const names[] = {"a.ply", "a.spz", "a.glb", "a.sog"};

#define NAMES (sizeof names / sizeof *names)

/** The up direction of axes. */
static void up_of(double up[3], int axes)
{
    static const double ups[4][3] = {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, 0}};
    memcpy(up, ups[axes], sizeof ups[axes]);
}

/** The rotation about x that turns one up direction to the other, from their angles. */
static void turn(double p[3], int from, int to)
{
    double a[3], b[3];
    up_of(a, from);
    up_of(b, to);
    const double angle = atan2(b[2], b[1]) - atan2(a[2], a[1]), y = p[1], z = p[2];
    p[1] = cos(angle) * y - sin(angle) * z;
    p[2] = sin(angle) * y + cos(angle) * z;
}

/** The index of the splat that is nearest to a place; SOG changes their order. */
static uint32_t nearest(const adcgs_splats *s, const double place[3])
{
    uint32_t found = 0;
    double least = INFINITY;
    for (uint32_t i = 0; i < s->n; i++) {
        double sum = 0.0;
        for (int a = 0; a < 3; a++)
            sum += ((double)s->mean[a][i] - place[a]) * ((double)s->mean[a][i] - place[a]);
        if (sum < least) {
            least = sum;
            found = i;
        }
    }
    return found;
}

/** Expects the tips of all axes of ellipsoids at their turned places. */
static void expect_turned(const adcgs_splats *back, const adcgs_splats *s, int from, int to)
{
    assert_int_equal(back->n, s->n);
    for (uint32_t i = 0; i < s->n; i++) {
        double place[3] = {(double)s->mean[0][i], (double)s->mean[1][i], (double)s->mean[2][i]};
        turn(place, from, to);
        const uint32_t k = nearest(back, place);
        for (int axis = 0; axis < 3; axis++) {
            double was[3], is[3], ahead = 0.0, behind = 0.0;
            tip(was, s, i, axis);
            tip(is, back, k, axis);
            turn(was, from, to);
            for (int a = 0; a < 3; a++) { /* SOG and SPZ store a rotation, or its equal after a half turn */
                ahead = fmax(ahead, fabs(is[a] - was[a]));
                behind = fmax(behind, fabs(2.0 * (double)back->mean[a][k] - is[a] - was[a]));
            }
            assert_true(fmin(ahead, behind) < 0.01);
        }
    }
}

/** 0 if this build lacks the format. */
static int write_as(const adcgs_splats *s, const adcgs_splats_style *style, const char *name)
{
    const adcgs_status status = adcgs_splats_write(s, style, in(name), &error);
    if (status == ADCGS_ERR_UNSUPPORTED && strstr(error.text, "this build has no"))
        return 0;
    expect_good(status);
    return 1;
}

static void test_axes(void **state)
{
    static const uint8_t usual[NAMES] = {ADCGS_SPLATS_Y_DOWN, ADCGS_SPLATS_Y_UP, ADCGS_SPLATS_Y_UP, ADCGS_SPLATS_Y_DOWN};
    adcgs_splats s = random_splats(40, 1.0, 0.0, 21), back;
    for (size_t k = 0; k < NAMES; k++)
        for (uint8_t from = ADCGS_SPLATS_UP_UNKNOWN; from <= ADCGS_SPLATS_Y_DOWN; from++)
            for (uint8_t wanted = 0; wanted <= ADCGS_SPLATS_KEEP; wanted++) {
                const adcgs_splats_style style = {.comment = "here", .axes = wanted};
                const uint8_t to = !from || wanted == ADCGS_SPLATS_KEEP ? from : wanted ? wanted : usual[k];
                assert_int_equal(adcgs_splats_axes_for(names[k], &style, from), to);
                s.axes = from;
                if (!write_as(&s, &style, names[k]))
                    continue;
                expect_good(adcgs_splats_read(&back, in(names[k]), &error));
                expect_turned(&back, &s, from, to);
                adcgs_splats_free(&back);
            }
    adcgs_splats_free(&s);
}

#define CORNERS 8u /* of a cube; definition */

/** A cube of two metres in earth-centred coordinates, as a decoder's primitives of scale 1. */
static adcgs_splats make_cube(void)
{
    adcgs_splats cube = random_splats(CORNERS, 0.5, 0.0, 8);
    for (uint32_t i = 0; i < CORNERS; i++)
        for (int a = 0; a < 3; a++)
            cube.mean[a][i] = i >> a & 1 ? 1.0f : -1.0f;
    return cube;
}

/** The greatest error of a distance between two splats; the files keep the order, except for SOG. */
static double shape_error(const adcgs_splats *back, const adcgs_splats *cube)
{
    double worst = 0.0;
    for (uint32_t i = 0; i < CORNERS; i++) {
        double place[3], sum = 0.0;
        for (int a = 0; a < 3; a++)
            place[a] = (double)cube->mean[a][i];
        const uint32_t k = nearest(back, place);
        for (int a = 0; a < 3; a++)
            sum += ((double)back->mean[a][k] - place[a]) * ((double)back->mean[a][k] - place[a]);
        worst = fmax(worst, sqrt(sum));
    }
    return worst;
}

/** With its offset, also one that the user gives, a far cube keeps its shape in every format; without, none keeps it. */
static void test_cube(void **state)
{
    static const double origin[3] = {4510731.25, -1512345.5, 4260123.125}, given[3] = {4510730.0, -1512345.0, 4260123.0};
    static const double none[3] = {0, 0, 0};
    const double *const offsets[] = {NULL, given, none};
    adcgs_splats cube = make_cube(), s, back;
    adcgs_primitives p;
    adcgs_splats_primitives(&cube, &p);
    p.n = CORNERS;
    for (size_t o = 0; o < 3; o++)
        for (size_t k = 0; k < NAMES; k++) {
            expect_good(adcgs_splats_take(&s, &p, origin, 1.0, offsets[o], "far", &error));
            double automatic[3];
            adcgs_offset_of(automatic, origin, 1.0);
            const double *const expected = offsets[o] ? offsets[o] : automatic;
            if (write_as(&s, &(adcgs_splats_style){.comment = "here", .axes = ADCGS_SPLATS_KEEP}, names[k])) {
                expect_good(adcgs_splats_read(&back, in(names[k]), &error));
                assert_int_equal(back.n, CORNERS);
                for (uint32_t i = 0; i < CORNERS; i++)
                    for (int a = 0; a < 3; a++)
                        back.mean[a][i] = (float)((double)back.mean[a][i] - (origin[a] - expected[a]));
                const int stores = k == 0 || k == 2;
                for (int a = 0; a < 3 && o < 2; a++)
                    assert_true(back.offset[a] == (stores ? expected[a] : 0.0));
                const double wrong = shape_error(&back, &cube);
                if (o < 2 ? wrong > 1e-4 : wrong < 0.1)
                    fail_msg("%s with offset %zu: the shape is %g off", names[k], o, wrong);
                adcgs_splats_free(&back);
            }
            adcgs_splats_free(&s);
        }
    adcgs_splats_free(&cube);
}

/** The offset that PLY and GLB store is turned with the splats. */
static void test_turned_offset(void **state)
{
    adcgs_splats s = random_splats(10, 1.0, 0.0, 21), back;
    s.axes = ADCGS_SPLATS_Z_UP;
    s.offset[0] = 1000000.5;
    s.offset[1] = -2000000.25;
    s.offset[2] = 3000000.75;
    expect_good(write_splats(&s, in("o.ply")));
    expect_good(adcgs_splats_read(&back, in("o.ply"), &error));
    assert_true(back.offset[0] == 1000000.5 && back.offset[1] == -3000000.75 && back.offset[2] == -2000000.25);
    adcgs_splats_free(&back);
    if (write_as(&s, &(adcgs_splats_style){.comment = "here"}, "o.glb")) {
        expect_good(adcgs_splats_read(&back, in("o.glb"), &error));
        assert_true(back.offset[0] == 1000000.5 && back.offset[1] == 3000000.75 && back.offset[2] == 2000000.25);
        adcgs_splats_free(&back);
    }
    adcgs_splats_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_axes),
        cmocka_unit_test(test_cube),
        cmocka_unit_test(test_turned_offset),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

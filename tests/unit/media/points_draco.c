/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Point clouds in Draco, and real files. */
#include "outside_files.h"
#include "second_sources.h"

#include "media/points/points.h"

#include <math.h>

/** Four points (i, -2i, 0.5) with colours (10i, 200, 255-i), as Draco 1.5 writes them; then every cut of the file. */
static void test_draco(void **state)
{
    static const uint8_t file[] = {
        0x44, 0x52, 0x41, 0x43, 0x4f, 0x02, 0x03, 0x00, 0x00, 0x00, 0x00, 0x04, 0x00, 0x00, 0x00, 0x01, 0x02, 0x00,
        0x09, 0x03, 0x00, 0x00, 0x02, 0x02, 0x03, 0x00, 0x01, 0x00, 0x01, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,
        0x80, 0x00, 0x00, 0x00, 0x3f, 0x00, 0x00, 0x80, 0x3f, 0x00, 0x00, 0x00, 0xc0, 0x00, 0x00, 0x00, 0x3f, 0x00,
        0x00, 0x00, 0x40, 0x00, 0x00, 0x80, 0xc0, 0x00, 0x00, 0x00, 0x3f, 0x00, 0x00, 0x40, 0x40, 0x00, 0x00, 0xc0,
        0xc0, 0x00, 0x00, 0x00, 0x3f, 0x00, 0x01, 0x01, 0x01, 0x02, 0x70, 0x55, 0x15, 0x59, 0x15, 0x47, 0x01, 0x10,
        0xff, 0x67, 0x55, 0x05, 0x05, 0x96, 0xc2, 0x7f, 0xc4, 0x90, 0x00, 0x00, 0x00, 0x00, 0xff, 0x00, 0x00, 0x00,
    };
    adcgs_points points;
    assert_int_equal(adcgs_draco_parse(&points, file, sizeof file, "d.drc", &error), ADCGS_OK);
    assert_int_equal(points.n, 4);
    assert_int_equal(points.coloured, 1);
    for (int i = 0; i < 4; i++) {
        const double *p = points.position[i];
        assert_true(p[0] == i && p[1] == -2.0 * i && p[2] == 0.5);
        assert_true(points.colour[i][0] == 10 * i && points.colour[i][1] == 200 && points.colour[i][2] == 255 - i);
    }
    adcgs_points_free(&points);
    for (size_t cut = 0; cut < sizeof file - 4; cut++) {
        put_bytes("d.drc", file, cut);
        expect_error(adcgs_points_read(&points, in("d.drc"), &error), ADCGS_ERR_DATA, "d.drc", "");
    }
}

/** Points are read back in their order, off by at most half a step of 16 bits of the longest edge; colours are exact. */
static void expect_draco_round_trip(const adcgs_points *points)
{
    adcgs_points back;
    assert_int_equal(adcgs_draco_write(points, in("w.drc"), &error), ADCGS_OK);
    assert_int_equal(adcgs_points_read(&back, in("w.drc"), &error), ADCGS_OK);
    double longest = 0.0, farthest = 0.0, bound;
    for (int a = 0; a < 3; a++) {
        double low = INFINITY, high = -INFINITY;
        for (uint32_t i = 0; i < points->n; i++) {
            low = fmin(low, points->position[i][a]);
            high = fmax(high, points->position[i][a]);
        }
        longest = fmax(longest, high - low);
        farthest = fmax(farthest, fmax(-low, high));
    }
    bound = 0.5 * longest / 65535.0 + 0x1p-23 * farthest + 0x1p-22 * longest; /* and the rounding of binary32 */
    assert_int_equal(back.n, points->n);
    assert_int_equal(back.coloured, points->coloured);
    for (uint32_t i = 0; i < points->n; i++)
        for (int a = 0; a < 3; a++) {
            const double off = fabs(back.position[i][a] - points->position[i][a]);
            if (!(off <= bound))
                fail_msg("point %u: off by %g, bound %g", i, off, bound);
        }
    assert_memory_equal(back.colour, points->colour, points->n * sizeof *points->colour);
    adcgs_points_free(&back);
}

static size_t load_file(const char *name, uint8_t *bytes, size_t most)
{
    FILE *file = fopen(in(name), "rb");
    assert_non_null(file);
    const size_t n = fread(bytes, 1, most, file);
    fclose(file);
    return n;
}

static void test_draco_writing(void **state)
{
    static uint8_t first[32768], second[32768];
    adcgs_points points;
    assert_int_equal(adcgs_points_alloc(&points, 1000, "points", &error), ADCGS_OK);
    for (uint32_t i = 0; i < points.n; i++)
        for (int a = 0; a < 3; a++) {
            points.position[i][a] = (double)(100.0f + (float)(i * 7919 % 1000) / (float)(a + 1));
            points.colour[i][a] = (uint8_t)(i * 7 + (uint32_t)a);
        }
    memcpy(points.position[999], points.position[3], sizeof *points.position); /* equal points are not merged */
    memcpy(points.colour[999], points.colour[3], sizeof *points.colour);
    points.coloured = 1;
    expect_draco_round_trip(&points);
    const size_t n = load_file("w.drc", first, sizeof first);
    assert_true(n > 100 && n < sizeof first);
    assert_int_equal(adcgs_points_write(&points, (const double[3]){0}, in("again.DRC"), &error), ADCGS_OK);
    assert_int_equal(load_file("again.DRC", second, sizeof second), n);
    assert_memory_equal(first, second, n);
    memset(points.colour, 128, points.n * sizeof *points.colour);
    points.coloured = 0;
    expect_draco_round_trip(&points);
    points.n = 1;
    expect_draco_round_trip(&points);
    points.n = 0;
    expect_error(adcgs_draco_write(&points, in("none.drc"), &error), ADCGS_ERR_UNSUPPORTED, "none.drc", "at least one point");
    points.n = 1;
    expect_error(adcgs_draco_write(&points, in("no/w.drc"), &error), ADCGS_ERR_IO, "no/w.drc", "No such");
    expect_error(adcgs_points_write(&points, (const double[3]){0}, in("w.xyz"), &error), ADCGS_ERR_USAGE, "w.xyz",
                 ".ply or .drc");
    assert_true(access(in("none.drc"), F_OK) != 0 && access(in("w.xyz"), F_OK) != 0);
    adcgs_points_free(&points);
}

static void test_real_files(void **state)
{
    static const struct {
        const char *name;
        uint32_t n;
    } files[] = {{"pointclouds/bun_zipper.ply", 35947},
                 {"pointclouds/garden_points.ply", 138766},
                 {"zju313_15f/points3d.ply", 1313}};
    const char *data = real_data(".");
    for (size_t i = 0; i < ADCGS_COUNTOF(files); i++) {
        char path[1024];
        adcgs_points points;
        snprintf(path, sizeof path, "%s/%s", data, files[i].name);
        assert_int_equal(adcgs_points_read(&points, path, &error), ADCGS_OK);
        assert_int_equal(points.n, files[i].n);
        expect_draco_round_trip(&points);
        adcgs_points_free(&points);
    }
}

int adcgs_test_points_draco(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_draco),
        cmocka_unit_test(test_real_files),
        cmocka_unit_test(test_draco_writing),
    };
    return cmocka_run_group_tests_name("points draco", tests, make_folder, remove_folder);
}

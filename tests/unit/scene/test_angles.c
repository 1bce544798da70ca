/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Triangulation angles of points in a sparse model. */
#include "outside_files.h"

#include "scene/layouts/colmap_model.h"

#include <math.h>

/** A camera on a circle of radius 5 around the origin in the plane of x and z, at an angle in degrees. */
static adcgs_colmap_centre on_circle(uint32_t id, double degrees)
{
    const double a = degrees / 57.29577951308232;
    return (adcgs_colmap_centre){id, {5.0 * sin(a), 0.0, -5.0 * cos(a)}};
}

static void start(adcgs_colmap_angles *angles, const double *degrees, size_t n)
{
    adcgs_colmap_centre *centre = malloc(n * sizeof *centre);
    assert_non_null(centre);
    for (size_t i = 0; i < n; i++)
        centre[i] = on_circle((uint32_t)(1000 - i), degrees[i]);
    adcgs_colmap_angles_init(angles, centre, n);
}

/** The largest angle of a point does not depend on the order of its images. Images without a pose and single ones give none. */
static void test_largest(void **state)
{
    static const double degrees[] = {10, -20, 0, 0.5, 15};
    static const uint32_t orders[][5] = {{1000, 999, 998, 997, 996}, {998, 997, 7, 999, 996}, {996, 998, 999, 999, 1000}};
    static const double zero[3] = {0, 0, 0};
    for (size_t o = 0; o < ADCGS_COUNTOF(orders); o++) {
        adcgs_colmap_angles angles;
        start(&angles, degrees, ADCGS_COUNTOF(degrees));
        for (int i = 0; i < 5; i++)
            adcgs_colmap_angles_see(&angles, zero, orders[o][i]);
        adcgs_colmap_angles_end_point(&angles);
        adcgs_colmap_angles_see(&angles, zero, 998);
        adcgs_colmap_angles_end_point(&angles);
        adcgs_colmap_angles_end_point(&angles);
        assert_int_equal(angles.n, 1);
        assert_true(fabs(adcgs_colmap_angles_median(&angles) - 35.0) < 1e-9);
        adcgs_colmap_angles_clear(&angles);
    }
}

static void test_median(void **state)
{
    static const double degrees[] = {0, 0.001, 3, 40, 180};
    static const double zero[3] = {0, 0, 0}, wrong[3] = {NAN, 0, 0};
    adcgs_colmap_angles angles;
    start(&angles, degrees, ADCGS_COUNTOF(degrees));
    assert_true(adcgs_colmap_angles_median(&angles) == 0.0);
    for (uint32_t i = 0; i < 300; i++) { /* more than there is room for at first */
        adcgs_colmap_angles_see(&angles, zero, 1000);
        adcgs_colmap_angles_see(&angles, i == 0 ? wrong : zero, i < 140 ? 999 : i < 151 ? 998 : 996);
        adcgs_colmap_angles_end_point(&angles);
    }
    assert_int_equal(angles.n, 299);
    assert_true(fabs(adcgs_colmap_angles_median(&angles) - 3.0) < 1e-9);
    adcgs_colmap_angles_clear(&angles);
    start(&angles, degrees, ADCGS_COUNTOF(degrees));
    adcgs_colmap_angles_see(&angles, zero, 1000);
    adcgs_colmap_angles_see(&angles, zero, 996);
    adcgs_colmap_angles_end_point(&angles);
    assert_true(fabs(adcgs_colmap_angles_median(&angles) - 180.0) < 1e-6);
    adcgs_colmap_angles_clear(&angles);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_largest),
        cmocka_unit_test(test_median),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

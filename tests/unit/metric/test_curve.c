/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Rate-distortion curves against values calculated by hand. Sizes are logarithms to base 2: their means are easy. */
#include "metric/curve.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

static void curve(adcgs_curve_point *out, const double (*at)[2], int n)
{
    for (int i = 0; i < n; i++)
        out[i] = (adcgs_curve_point){.bytes = exp2(at[i][1]), .quality = at[i][0]};
}

static double difference(const double (*reference)[2], int n_reference, const double (*test)[2], int n_test)
{
    adcgs_curve_point r[ADCGS_CURVE_MAX], t[ADCGS_CURVE_MAX];
    adcgs_error error;
    double percent = NAN;
    curve(r, reference, n_reference);
    curve(t, test, n_test);
    if (adcgs_bd_rate(r, n_reference, t, n_test, &percent, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    return percent;
}

static void assert_log2(double percent, double mean)
{
    if (fabs(percent - 100 * (exp2(mean) - 1)) > 1e-9)
        fail_msg("%.12f %%, expected %.12f %%", percent, 100 * (exp2(mean) - 1));
}

static void test_bd_rate(void **state)
{
    static const double level[][2] = {{30, 0}, {31, 0}, {33, 0}, {34, 0}};
    static const double line[][2] = {{33, 3}, {30, 0}, {32, 2}, {31, 1}}; /* in any order */
    static const double half[][2] = {{30, -1}, {31, 0}, {32, 1}, {33, 2}};
    /* Slopes of the pieces 1, 2, 4; at the knots 1/2, 4/3, 8/3, 5; integral 15/2 - (5/6 + 4/3 + 7/3) / 12 = 57/8. */
    static const double steep[][2] = {{30, 0}, {31, 1}, {32, 3}, {33, 7}};
    /* Pieces of width 1, 2, 1 and slopes 1, 1/2, 2; at the knots 7/6, 9/13, 6/7, 5/2. */
    static const double uneven[][2] = {{30, 0}, {31, 1}, {33, 2}, {34, 4}};
    /* Slopes 1, -10, 0: level between opposite pieces, at most three times the first piece at the end. */
    static const double bent[][2] = {{30, 0}, {31, 1}, {32, -9}, {33, -9}};
    static const double two[][2] = {{30, 0}, {31, 1}}, later[][2] = {{30.5, 0}, {31.5, 1}};
    static const double three[][2] = {{30, 0}, {31, 1}, {33, 9}};
    assert_log2(difference(line, 4, line, 4), 0);
    assert_log2(difference(line, 4, half, 4), -1);
    assert_log2(difference(half, 4, line, 4), 1);
    assert_log2(difference(line, 4, steep, 4), 57.0 / 8 / 3 - 1.5);
    assert_log2(difference(level, 4, uneven, 4), (6.5 + (7.0 / 6 + 27.0 / 13 - 18.0 / 7 - 5.0 / 2) / 12) / 4);
    assert_log2(difference(level, 4, bent, 4), (0.75 - 4 - 9) / 3);
    assert_log2(difference(two, 2, later, 2), -0.5);             /* from 30.5 to 31 */
    assert_log2(difference(level, 4, three, 3), (0.5 + 10) / 3); /* fewer than four points: lines */
    assert_log2(difference(line, 4, later, 2), -0.5);
}

static void test_bd_rate_refuses(void **state)
{
    adcgs_curve_point good[] = {{100, 30}, {200, 31}}, same[] = {{100, 30}, {200, 30}}, bad[] = {{100, 30}, {0, 31}};
    adcgs_curve_point lost[] = {{100, 30}, {200, NAN}}, above[] = {{100, 31}, {200, 32}};
    adcgs_error error;
    double percent;
    assert_int_equal(adcgs_bd_rate(good, 2, good, 1, &percent, &error), ADCGS_ERR_DATA);
    assert_int_equal(adcgs_bd_rate(good, 0, good, 2, &percent, &error), ADCGS_ERR_DATA);
    assert_int_equal(adcgs_bd_rate(good, 2, same, 2, &percent, &error), ADCGS_ERR_DATA);
    assert_int_equal(adcgs_bd_rate(bad, 2, good, 2, &percent, &error), ADCGS_ERR_DATA);
    assert_int_equal(adcgs_bd_rate(good, 2, lost, 2, &percent, &error), ADCGS_ERR_DATA);
    assert_int_equal(adcgs_bd_rate(good, 2, above, 2, &percent, &error), ADCGS_ERR_DATA);
    assert_non_null(strstr(error.text, "in common"));
}

static void test_curves(void **state)
{
    const adcgs_curve_point rising[] = {{400, 32}, {100, 30}, {200, 31}}, falling[] = {{100, 30}, {400, 29}};
    const adcgs_curve_point flat[] = {{100, 30}, {200, 30}}, level[] = {{100, 30}, {100, 31}};
    assert_true(isnan(adcgs_curve_quality(rising, 3, 99)));
    assert_true(isnan(adcgs_curve_quality(rising, 0, 99)));
    assert_true(adcgs_curve_quality(rising, 3, 100) == 30);
    assert_true(fabs(adcgs_curve_quality(rising, 3, 100 * sqrt(2)) - 30.5) < 1e-12);
    assert_true(adcgs_curve_quality(rising, 3, 1e6) == 32);
    assert_true(adcgs_curve_quality(falling, 2, 300) == 30);
    assert_true(adcgs_curve_is_monotone(rising, 3));
    assert_false(adcgs_curve_is_monotone(rising, 1));
    assert_false(adcgs_curve_is_monotone(falling, 2));
    assert_false(adcgs_curve_is_monotone(flat, 2));
    assert_false(adcgs_curve_is_monotone(level, 2));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_bd_rate), cmocka_unit_test(test_bd_rate_refuses),
                                       cmocka_unit_test(test_curves)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

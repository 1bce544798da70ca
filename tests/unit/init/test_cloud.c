/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Points in cells: the nearest one equals that of an exhaustive search for any cells. Points of a body are ignored. */
#include "config.h" /* for the declarations that it enables in system headers */

#include "grad/random.h"
#include "init/cloud.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

enum { POINTS = 700, QUERIES = 400 };

static adcgs_stereo_point point[POINTS];
static uint64_t thrown;
static adcgs_error error;

static double random_in(double low, double high)
{
    return low + (high - low) * adcgs_random_unit(7, 0, thrown++);
}

/** Points in clusters, some of them at the same place, some of them in a body. */
static int make_points(void **state)
{
    for (uint32_t i = 0; i < POINTS; i++) {
        const double spread = i % 3 ? 0.05 : 1;
        for (int a = 0; a < 3; a++) {
            point[i].x[a] = i % 20 == 19 ? point[i - 1].x[a] : random_in(-spread, spread);
            point[i].rgb[a] = (float)random_in(0, 1);
        }
        point[i].body = i % 7 == 0;
    }
    return 0;
}

/** Of every stride'th point: squared distance with colours, negative if there is none. */
static double nearest_of_all(uint32_t stride, const double x[3], const float rgb[3], double reach, double tint)
{
    double least = -1;
    for (uint32_t i = 0; i < POINTS; i += stride) {
        double far = 0, off = 0;
        for (int a = 0; a < 3; a++) {
            far += pow(x[a] - point[i].x[a], 2);
            off += pow(tint * (double)(rgb[a] - point[i].rgb[a]), 2);
        }
        if (far <= reach * reach && !point[i].body && (least < 0 || far + off < least))
            least = far + off;
    }
    return least;
}

static void nearest_is_that_of_all(void **state)
{
    static const struct {
        double edge, reach, tint;
        uint32_t stride;
    } try[] = {
        {0.02, 0.1, 0.3, 1}, {0.1, 0.02, 0.3, 1}, {0.1, 0.3, 0, 3}, {3, 0.5, 1, 1}, {0.01, 0.2, 0.01, 5},
    };
    int met = 0;
    for (size_t k = 0; k < ADCGS_COUNTOF(try); k++) {
        adcgs_cloud cloud;
        assert_int_equal(adcgs_cloud_init(&cloud, point, POINTS, try[k].stride, try[k].edge, &error), ADCGS_OK);
        for (int q = 0; q < QUERIES; q++) {
            const double spread = q % 2 ? 0.06 : 1.1;
            double x[3];
            float rgb[3];
            uint32_t found = POINTS;
            for (int a = 0; a < 3; a++) {
                x[a] = random_in(-spread, spread);
                rgb[a] = (float)random_in(0, 1);
            }
            const double all = nearest_of_all(try[k].stride, x, rgb, try[k].reach, try[k].tint);
            const double here = adcgs_cloud_nearest(&cloud, x, rgb, try[k].reach, try[k].tint, &found);
            assert_true(all < 0 ? here < 0 && found == POINTS : fabs(here - all) <= 1e-12 * all);
            if (all < 0)
                continue;
            met++;
            assert_true(found < POINTS && found % try[k].stride == 0 && !point[found].body);
        }
        adcgs_cloud_clear(&cloud);
    }
    print_message("%d of %d queries found a point\n", met, (int)ADCGS_COUNTOF(try) * QUERIES);
    assert_true(met > QUERIES);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(nearest_is_that_of_all)};
    return cmocka_run_group_tests(tests, make_points, NULL);
}

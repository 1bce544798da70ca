/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Spacing of anchors: equal to an exhaustive search for any arrangement. */
#include "config.h" /* for the declarations that it enables in system headers */

#include "geom/geom.h"
#include "grad/random.h"
#include "train/density/spacing.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

enum { MOST = 900 };

static adcgs_error error;

static double spacing_of_all(const uint32_t (*pos)[3], uint32_t n, uint32_t i)
{
    double best[3] = {INFINITY, INFINITY, INFINITY}, sum = 0;
    for (uint32_t j = 0; j < n; j++) {
        double d = 0;
        for (int a = 0; a < 3; a++)
            d += pow((double)pos[i][a] - (double)pos[j][a], 2);
        for (int a = 0; a < 3 && j != i; a++)
            if (d < best[a]) {
                const double swap = best[a];
                best[a] = d;
                d = swap;
            }
    }
    for (uint32_t a = 0; a < 3 && a + 1 < n; a++)
        sum += sqrt(best[a]);
    return n > 1 ? sum / fmin(3, n - 1) : 0;
}

/** Sorts into Morton order and removes duplicates. \return the remaining number. */
static uint32_t settle(uint32_t (*pos)[3], uint32_t n)
{
    uint32_t order[MOST], left = 0;
    assert_true(adcgs_morton_sort(&pos[0][0], n, order, &error) >= 0);
    for (uint32_t i = 0; i < n; i++)
        if (!left || memcmp(pos[left - 1], pos[i], sizeof pos[i]) != 0)
            memmove(pos[left++], pos[i], sizeof pos[i]);
    return left;
}

static void spacing_is_that_of_all(void **state)
{
    static const struct {
        uint32_t n;
        int depth, clusters;
    } try[] = {
        {1, 5, 0},    {2, 21, 0},    {3, 4, 0},     {4, 21, 0},     {5, 2, 0},
        {MOST, 3, 0}, {MOST, 12, 0}, {MOST, 21, 0}, {MOST, 16, 20}, {MOST, 21, 7},
    };
    uint64_t thrown = 0;
    (void)state;
    for (size_t k = 0; k < ADCGS_COUNTOF(try); k++) {
        uint32_t pos[MOST][3];
        double mean[MOST];
        const uint32_t most = (1u << try[k].depth) - 1;
        for (uint32_t i = 0; i < try[k].n; i++)
            for (int a = 0; a < 3; a++) {
                pos[i][a] = (uint32_t)(adcgs_random_unit(3, 0, thrown++) * most);
                if (i >= 20 && try[k].clusters) { /* about one of the first, or at a corner of all */
                    const uint32_t at = i % 50 ? pos[i % (uint32_t)try[k].clusters][a] : i % 100 ? most : 0;
                    pos[i][a] = ADCGS_MIN(at + pos[i][a] % 9, most);
                }
            }
        const uint32_t n = settle(pos, try[k].n);
        assert_int_equal(adcgs_spacings((const uint32_t(*)[3])pos, n, mean, &error), ADCGS_OK);
        for (uint32_t i = 0; i < n; i++)
            assert_true(memcmp(&mean[i], &(double){spacing_of_all((const uint32_t(*)[3])pos, n, i)}, sizeof *mean) == 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(spacing_is_that_of_all)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

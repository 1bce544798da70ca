/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Directions from which splats are looked at: all around an object, and the filmed side of a stage. */
#include "outside_files.h"

#include "scene/layouts/splat_aims.h"

#include <math.h>

static void put(adcgs_splats *s, uint32_t i, const double x[3], float scale)
{
    for (int a = 0; a < 3; a++) {
        s->mean[a][i] = (float)x[a];
        s->scale[a][i] = scale;
        s->colour[a][i] = 0.5f;
    }
    s->opacity[i] = 0.9f;
}

/** A ball of 600 fine splats in a shell of n large ones, which is open in the direction of -z. */
static adcgs_splat_scene *make(uint32_t n)
{
    adcgs_splat_scene *const scene = adcgs_splat_scene_create();
    assert_non_null(scene);
    scene->radius = 1.0;
    assert_int_equal(adcgs_splats_alloc(&scene->splats, 600 + n, "made", &error), ADCGS_OK);
    for (uint32_t i = 0; i < 600; i++) {
        double out[3];
        adcgs_splat_aims_spread(out, i, 600, 0.0);
        put(&scene->splats, i, out, 0.03f);
    }
    for (uint32_t i = 0; i < n; i++) {
        double x[3];
        adcgs_splat_aims_spread(x, i, n, 0.0);
        for (int a = 0; a < 3; a++)
            x[a] *= x[2] > -0.3 ? 1.8 : 1e4; /* far away: invisible */
        put(&scene->splats, 600 + i, x, 0.5f);
    }
    return scene;
}

static void test_object(void **state)
{
    adcgs_splat_scene *scene = make(0);
    adcgs_splat_aims aims;
    int is_object;
    assert_int_equal(adcgs_splat_aims_find(&aims, &is_object, scene, &scene->splats, "made", &error), ADCGS_OK);
    assert_true(is_object && aims.n == ADCGS_SPLAT_AIMS);
    adcgs_splat_scene_free(&scene);
}

/** The fine splats are seen through the opening alone. */
static void test_stage(void **state)
{
    adcgs_splat_scene *scene = make(80);
    adcgs_splat_aims aims;
    int is_object;
    assert_int_equal(adcgs_splat_aims_find(&aims, &is_object, scene, &scene->splats, "made", &error), ADCGS_OK);
    assert_true(!is_object && aims.n > ADCGS_SPLAT_AIMS / 8);
    for (uint32_t i = 0; i < aims.n; i++)
        assert_true(aims.out[i][2] < 0.3);
    adcgs_splat_scene_free(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_object),
        cmocka_unit_test(test_stage),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

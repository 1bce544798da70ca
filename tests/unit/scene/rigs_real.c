/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Real scenes in the layouts LLFF, Neu3D and COLMAP: conventions are consistent with their points. */
#include "opened_scene.h"
#include "second_sources.h"

#include <math.h>

/** Depth of a point; returns whether it is inside the image. */
static int project(const adcgs_camera *c, const double x[3], double *depth)
{
    const double *m = c->cam_to_world;
    double p[3];
    for (int a = 0; a < 3; a++)
        p[a] = m[a] * (x[0] - m[3]) + m[4 + a] * (x[1] - m[7]) + m[8 + a] * (x[2] - m[11]);
    const double u = c->fx * p[0] / p[2] + c->cx, v = c->fy * p[1] / p[2] + c->cy;
    *depth = p[2];
    return p[2] > 0.0 && u >= 0.0 && u < c->width && v >= 0.0 && v < c->height;
}

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/** Of ascending values, with linear interpolation. */
static double percentile(const double *values, size_t n, double share)
{
    const double at = share * (double)(n - 1);
    const size_t low = (size_t)at;
    return values[low] + (at - (double)low) * (values[ADCGS_MIN(low + 1, n - 1)] - values[low]);
}

/**
 * Fern: the points that an image sees by COLMAP's tracks are inside of it. Their depths at 0.1 and 99.9 % are the bounds, as the
 * layout's authors compute them.
 */
static void test_fern(void **state)
{
    expect_good(adcgs_scene_open(&scene, real_data("llff_fern"), NULL, &error));
    assert_true(scene->n_views[ADCGS_SPLIT_TRAIN] == 17 && scene->n_views[ADCGS_SPLIT_TEST] == 3);
    assert_int_equal(scene->points.n, 10091 - 980); /* without those that fewer than two training views saw */
    FILE *file = fopen(real_data("llff_fern/sparse/0/points3D.bin"), "rb");
    static uint8_t data[8 << 20];
    const size_t bytes = fread(data, 1, sizeof data, file);
    fclose(file);
    file = fopen(real_data("llff_fern/poses_bounds.npy"), "rb");
    static uint8_t poses[80 + 20 * 136];
    assert_int_equal(fread(poses, 1, sizeof poses, file), sizeof poses);
    fclose(file);
    static double depths[20][10091];
    size_t n[20] = {0}, inside = 0, all = 0, at = 8;
    for (uint64_t i = 0, points = adcgs_load_le64(data); i < points; i++) {
        double x[3];
        for (size_t a = 0; a < 3; a++)
            x[a] = adcgs_bits_double(adcgs_load_le64(data + at + 8 + 8 * a));
        const uint64_t track = adcgs_load_le64(data + at + 43);
        at += 51;
        for (uint64_t k = 0; k < track; k++, at += 8) {
            const uint32_t image = adcgs_load_le32(data + at) - 1;
            assert_true(image < 20 && at < bytes);
            const adcgs_split split = image % 8 ? ADCGS_SPLIT_TRAIN : ADCGS_SPLIT_TEST;
            const uint32_t v = image % 8 ? image - image / 8 - 1 : image / 8;
            all++;
            inside += (size_t)project(&scene->views[split][v].camera, x, &depths[image][n[image]++]);
        }
    }
    assert_true(inside > 0.998 * (double)all); /* the images still have a little distortion: 0.02 r^2 */
    for (int i = 0; i < 20; i++) {
        qsort(depths[i], n[i], sizeof(double), compare_doubles);
        const double near = adcgs_bits_double(adcgs_load_le64(poses + 80 + 136 * i + 120));
        const double far = adcgs_bits_double(adcgs_load_le64(poses + 80 + 136 * i + 128));
        assert_true(fabs(percentile(depths[i], n[i], 0.001) / near - 1) < 2e-3);
        assert_true(fabs(percentile(depths[i], n[i], 0.999) / far - 1) < 2e-4);
    }
    adcgs_scene_free(&scene);
    const adcgs_scene_options colmap = {.dataset = ADCGS_DATASET_COLMAP};
    expect_error(adcgs_scene_open(&scene, real_data("llff_fern"), &colmap, &error), ADCGS_ERR_DATA, "images.bin: no such file",
                 "");
}

static void test_robot(void **state)
{
    if (adcgs_scene_open(&scene, real_data("synth_robot_multiview"), NULL, &error) == ADCGS_ERR_UNSUPPORTED) {
        print_message("skipped: %s\n", error.text);
        skip();
    }
    if (!scene)
        fail_msg("%s", error.text);
    assert_true(scene->n_views[ADCGS_SPLIT_TRAIN] == 8 * 16 && scene->n_views[ADCGS_SPLIT_TEST] == 16 && scene->n_times == 16);
    assert_true(adcgs_fps_value(scene->rate) == 30.0 && fabs(scene->duration - 0.5) < 1e-12);
    const adcgs_camera *c = &scene->views[ADCGS_SPLIT_TEST][0].camera;
    assert_true(c->width == 352 && c->height == 264 && !strcmp(c->name, "cam00"));
}

/** Hand: the COLMAP model has the cameras of the HyperNeRF files, before these are converted to working coordinates. */
static void test_hand(void **state)
{
    const adcgs_scene_options colmap = {.dataset = ADCGS_DATASET_COLMAP};
    adcgs_scene *other;
    expect_good(adcgs_scene_open(&scene, real_data("nrnerf_hand"), NULL, &error));
    expect_good(adcgs_scene_open(&other, real_data("nrnerf_hand"), &colmap, &error));
    assert_true(other->n_views[ADCGS_SPLIT_TRAIN] == 75 && other->n_views[ADCGS_SPLIT_TEST] == 11 && other->n_times == 1);
    assert_true(other->points.n == scene->points.n && other->points.coloured);
    const adcgs_scene_view *a = scene->views[ADCGS_SPLIT_TRAIN];
    uint32_t compared = 0;
    double scale = 0.0;
    for (uint32_t i = 0; i < scene->n_views[ADCGS_SPLIT_TRAIN]; i++)
        for (int s = 0; s < ADCGS_SPLITS; s++)
            for (uint32_t j = 0; j < other->n_views[s]; j++) {
                const adcgs_camera *c = &a[i].camera, *d = &other->views[s][j].camera;
                if (strcmp(c->name, d->name))
                    continue;
                assert_true(c->width == d->width && c->height == d->height && fabs(c->fx - d->fx) < 1e-4 && c->cx == d->cx);
                for (int k = 0; k < 12; k++)
                    if (k % 4 < 3)
                        assert_true(fabs(c->cam_to_world[k] - d->cam_to_world[k]) < 1e-6);
                compared++;
            }
    assert_int_equal(compared, 75);
    /* Points are in the same order. Two of them give the scale, which then holds for all points and cameras. */
    for (int k = 0; k < 3; k++)
        scale += pow(scene->points.position[0][k] - scene->points.position[9][k], 2);
    double length = 0.0;
    for (int k = 0; k < 3; k++)
        length += pow(other->points.position[0][k] - other->points.position[9][k], 2);
    scale = sqrt(scale / length);
    for (uint32_t i = 1; i < scene->points.n; i++)
        for (int k = 0; k < 3; k++)
            assert_true(fabs((scene->points.position[i][k] - scene->points.position[0][k]) -
                             scale * (other->points.position[i][k] - other->points.position[0][k])) < 1e-4);
    double depth;
    uint32_t inside = 0;
    for (uint32_t i = 0; i < other->points.n; i++)
        inside += (uint32_t)project(&other->views[ADCGS_SPLIT_TRAIN][30].camera, other->points.position[i], &depth);
    assert_true(inside > 0.85 * other->points.n);
    adcgs_scene_free(&other);
}

int adcgs_test_rigs_real(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(test_fern, clean),
        cmocka_unit_test_teardown(test_robot, clean),
        cmocka_unit_test_teardown(test_hand, clean),
    };
    return cmocka_run_group_tests_name("rigs real", tests, make_folder, remove_folder);
}

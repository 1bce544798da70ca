/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Real scenes in the layout of HyperNeRF: conventions are consistent with their points and with published values. */
#include "hypernerf_files.h"
#include "second_sources.h"

#include "scene/layouts/open.h"
#include "scene/scene.h"

#include <jansson.h>
#include <math.h>

/** The pixel of a projected point; 0 if it is not in front of the camera and inside the frame. */
static int find_pixel(const adcgs_camera *c, uint32_t point, size_t *pixel)
{
    const double *m = c->cam_to_world;
    double p[3];
    for (int a = 0; a < 3; a++)
        p[a] = m[a] * (scene->points.position[point][0] - m[3]) + m[4 + a] * (scene->points.position[point][1] - m[7]) +
               m[8 + a] * (scene->points.position[point][2] - m[11]);
    const double x = c->fx * p[0] / p[2] + c->cx, y = c->fy * p[1] / p[2] + c->cy;
    if (!(p[2] > c->near_plane && x >= 0.0 && x < c->width && y >= 0.0 && y < c->height))
        return 0;
    *pixel = (size_t)y * (size_t)c->width + (size_t)x;
    return 1;
}

static double share_seen(const adcgs_camera *c)
{
    uint32_t inside = 0;
    size_t pixel;
    for (uint32_t i = 0; i < scene->points.n; i++)
        inside += (uint32_t)find_pixel(c, i, &pixel);
    return (double)inside / scene->points.n;
}

/** Variance of a point's red from view to view, over that of all points; 1 if poses are meaningless. */
static double inconsistency(void)
{
    enum { VIEWS = 8, STEP = 9 };
    double within = 0.0, sum = 0.0, square = 0.0, n = 0.0;
    float *red[VIEWS];
    for (uint32_t v = 0; v < VIEWS; v++)
        expect_good(adcgs_scene_image(scene, &scene->views[ADCGS_SPLIT_TRAIN][STEP * v], 1, &red[v], NULL, &error));
    for (uint32_t i = 0; i < scene->points.n; i++) {
        double s = 0.0, q = 0.0, k = 0.0;
        size_t pixel;
        for (uint32_t v = 0; v < VIEWS; v++)
            if (find_pixel(&scene->views[ADCGS_SPLIT_TRAIN][STEP * v].camera, i, &pixel)) {
                s += (double)red[v][pixel];
                q += (double)red[v][pixel] * (double)red[v][pixel];
                k++;
            }
        within += k > 0.0 ? q - s * s / k : 0.0;
        sum += s;
        square += q;
        n += k;
    }
    for (uint32_t v = 0; v < VIEWS; v++)
        free(red[v]);
    return within / (square - sum * sum / n);
}

static double number(json_t *array, size_t i)
{
    return json_number_value(json_array_get(array, i));
}

/** A view's camera against the published pose: [R|t|h,w,f], camera to world in OpenGL axes, other coordinates. */
static void check_published(const adcgs_camera *c, json_t *poses, const double centre[3], double scale)
{
    unsigned int index;
    assert_int_equal(sscanf(c->name, "image%u", &index), 1);
    json_t *pose = json_array_get(poses, index - 1);
    for (size_t i = 0; i < 3; i++) {
        json_t *row = json_array_get(pose, i);
        assert_true(fabs(c->cam_to_world[4 * i] - number(row, 0)) < 1e-5);
        assert_true(fabs(c->cam_to_world[4 * i + 1] + number(row, 1)) < 1e-5);
        assert_true(fabs(c->cam_to_world[4 * i + 2] + number(row, 2)) < 1e-5);
        assert_true(fabs(c->cam_to_world[4 * i + 3] - (number(row, 3) - centre[i]) * scale) < 1e-5);
    }
    const double h = number(json_array_get(pose, 0), 4), w = number(json_array_get(pose, 1), 4);
    const double f = number(json_array_get(pose, 2), 4);
    assert_true(c->width == w && c->height == h && fabs(c->fx - f) < 1e-4 && c->fy == c->fx && c->cx == w / 2 && c->cy == h / 2);
}

/** Cameras equal those that the scene's authors published in another form, and see the points triangulated with them. */
static void test_hand(void **state)
{
    const char *path = real_data("nrnerf_hand");
    expect_good(adcgs_scene_open(&scene, path, NULL, &error));
    expect_views(75, 11);
    assert_true(scene->n_times == 75 && scene->points.n == 4630 && scene->axes == ADCGS_AXES_Y_UP && !scene->has_alpha);
    char file[1100];
    snprintf(file, sizeof file, "%s/precomputed.json", path);
    json_t *published = json_load_file(file, 0, NULL);
    snprintf(file, sizeof file, "%s/scene.json", path);
    json_t *coordinates = json_load_file(file, 0, NULL), *poses = json_object_get(published, "poses");
    assert_int_equal(json_array_size(poses), 86);
    double centre[3];
    for (size_t i = 0; i < 3; i++)
        centre[i] = number(json_object_get(coordinates, "center"), i);
    for (int s = 0; s < ADCGS_SPLITS; s++)
        for (uint32_t v = 0; v < scene->n_views[s]; v++) {
            const adcgs_camera *c = &scene->views[s][v].camera;
            check_published(c, poses, centre, json_number_value(json_object_get(coordinates, "scale")));
            assert_true(share_seen(c) > 0.85);
        }
    assert_true(inconsistency() < 0.5);
    assert_true(scene->duration == 85.0 / 30.0); /* 86 images, test images among them */
    assert_true(fabs(scene->views[ADCGS_SPLIT_TEST][10].time - scene->duration * 84.0 / 85.0) < 1e-12);
    float *rgb;
    expect_good(adcgs_scene_image(scene, &scene->views[ADCGS_SPLIT_TEST][10], 1, &rgb, NULL, &error));
    free(rgb);
    json_decref(published);
    json_decref(coordinates);
    adcgs_scene_free(&scene);
}

/** Three real cameras with missing frames and principal points off the centre; synthetic images at half size. */
static void test_windmill(void **state)
{
    const char *path = real_data("dycheck_paper-windmill_cameras");
    static const char *const parts[] = {"dataset.json", "metadata.json", "scene.json", "camera"};
    char mine[512], at[1100];
    adcgs_image image;
    snprintf(mine, sizeof mine, "%s", in("windmill"));
    assert_true(!mkdir(mine, 0777) && !mkdir(in("windmill/rgb"), 0777) && !mkdir(in("windmill/rgb/2x"), 0777));
    for (size_t i = 0; i < ADCGS_COUNTOF(parts); i++) {
        snprintf(at, sizeof at, "%s/%s", path, parts[i]);
        char name[64];
        snprintf(name, sizeof name, "windmill/%s", parts[i]);
        assert_int_equal(symlink(at, in(name)), 0);
    }
    assert_int_equal(adcgs_image_alloc(&image, 360, 480, 3, "black", &error), ADCGS_OK);
    memset(image.data, 0, 360 * 480 * 3 * sizeof *image.data);
    expect_good(adcgs_image_write(&image, in("windmill/black.png"), 0, &error));
    adcgs_image_free(&image);
    snprintf(at, sizeof at, "%s/metadata.json", path);
    json_t *metadata = json_load_file(at, 0, NULL), *entry;
    const char *id;
    json_object_foreach(metadata, id, entry)
    {
        char name[64];
        snprintf(name, sizeof name, "windmill/rgb/2x/%s.png", id);
        assert_int_equal(symlink("../../black.png", in(name)), 0);
    }
    json_decref(metadata);
    expect_good(adcgs_scene_open(&scene, mine, NULL, &error));
    expect_views(277, 419);
    const adcgs_camera *c = &scene->views[ADCGS_SPLIT_TRAIN][0].camera;
    assert_true(c->width == 360 && c->height == 480 && c->fx == 719.9471435546875 / 2 && c->cx == 358.8895263671875 / 2);
    assert_true(c->cy == 484.92236328125 / 2 && scene->n_times == 277 && scene->axes == ADCGS_AXES_Y_UP && scene->points.n == 0);
    adcgs_scene_free(&scene);
}

int adcgs_test_hypernerf_real(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_hand),
        cmocka_unit_test(test_windmill),
    };
    return cmocka_run_group_tests_name("hypernerf real", tests, make_folder, remove_folder);
}

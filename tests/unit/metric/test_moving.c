/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Known motion: masks from the generator to the figures of a view. */
#include "outside_files.h"

#include "geometry/rotation.h"
#include "metric/evaluate.h"
#include "metric/metric.h"
#include "metric/moving.h"
#include "scene/layouts/open.h"
#include "synthetic/scenes.h"
#include "synthetic/table.h"

#include <adcgs/decoder.h>

#include <math.h>

enum { SIZE = 32, PLANE = SIZE * SIZE, TESTS = 3 };

static adcgs_scene *scene;

static void expect_good(adcgs_status status)
{
    if (status != ADCGS_OK)
        fail_msg("%s", error.text);
}

static void expect_near(double got, double expected)
{
    if (!(fabs(got - expected) <= 1e-9 * fabs(expected)))
        fail_msg("%.15g, expected %.15g", got, expected);
}

/** Writes and opens a built-in scene. */
static void open_scene(const char *name, int size, double motion)
{
    const adcgs_scenes_options options = {.name = name, .width = size, .height = size, .format = "ppm", .motion = motion};
    char path[600];
    snprintf(path, sizeof path, "%s/%s-%g", folder, name, motion);
    expect_good(adcgs_scenes_write(path, &options, NULL, NULL, NULL, &error));
    expect_good(adcgs_scene_open(&scene, path, NULL, &error));
}

static int close_scene(void **state)
{
    adcgs_scene_free(&scene);
    return 0;
}

/* ---- The measure ---- */

static void test_only_moving_pixels_count(void **state)
{
    enum { N = 20 };
    uint8_t moving[N] = {0};
    float truth[3 * N], decoded[3 * N];
    for (int i = 0; i < 3 * N; i++) {
        moving[i % N] = i % N < 5;
        truth[i] = 0.25f;
        decoded[i] = 0.25f + (i % N < 5 ? 0.125f : 0.5f);
    }
    adcgs_moving m = adcgs_moving_measure(moving, decoded, truth, N);
    expect_near(m.psnr, 20 * log10(8));
    assert_true(m.share == 0.25);
    for (int c = 0; c < 3; c++) {
        decoded[c * N + 1] = 1.0f; /* wrong, but unknown in the truth */
        truth[c * N + 1] = NAN;
    }
    m = adcgs_moving_measure(moving, decoded, truth, N);
    expect_near(m.psnr, 20 * log10(8));
    assert_true(m.share == 0.2);
    for (int i = 0; i < 5; i++)
        for (int c = 0; c < 3; c++)
            decoded[c * N + i] = truth[c * N + i];
    assert_true(adcgs_moving_measure(moving, decoded, truth, N).psnr == 99);
    decoded[2 * N + 4] += 0.5f; /* one channel of four pixels */
    expect_near(adcgs_moving_measure(moving, decoded, truth, N).psnr, -10 * log10(0.25 / 12));
    memset(moving, 0, sizeof moving);
    m = adcgs_moving_measure(moving, decoded, truth, N);
    assert_true(isnan(m.psnr) && m.share == 0);
}

/* ---- The masks of the scenes ---- */

/** A view's mask equals the tracer's result at that time in a world `motion` times as fast. The ball of tiny only slides. */
static void check_mask(const adcgs_scene_view *view, double motion)
{
    static float expected[PLANE];
    const adcgs_scenes_entry *const entry = adcgs_scenes_entry_find("tiny");
    adcgs_trace_camera camera = {.focal = view->camera.fx};
    uint8_t *moving;
    int n = 0, other = 0;
    memcpy(camera.to_world, view->camera.cam_to_world, sizeof camera.to_world);
    adcgs_pose_other_axes(camera.to_world);
    assert_int_equal(adcgs_trace_cover(entry->objects, entry->n_objects, entry->moving, &camera,
                                       motion * view->time / scene->duration, SIZE, SIZE, 3, NULL, expected, &error),
                     ADCGS_OK);
    expect_good(adcgs_scene_load_moving(view, 1, &moving, &error));
    for (int i = 0; i < PLANE; i++) {
        n += moving[i];
        other += moving[i] != (expected[i] > 0.0f);
    }
    assert_true(n > 20 && n < PLANE / 4 && other <= 1); /* poses have 12 digits */
    uint8_t *half;
    expect_good(adcgs_scene_load_moving(view, 2, &half, &error));
    for (int i = 0; i < PLANE / 4; i++) {
        const uint8_t *const at = moving + 2 * (i / (SIZE / 2)) * SIZE + 2 * (i % (SIZE / 2));
        assert_int_equal(half[i], at[0] + at[1] + at[SIZE] + at[SIZE + 1] >= 2);
    }
    free(half);
    free(moving);
}

static void masks_are_of_the_moment(void **state)
{
    static const double motions[] = {0, 0.1, 2.5}; /* 0 is 1 */
    for (size_t m = 0; m < ADCGS_COUNTOF(motions); m++) {
        open_scene("tiny", SIZE, motions[m]);
        for (uint32_t i = 0; i < scene->n_views[ADCGS_SPLIT_TRAIN]; i++)
            assert_null(scene->views[ADCGS_SPLIT_TRAIN][i].moving);
        for (int split = ADCGS_SPLIT_VAL; split < ADCGS_SPLITS; split++)
            for (uint32_t i = 0; i < scene->n_views[split]; i++)
                check_mask(&scene->views[split][i], motions[m] > 0 ? motions[m] : 1);
        adcgs_scene_free(&scene);
    }
}

static void test_static_scene_has_no_masks(void **state)
{
    open_scene("still", 8, 0);
    for (int split = 0; split < ADCGS_SPLITS; split++)
        for (uint32_t i = 0; i < scene->n_views[split]; i++)
            assert_null(scene->views[split][i].moving);
}

/* ---- The figures ---- */

/** The results that an evaluation reported. */
typedef struct heard {
    double dynamic[TESTS], share[TESTS], expected[TESTS], shares[TESTS];
    int n;
} heard;

static adcgs_status hear(void *user, const adcgs_view_score *score, adcgs_error *e)
{
    heard *h = user;
    uint8_t *moving;
    double squares = 0, n = 0;
    assert_true(h->n < TESTS && score->width == SIZE && score->height == SIZE);
    h->dynamic[h->n] = score->temporal.dynamic_psnr;
    h->share[h->n] = score->known_share;
    if (score->view->moving) {
        ADCGS_TRY(adcgs_scene_load_moving(score->view, 1, &moving, e));
        for (int i = 0; i < 3 * PLANE; i++) {
            squares += moving[i % PLANE] * pow((double)score->decoded[i] - (double)score->truth[i], 2);
            n += moving[i % PLANE] / 3.0;
        }
        free(moving);
    }
    h->expected[h->n] = adcgs_psnr_from_mse(squares / (3 * n));
    h->shares[h->n++] = n / PLANE;
    return ADCGS_OK;
}

/** Evaluates an arbitrary stream, at the time that it has. */
static adcgs_status evaluate_any(int measure, adcgs_score_fn each, heard *h)
{
    const char *source = getenv("srcdir");
    char path[1024];
    adcgs_decoder *decoder;
    adcgs_evaluation e;
    snprintf(path, sizeof path, "%s/conformance/vectors/good-geom-one-anchor.adcgs", source ? source : ".");
    expect_good(adcgs_open_file(&decoder, path, NULL, &error));
    const adcgs_status status = adcgs_evaluate(&e, decoder, scene, ADCGS_SPLIT_TEST, measure, each, h, &error);
    adcgs_close(&decoder);
    return status;
}

static heard evaluate(int measure)
{
    heard h = {.n = 0};
    expect_good(evaluate_any(measure, hear, &h));
    assert_int_equal(h.n, TESTS);
    return h;
}

/** The tiny scene, all test views at time 0. */
static adcgs_scene_view *open_views(void)
{
    open_scene("tiny", SIZE, 0);
    adcgs_scene_view *views = scene->views[ADCGS_SPLIT_TEST];
    assert_int_equal(scene->n_views[ADCGS_SPLIT_TEST], TESTS);
    for (int i = 0; i < TESTS; i++)
        views[i].time = 0;
    return views;
}

/** Each view has another camera. */
static void views_of_moving_cameras(void **state)
{
    open_views();
    const heard h = evaluate(ADCGS_MEASURE_DYNAMIC), none = evaluate(ADCGS_MEASURE_STATIC | ADCGS_MEASURE_FLICKER);
    for (int i = 0; i < TESTS; i++) {
        expect_near(h.dynamic[i], h.expected[i]);
        expect_near(h.share[i], h.shares[i]);
        assert_true(h.share[i] > 0.02 && isnan(none.dynamic[i]) && isnan(none.share[i]));
    }
}

/** One camera: views with a mask are measured by it, the other one by the region that changes over all views. */
static void views_of_a_fixed_camera(void **state)
{
    adcgs_scene_view *views = open_views();
    for (int i = 1; i < TESTS; i++)
        views[i].camera = views[0].camera;
    free(views[1].moving);
    views[1].moving = NULL;
    adcgs_image black;
    expect_good(adcgs_image_alloc(&black, SIZE, SIZE, 1, "black", &error));
    memset(black.data, 0, PLANE * sizeof *black.data);
    expect_good(adcgs_image_write(&black, in("black.pgm"), 0, &error));
    adcgs_image_free(&black);
    free(views[2].moving);
    views[2].moving = strdup(in("black.pgm"));
    const heard h = evaluate(ADCGS_MEASURE_DYNAMIC);
    expect_near(h.dynamic[0], h.expected[0]);
    expect_near(h.share[0], h.shares[0]);
    assert_true(isfinite(h.dynamic[1]) && isnan(h.share[1]));
    assert_true(isnan(h.dynamic[2]) && h.share[2] == 0);
}

/** A mask that was deleted after the scene was opened. */
static void test_missing_mask(void **state)
{
    adcgs_scene_view *views = open_views();
    unlink(views[2].moving);
    expect_error(evaluate_any(ADCGS_MEASURE_DYNAMIC, NULL, NULL), ADCGS_ERR_IO, "r_002_moving.pgm", "");
    expect_good(evaluate_any(0, NULL, NULL));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_only_moving_pixels_count),
        cmocka_unit_test_teardown(masks_are_of_the_moment, close_scene),
        cmocka_unit_test_teardown(test_static_scene_has_no_masks, close_scene),
        cmocka_unit_test_teardown(views_of_moving_cameras, close_scene),
        cmocka_unit_test_teardown(views_of_a_fixed_camera, close_scene),
        cmocka_unit_test_teardown(test_missing_mask, close_scene),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

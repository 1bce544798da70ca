/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Images that a scene keeps: the values of direct loading, each file decoded once, and never more than the limit. */
#include "outside_files.h"

#include "scene/image_cache.h"
#include "scene/image_store.h"
#include "train/anchor_plan.h"

#include <math.h>

enum { W = 34, H = 21, VIEWS = 9, FILES = 10, PLENTY = 1 << 20 };

static adcgs_scene_view views[VIEWS];
static adcgs_scene scene = {.background = {0.25f, 1.0f, 0.5f}, .n_views = {VIEWS}, .views = {views}};
static char names[VIEWS + 1][300];
static adcgs_pool *pool;

static void expect_good(adcgs_status status)
{
    if (status != ADCGS_OK)
        fail_msg("%s", error.text);
}

/** An image whose samples go up to `brightest`; the last channel of an even number is alpha, from 0 to 1. */
static void put_picture(int at, const char *name, int channels, int bits, float brightest)
{
    adcgs_image image;
    const adcgs_image_options options = {.bits = bits};
    expect_good(adcgs_image_alloc(&image, W, H, channels, name, &error));
    for (int i = 0; i < W * H * channels; i++) {
        const float value = (float)(i * 7919 % 4093) / 4092.0f;
        image.data[i] = channels % 2 == 0 && i % channels == channels - 1 ? value : brightest * value;
    }
    expect_good(adcgs_image_write_as(&image, &options, in(name), &error));
    adcgs_image_free(&image);
    snprintf(names[at], sizeof names[at], "%s", in(name));
}

static void put_mask(int at, const char *name)
{
    adcgs_image image;
    expect_good(adcgs_image_alloc(&image, W, H, 1, name, &error));
    for (int i = 0; i < W * H; i++)
        image.data[i] = i % W < W / 3 || i / W == 5 ? 0.0f : 1.0f;
    expect_good(adcgs_image_write(&image, in(name), 0, &error));
    adcgs_image_free(&image);
    snprintf(names[at], sizeof names[at], "%s", in(name));
}

/** Views by a pinhole camera, of the files in order. */
static void put_views(void)
{
    for (int i = 0; i < VIEWS; i++) {
        views[i].camera = (adcgs_camera){.width = W, .height = H, .fx = 30, .fy = 30, .cx = W / 2.0, .cy = H / 2.0};
        views[i].path = names[i];
    }
}

static void bend(adcgs_scene_view *view)
{
    view->lens = (adcgs_lens){.width = W, .height = H, .fx = 30, .fy = 30, .cx = W / 2.0, .cy = H / 2.0, .k = {0.2}};
    expect_good(adcgs_lens_pinhole(&view->lens, &view->camera, view->path, &error));
    assert_true(view->lens.width == W);
}

static int setup(void **state)
{
    if (make_folder(state) != 0 || adcgs_pool_create(&pool, 4, &error) != ADCGS_OK)
        return -1;
    put_picture(0, "plain.png", 3, 8, 1);
    put_picture(1, "deep.png", 3, 16, 1);
    put_picture(2, "alpha.png", 4, 8, 1);
    put_picture(3, "bright.exr", 3, 0, 5);
    put_picture(4, "masked.ppm", 3, 8, 1);
    put_picture(5, "bent.png", 3, 8, 1);
    put_picture(6, "both.png", 4, 16, 1);
    put_picture(7, "burnt.jpg", 3, 8, 1);
    put_picture(8, "grey.pgm", 1, 8, 1);
    put_mask(9, "mask.pgm");
    put_views();
    bend(&views[5]);
    bend(&views[6]);
    views[4].mask = views[6].mask = names[9];
    views[7].stops[0] = 0.5f;
    views[7].stops[2] = -0.25f;
    return 0;
}

static int teardown(void **state)
{
    adcgs_pool_free(&pool);
    return remove_folder(state);
}

static uint64_t decoded(void)
{
    uint64_t n, kept;
    adcgs_image_cache_facts(scene.images, &n, &kept);
    return n;
}

static uint64_t kept_bytes(void)
{
    uint64_t n, kept;
    adcgs_image_cache_facts(scene.images, &n, &kept);
    return kept;
}

static void begin(uint64_t limit)
{
    expect_good(adcgs_image_cache_create(&scene.images, &error));
    adcgs_image_cache_limit(scene.images, limit);
}

static void end(void)
{
    adcgs_image_cache_free(&scene.images);
}

/** True if a view has the values and the camera of direct loading, to the bit. */
static int is_same(const adcgs_scene_view *view, int divide)
{
    float *got, *want;
    adcgs_camera camera, expected;
    adcgs_scene direct = scene;
    direct.images = NULL;
    if (adcgs_scene_image(&direct, view, divide, &want, &expected, NULL) != ADCGS_OK)
        return 0;
    int same = adcgs_scene_image(&scene, view, divide, &got, &camera, NULL) == ADCGS_OK;
    same = same && !memcmp(&camera, &expected, sizeof camera) &&
           !memcmp(got, want, 3 * (size_t)camera.width * (size_t)camera.height * sizeof *got);
    free(want);
    if (same)
        free(got);
    return same;
}

/** With room for all images, for some, and for none. */
static void test_values(void **state)
{
    static const uint64_t limits[] = {PLENTY, 10 * W * H, 0};
    for (size_t i = 0; i < ADCGS_COUNTOF(limits); i++) {
        begin(limits[i]);
        for (int divide = 1; divide <= 5; divide++)
            for (int view = 0; view < VIEWS; view++) {
                assert_true(is_same(&views[view], divide));
                assert_true(kept_bytes() <= limits[i]);
            }
        assert_true(i == 0 ? decoded() == FILES : decoded() > FILES);
        assert_true((kept_bytes() > 0) == (limits[i] > 0));
        end();
    }
}

typedef struct job {
    int bad;
} job;

static void load_one(void *arg, int i, int thread)
{
    job *j = arg;
    if (!is_same(&views[i % VIEWS], 1 + i / VIEWS % 4))
        j->bad = 1;
}

/** Threads that want the same image wait for the one that decodes it. */
static void test_threads(void **state)
{
    for (int round = 0; round < 10; round++) {
        job j = {0};
        begin(round % 2 ? 12 * W * H : PLENTY);
        adcgs_pool_run(pool, load_one, &j, 8 * VIEWS);
        assert_false(j.bad);
        assert_true(round % 2 || decoded() == FILES);
        end();
    }
}

/** Images in other memory have priority; images of an earlier limit give way to those of the present one. */
static void test_limits(void **state)
{
    const uint64_t size = 3 * W * H;
    begin(size);
    assert_true(is_same(&views[0], 1) && is_same(&views[4], 2)); /* no room for the second, and its mask */
    assert_int_equal(kept_bytes(), size);
    assert_true(is_same(&views[0], 2));
    assert_int_equal(decoded(), 3);
    adcgs_image_cache_limit(scene.images, size);
    assert_true(is_same(&views[5], 1) && is_same(&views[5], 2)); /* takes the place of the first */
    assert_int_equal(decoded(), 4);
    assert_true(is_same(&views[0], 1));
    assert_int_equal(decoded(), 5);
    assert_int_equal(kept_bytes(), size);
    adcgs_image_cache_charge(scene.images, 1);
    assert_int_equal(kept_bytes(), 0);
    assert_true(is_same(&views[0], 1));
    assert_int_equal(kept_bytes(), 0);
    adcgs_image_cache_charge(scene.images, -1);
    assert_true(is_same(&views[0], 1));
    assert_int_equal(kept_bytes(), size);
    adcgs_image_cache_limit(scene.images, size - 1);
    assert_int_equal(kept_bytes(), 0);
    end();
}

/** A file that fails leaves nothing behind, and fails again until it is there. */
static void test_failure(void **state)
{
    adcgs_scene_view missing = views[0], small = views[0];
    char path[300];
    float *rgb;
    begin(PLENTY);
    snprintf(path, sizeof path, "%s", in("late.png"));
    missing.path = path;
    for (int i = 0; i < 2; i++) {
        assert_int_equal(adcgs_scene_image(&scene, &missing, 1, &rgb, NULL, &error), ADCGS_ERR_IO);
        assert_non_null(strstr(error.text, "late.png"));
    }
    assert_int_equal(kept_bytes(), 0);
    assert_int_equal(link(names[0], path), 0);
    assert_true(is_same(&missing, 2));
    small.camera.width--; /* a kept image has the wrong size for another camera */
    assert_true(is_same(&views[0], 1));
    assert_int_equal(adcgs_scene_image(&scene, &small, 1, &rgb, NULL, &error), ADCGS_ERR_DATA);
    assert_non_null(strstr(error.text, "expected 33x21"));
    assert_int_equal(adcgs_scene_image(&scene, &views[0], 0, &rgb, NULL, &error), ADCGS_ERR_USAGE);
    assert_null(rgb);
    end();
}

/** Expects a store to hold the same images as without the scene's kept ones. */
static void expect_same_store(const adcgs_image_store *got, int divide)
{
    static float a[3 * W * H], b[3 * W * H];
    const adcgs_image_store_config config = {.split = ADCGS_SPLIT_TRAIN, .divide = divide};
    adcgs_image_store *want;
    adcgs_scene direct = scene;
    uint64_t memory[2], file[2];
    direct.images = NULL;
    expect_good(adcgs_image_store_load(&want, &direct, &config, pool, &error));
    for (uint32_t i = 0; i < VIEWS; i++) {
        const adcgs_camera *const c = adcgs_image_store_camera(want, i);
        expect_good(adcgs_image_store_get(got, i, a, &error));
        expect_good(adcgs_image_store_get(want, i, b, &error));
        assert_memory_equal(c, adcgs_image_store_camera(got, i), sizeof *c);
        assert_memory_equal(a, b, 3 * (size_t)c->width * (size_t)c->height * sizeof *a);
    }
    adcgs_image_store_size(got, &memory[0], &file[0]);
    adcgs_image_store_size(want, &memory[1], &file[1]);
    assert_true(memory[0] == memory[1] && file[0] == file[1]);
    adcgs_image_store_free(&want);
}

/** As a run does: details, a quarter, half, and all of the size, with the image of a view replaced. */
static void test_run(void **state)
{
    static float grey[3 * W * H];
    adcgs_image_store *store = NULL;
    uint32_t details;
    begin(PLENTY);
    expect_good(adcgs_plan_details(&scene, 1, &details, &error));
    for (int divide = 4; divide >= 1; divide /= 2) {
        const adcgs_image_store_config config = {.split = ADCGS_SPLIT_TRAIN, .divide = divide};
        adcgs_image_store_free(&store);
        expect_good(adcgs_image_store_load(&store, &scene, &config, pool, &error));
        expect_same_store(store, divide);
    }
    assert_int_equal(decoded(), FILES);
    expect_good(adcgs_image_store_put(store, 0, grey, &error));
    assert_true(is_same(&views[0], 1));
    adcgs_image_cache_limit(scene.images, 0); /* an image in use stays */
    expect_good(adcgs_image_store_get(store, 1, grey, &error));
    assert_int_equal(kept_bytes(), 6 * W * H);
    adcgs_image_store_free(&store);
    assert_int_equal(kept_bytes(), 0);
    end();
}

/** The store and the kept images together stay within the limit. */
static void test_run_within(void **state)
{
    const uint64_t least = adcgs_image_store_least(&scene, ADCGS_SPLIT_TRAIN, 1);
    begin(least);
    for (int divide = 2; divide >= 1; divide--) {
        const adcgs_image_store_config config = {.split = ADCGS_SPLIT_TRAIN, .divide = divide};
        adcgs_image_store *store;
        uint64_t memory, file;
        expect_good(adcgs_image_store_load(&store, &scene, &config, pool, &error));
        adcgs_image_store_size(store, &memory, &file);
        assert_true(divide == 1 || kept_bytes() + memory <= least);
        expect_same_store(store, divide);
        adcgs_image_store_free(&store);
    }
    assert_true(decoded() < 2 * FILES);
    end();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_values),  cmocka_unit_test(test_threads), cmocka_unit_test(test_limits),
        cmocka_unit_test(test_failure), cmocka_unit_test(test_run),     cmocka_unit_test(test_run_within),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}

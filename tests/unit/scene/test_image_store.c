/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Images kept in memory and in a file: the same values for any budget. */
#include "outside_files.h"

#include "scene/image_store.h"
#include "scene/layouts/open.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <sys/resource.h>

#define VIEW(path) "{\"file_path\":\"" path "\",\"transform_matrix\":[[1,0,0,0],[0,1,0,0],[0,0,1,4],[0,0,0,1]]}"
enum { WIDTH = 7, HEIGHT = 5, VALUES = 3 * WIDTH * HEIGHT, TRAIN = 4 };

static adcgs_scene *scene;
static adcgs_pool *pool;

static void put_picture(const char *name, float brightest)
{
    adcgs_image image;
    assert_int_equal(adcgs_image_alloc(&image, WIDTH, HEIGHT, 3, name, &error), ADCGS_OK);
    for (int i = 0; i < VALUES; i++)
        image.data[i] = brightest * (float)(i * 37 % 256) / 255.0f;
    assert_int_equal(adcgs_image_write(&image, in(name), 0, &error), ADCGS_OK);
    adcgs_image_free(&image);
}

/** Four views for training: the first is for testing. One has values beyond 1. */
static int setup(void **state)
{
    if (make_folder(state) != 0 || adcgs_pool_create(&pool, 2, &error) != ADCGS_OK)
        return -1;
    put_picture("a.ppm", 1.0f);
    put_picture("b.ppm", 0.5f);
    put_picture("c.exr", 4.0f);
    put_text("transforms.json", "{\"w\":7,\"h\":5,\"fl_x\":5,\"frames\":[" VIEW("a.ppm") "," VIEW("a.ppm") "," VIEW(
                                    "b.ppm") "," VIEW("c.exr") "," VIEW("a.ppm") "]}");
    return adcgs_scene_open(&scene, folder, NULL, &error) != ADCGS_OK;
}

static int teardown(void **state)
{
    adcgs_scene_free(&scene);
    adcgs_pool_free(&pool);
    return remove_folder(state);
}

static adcgs_status load_store(adcgs_image_store **pictures, uint64_t memory, int divide, adcgs_image_store_progress progress,
                               void *user)
{
    const adcgs_image_store_config config = {ADCGS_SPLIT_TRAIN, divide, memory, progress, user, NULL};
    return adcgs_image_store_load(pictures, scene, &config, pool, &error);
}

/** With room for all, some and none. */
static void test_budgets(void **state)
{
    static const uint64_t budgets[] = {0, VALUES * 2, 1}; /* for all, for two of 8 bits, for none */
    for (size_t i = 0; i < ADCGS_COUNTOF(budgets); i++) {
        adcgs_image_store *pictures;
        uint64_t memory, file;
        assert_int_equal(load_store(&pictures, budgets[i], 1, NULL, NULL), ADCGS_OK);
        adcgs_image_store_size(pictures, &memory, &file);
        assert_int_equal(memory + file, VALUES * (3 * 1 + 4));
        assert_true(i == 0 ? file == 0 : memory <= budgets[i]);
        for (uint32_t view = 0; view < TRAIN; view++) {
            float got[VALUES], *want;
            adcgs_camera camera;
            adcgs_image_store_prefetch(pictures, view);
            assert_int_equal(adcgs_image_store_get(pictures, view, got, &error), ADCGS_OK);
            assert_int_equal(adcgs_scene_image(scene, &scene->views[ADCGS_SPLIT_TRAIN][view], 1, &want, &camera, &error),
                             ADCGS_OK);
            assert_memory_equal(got, want, sizeof got); /* 8 bits and binary32 pass unchanged */
            assert_memory_equal(&camera, adcgs_image_store_camera(pictures, view), sizeof camera);
            free(want);
        }
        adcgs_image_store_free(&pictures);
    }
}

/** A mean of pixels is not a multiple of 1/255: it is rounded, in memory as in the file. */
static void test_reduced(void **state)
{
    adcgs_image_store *held, *filed;
    assert_int_equal(load_store(&held, 0, 2, NULL, NULL), ADCGS_OK);
    assert_int_equal(load_store(&filed, 1, 2, NULL, NULL), ADCGS_OK);
    for (uint32_t view = 0; view < TRAIN; view++) {
        float a[3 * 4 * 3], b[3 * 4 * 3], *want;
        assert_int_equal(adcgs_image_store_get(held, view, a, &error), ADCGS_OK);
        assert_int_equal(adcgs_image_store_get(filed, view, b, &error), ADCGS_OK);
        assert_memory_equal(a, b, sizeof a);
        assert_int_equal(adcgs_scene_image(scene, &scene->views[ADCGS_SPLIT_TRAIN][view], 2, &want, NULL, &error), ADCGS_OK);
        for (size_t i = 0; i < ADCGS_COUNTOF(a); i++)
            assert_true(fabsf(a[i] - want[i]) <= 0.51f / 65535.0f);
        free(want);
    }
    adcgs_image_store_free(&held);
    adcgs_image_store_free(&filed);
}

/** Replaces an image, wide or not, in memory or in the file. */
static void test_put(void **state)
{
    for (uint64_t memory = 0; memory < 2; memory++) {
        adcgs_image_store *pictures;
        float put[VALUES], got[VALUES];
        assert_int_equal(load_store(&pictures, memory, 1, NULL, NULL), ADCGS_OK);
        for (int wide = 1; wide >= 0; wide--) {
            for (int i = 0; i < VALUES; i++)
                put[i] = (float)((wide ? 1000 : 1) * i) / 255.0f;
            assert_int_equal(adcgs_image_store_put(pictures, 0, put, &error), ADCGS_OK);
            assert_int_equal(adcgs_image_store_get(pictures, 0, got, &error), ADCGS_OK);
            assert_memory_equal(got, put, sizeof put);
        }
        adcgs_image_store_free(&pictures);
    }
}

static int count(void *user, uint32_t done, uint32_t n)
{
    uint32_t *last = user;
    assert_true(done > *last && done <= n && n == TRAIN);
    *last = done;
    return 0;
}

static int stop(void *user, uint32_t done, uint32_t n)
{
    return 1;
}

static void test_progress(void **state)
{
    adcgs_image_store *pictures;
    uint32_t last = 0;
    assert_int_equal(load_store(&pictures, 0, 1, count, &last), ADCGS_OK);
    assert_int_equal(last, TRAIN);
    adcgs_image_store_free(&pictures);
    expect_error(load_store(&pictures, 0, 1, stop, NULL), ADCGS_ERR_IO, "interrupted", "images");
    assert_null(pictures);
}

/** Changes TMPDIR; NULL restores it. */
static void use_tmpdir(const char *name)
{
    static char *before;
    if (name) {
        before = getenv("TMPDIR") ? strdup(getenv("TMPDIR")) : NULL;
        setenv("TMPDIR", name, 1);
        return;
    }
    before ? setenv("TMPDIR", before, 1) : unsetenv("TMPDIR");
    free(before);
    before = NULL;
}

/** Images that are decoded again equal those that are kept; divide: with 16 bits, too. */
static void expect_same_as_kept(const adcgs_image_store *pictures, int divide)
{
    adcgs_image_store *kept;
    assert_int_equal(load_store(&kept, 0, divide, NULL, NULL), ADCGS_OK);
    for (uint32_t view = 0; view < TRAIN; view++) {
        const adcgs_camera *const c = adcgs_image_store_camera(kept, view);
        float a[VALUES], b[VALUES];
        adcgs_image_store_prefetch(pictures, view);
        assert_int_equal(adcgs_image_store_get(kept, view, a, &error), ADCGS_OK);
        assert_int_equal(adcgs_image_store_get(pictures, view, b, &error), ADCGS_OK);
        assert_memory_equal(a, b, 3 * (size_t)c->width * (size_t)c->height * sizeof *a);
    }
    adcgs_image_store_free(&kept);
}

/** No folder for a file, or one that may not grow: images without room are decoded again. */
static void test_no_room(void **state)
{
    for (int divide = 1; divide <= 2; divide++) {
        adcgs_image_store *pictures;
        const char *why;
        use_tmpdir(in("nowhere"));
        assert_int_equal(load_store(&pictures, 1, divide, NULL, NULL), ADCGS_OK);
        use_tmpdir(NULL);
        assert_int_equal(adcgs_image_store_decoded_again(pictures, &why), TRAIN);
        assert_string_equal(why, strerror(ENOENT));
        expect_same_as_kept(pictures, divide);
        adcgs_image_store_free(&pictures);
    }
}

/** With room for one of two images in 8 bits: a limit of a file's size counts as the disk's does. */
static void test_limited_room(void **state)
{
    struct rlimit before, limit;
    adcgs_image_store *pictures;
    const adcgs_image_store_config config = {ADCGS_SPLIT_TRAIN, 1, VALUES, NULL, NULL, NULL};
    adcgs_image_store_need need;
    const char *why;
    uint64_t memory, file;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    limit = before;
    limit.rlim_cur = VALUES + 1;
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
    const adcgs_status status = load_store(&pictures, VALUES, 1, NULL, NULL);
    assert_int_equal(adcgs_image_store_estimate(&need, scene, &config, &error), ADCGS_OK);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
    assert_int_equal(status, ADCGS_OK);
    adcgs_image_store_size(pictures, &memory, &file);
    assert_true(memory == VALUES && file == VALUES);
    assert_int_equal(adcgs_image_store_decoded_again(pictures, &why), 2);
    assert_int_equal(need.n, TRAIN);
    assert_true(need.memory == VALUES && need.file == VALUES && need.room == VALUES + 1 && !need.problem);
    assert_true(need.again == 2 && need.bytes == TRAIN * VALUES); /* the first and the last have 8 bits */
    expect_same_as_kept(pictures, 1);
    adcgs_image_store_free(&pictures);
}

/** The error names the first missing image in the order of views, not the first to fail. */
static void test_missing_picture(void **state)
{
    adcgs_image_store *pictures;
    unlink(in("b.ppm"));
    expect_error(load_store(&pictures, 0, 1, NULL, NULL), ADCGS_ERR_IO, "b.ppm", "");
    assert_null(pictures);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_budgets),         cmocka_unit_test(test_reduced), cmocka_unit_test(test_put),
        cmocka_unit_test(test_progress),        cmocka_unit_test(test_no_room), cmocka_unit_test(test_limited_room),
        cmocka_unit_test(test_missing_picture),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}

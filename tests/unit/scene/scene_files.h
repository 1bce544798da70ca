/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A small scene of one or more transforms files, opened with success or with an error. */
#ifndef ADCGS_TESTS_SCENE_FILES_H
#define ADCGS_TESTS_SCENE_FILES_H

#include "outside_files.h"

#include "scene/layouts/open.h"
#include "scene/scene.h"

#define IDENTITY "[[1,0,0,0],[0,1,0,0],[0,0,1,4],[0,0,0,1]]"
#define FRAME(path, more) "{\"file_path\":\"" path "\",\"transform_matrix\":" IDENTITY more "}"

static adcgs_scene *scene;

/** 6x4 pixels; alpha 0 on the left half if there is alpha. */
static inline void put_image(const char *name, int channels)
{
    adcgs_image image;
    assert_int_equal(adcgs_image_alloc(&image, 6, 4, channels, name, &error), ADCGS_OK);
    for (int i = 0; i < 6 * 4 * channels; i++)
        image.data[i] = (float)(i % 251) / 255.0f;
    for (int i = 3; channels == 4 && i < 6 * 4 * 4; i += 4)
        image.data[i] = i / 4 % 6 < 3 ? 0.0f : 1.0f;
    assert_int_equal(adcgs_image_write(&image, in(name), 0, &error), ADCGS_OK);
    adcgs_image_free(&image);
}

static inline int setup(void **state)
{
    if (make_folder(state))
        return -1;
    put_image("a.ppm", 3);
    put_image("b.ppm", 3);
    put_image("c.tif", 4);
    return 0;
}

static inline int no_files(void **state)
{
    unlink(in("transforms.json"));
    unlink(in("transforms_train.json"));
    unlink(in("transforms_val.json"));
    unlink(in("transforms_test.json"));
    unlink(in("points3d.ply"));
    return 0;
}

static inline adcgs_status open_single(const char *json)
{
    put_text("transforms.json", json);
    return adcgs_scene_open(&scene, folder, NULL, &error);
}

static inline void expect_good(adcgs_status status)
{
    if (status != ADCGS_OK)
        fail_msg("%s", error.text);
}

static inline void expect_bad(const char *json, adcgs_status status, const char *field, const char *what)
{
    expect_error(open_single(json), status, field, what);
    assert_non_null(strstr(error.text, "transforms.json"));
    assert_null(scene);
}

static inline void expect_views(uint32_t train, uint32_t val, uint32_t test)
{
    assert_int_equal(scene->n_views[ADCGS_SPLIT_TRAIN], train);
    assert_int_equal(scene->n_views[ADCGS_SPLIT_VAL], val);
    assert_int_equal(scene->n_views[ADCGS_SPLIT_TEST], test);
}

#endif

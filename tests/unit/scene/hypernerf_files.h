/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A scene in the layout of HyperNeRF, file by file, opened with success or with an error. */
#ifndef ADCGS_TESTS_HYPERNERF_FILES_H
#define ADCGS_TESTS_HYPERNERF_FILES_H

#include "outside_files.h"

#include "scene/layouts/open.h"
#include "scene/scene.h"

static adcgs_scene *scene;

/* Images are 6x4. The first camera is turned by a quarter about its axis: its x axis is the world's y. */
#define LENS "\"focal_length\":8,\"principal_point\":[2.5,2.25],\"image_size\":[6,4]"
#define TURNED "\"orientation\":[[0,1,0],[-1,0,0],[0,0,1]],\"position\":[1,2,3]"
#define PLAIN "\"orientation\":[[1,0,0],[0,1,0],[0,0,1]],\"position\":[0,0,-5]"
#define ZERO "\"skew\":0.0,\"pixel_aspect_ratio\":1.5,\"radial_distortion\":[0,1e-7,0],\"tangential_distortion\":[0,0]"

/** The files of a good scene; tests replace some of them. */
static const struct {
    const char *name, *text;
} good[] = {
    {"dataset.json", "{\"ids\":[\"a\",\"b\",\"c\"],\"train_ids\":[\"a\",\"c\"],\"val_ids\":[\"b\"]}"},
    {"metadata.json", "{\"a\":{\"warp_id\":0},\"b\":{\"warp_id\":3,\"camera_id\":0},\"c\":{\"warp_id\":4},"
                      "\"d\":{\"warp_id\":8}}"},
    {"scene.json", "{\"center\":[1,0,-1],\"scale\":0.5,\"near\":0.1,\"far\":2}"},
    {"camera/a.json", "{" TURNED "," LENS "," ZERO "}"},
    {"camera/b.json", "{" PLAIN "," LENS ",\"tangential\":[0,1e-7]}"},
    {"camera/c.json", "{" PLAIN "," LENS "}"},
};

#define NPY "\x93NUMPY\x01\0\x3e\0{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }  \n"
#define NUMBERS "\0\0\x80\x3f\0\0\0\x40\0\0\x40\x40\0\0\x80\xbf\0\0\0\0\0\0\0\x3f" /* 1 2 3, -1 0 0.5 */

static inline void put_image(const char *name)
{
    adcgs_image image;
    assert_int_equal(adcgs_image_alloc(&image, 6, 4, 3, name, &error), ADCGS_OK);
    for (int i = 0; i < 6 * 4 * 3; i++)
        image.data[i] = (float)i / 255.0f;
    assert_int_equal(adcgs_image_write(&image, in(name), 0, &error), ADCGS_OK);
    adcgs_image_free(&image);
}

static inline void put_scene(void)
{
    for (size_t i = 0; i < ADCGS_COUNTOF(good); i++)
        put_text(good[i].name, good[i].text);
    put_bytes("points.npy", NPY NUMBERS, sizeof NPY + sizeof NUMBERS - 2);
}

static inline int setup(void **state)
{
    if (make_folder(state) || mkdir(in("camera"), 0777) || mkdir(in("rgb"), 0777) || mkdir(in("rgb/1x"), 0777))
        return -1;
    put_image("rgb/1x/a.png");
    put_image("rgb/1x/b.ppm");
    put_image("rgb/1x/c.png");
    put_scene();
    return 0;
}

static inline int mend(void **state)
{
    put_scene();
    unlink(in("points3d.ply"));
    unlink(in("transforms.json"));
    return 0;
}

static inline void expect_good(adcgs_status status)
{
    if (status != ADCGS_OK)
        fail_msg("%s", error.text);
}

static inline void open_good(void)
{
    expect_good(adcgs_scene_open(&scene, folder, NULL, &error));
}

static inline void expect_views(uint32_t train, uint32_t test)
{
    assert_int_equal(scene->n_views[ADCGS_SPLIT_TRAIN], train);
    assert_int_equal(scene->n_views[ADCGS_SPLIT_VAL], 0);
    assert_int_equal(scene->n_views[ADCGS_SPLIT_TEST], test);
}

static inline void expect_bad(const char *file, const char *text, adcgs_status status, const char *what)
{
    put_scene();
    put_text(file, text);
    expect_error(adcgs_scene_open(&scene, folder, NULL, &error), status, file, what);
    assert_null(scene);
    put_scene();
}

#endif

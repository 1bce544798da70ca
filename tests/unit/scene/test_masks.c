/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Masks from other programs: in alpha, in colours, in both, of every depth. */
#include "opened_scene.h"

#include "scene/mask.h"

#include <math.h>

enum { W = 40, H = 20 };

/** Values of a channel in the two halves of a mask; a third part, of so many columns, lies between. */
typedef struct paint {
    float hidden, seen, between;
} paint;

static void put_sized(const char *name, int width, int height, int channels, paint colour, paint alpha, int columns)
{
    adcgs_image mask;
    expect_good(adcgs_image_alloc(&mask, width, height, channels, name, &error));
    for (int i = 0; i < width * height; i++)
        for (int c = 0; c < channels; c++) {
            const paint *p = channels % 2 == 0 && c == channels - 1 ? &alpha : &colour;
            const int x = i % width;
            mask.data[i * channels + c] = x < width / 2 ? p->hidden : x < width / 2 + columns ? p->between : p->seen;
        }
    expect_good(adcgs_image_write(&mask, in(name), 0, &error));
    adcgs_image_free(&mask);
}

static void put_mask(const char *name, int channels, paint colour, paint alpha, int columns)
{
    put_sized(name, W, H, channels, colour, alpha, columns);
}

static void put_scene(const char *mask)
{
    static const char frame[] = "{\"file_path\":\"%c.ppm\",\"mask_path\":\"%s\",\"transform_matrix\":"
                                "[[1,0,0,%d],[0,1,0,0],[0,0,1,3]]}";
    char text[1000] = "{\"fl_x\":30,\"frames\":[";
    adcgs_image image;
    expect_good(adcgs_image_alloc(&image, W, H, 3, "i", &error));
    for (int i = 0; i < 3 * W * H; i++)
        image.data[i] = 0.5f;
    for (int i = 0; i < 3; i++) {
        char name[8];
        snprintf(name, sizeof name, "%c.ppm", "abc"[i]);
        expect_good(adcgs_image_write(&image, in(name), 0, &error));
        snprintf(text + strlen(text), sizeof text - strlen(text), frame, "abc"[i], mask, i);
        strcat(text, i < 2 ? "," : "]}");
    }
    adcgs_image_free(&image);
    put_text("transforms.json", text);
}

/** Opens the folder in place of the scene that is open, which adcgs_scene_open() would not free. */
static int reopen(void)
{
    adcgs_scene_free(&scene);
    return adcgs_scene_open(&scene, folder, NULL, &error);
}

/** Number of hidden columns on the left; all rows are equal. */
static int hidden_columns(void)
{
    float *rgb;
    int n = 0;
    expect_good(reopen());
    expect_good(adcgs_scene_image(scene, scene->views[ADCGS_SPLIT_TRAIN], 1, &rgb, NULL, &error));
    while (n < W && isnan(rgb[n]))
        n++;
    for (int i = 0; i < 3 * W * H; i++)
        assert_true(!isnan(rgb[i]) == (i % W >= n));
    free(rgb);
    return n;
}

static void test_kinds(void **state)
{
    static const struct {
        int channels;
        paint colour, alpha;
        int columns, hidden;
    } cases[] = {
        {1, {0, 1, 1}, {0, 0, 0}, 0, W / 2},
        {3, {0, 1, 1}, {0, 0, 0}, 0, W / 2},
        {3, {0, 0.01f, 1}, {0, 0, 0}, 0, W / 2},         /* any colour but black counts */
        {4, {0, 1, 1}, {1, 1, 1}, 0, W / 2},             /* alpha is constant and ignored */
        {4, {0, 1, 1}, {0, 0, 0}, 0, W / 2},             /* here too */
        {4, {1, 1, 1}, {0, 1, 1}, 0, W / 2},             /* white paint */
        {4, {0.3f, 0.6f, 0.1f}, {0, 1, 0.5f}, 3, W / 2}, /* an object that was cut out */
        {4, {0, 0, 0}, {0, 1, 1}, 0, W / 2},             /* black paint, the same in all pixels */
        {4, {0, 1, 1}, {0, 1, 0.2f}, 3, W / 2},          /* both agree */
        {2, {1, 1, 1}, {0, 1, 1}, 0, W / 2},
        {2, {0, 1, 1}, {1, 1, 1}, 0, W / 2},
        {4, {1, 1, 1}, {1, 1, 1}, 0, 0},
        {4, {1, 1, 1}, {0, 0, 0}, 0, 0},
    };
    put_scene("m.png");
    for (size_t i = 0; i < ADCGS_COUNTOF(cases); i++) {
        put_mask("m.png", cases[i].channels, cases[i].colour, cases[i].alpha, cases[i].columns);
        const int n = hidden_columns();
        if (n != cases[i].hidden)
            fail_msg("mask %zu hides %d columns, expected %d", i, n, cases[i].hidden);
    }
}

/**
 * Colours and alpha that contradict each other are an error before training, by name and with both shares; for test views, too.
 */
static void test_both(void **state)
{
    static const paint colours[] = {{0, 1, 0}, {1, 0, 0}, {1, 1, 0}}, alphas[] = {{0, 1, 1}, {0, 1, 1}, {0, 1, 1}};
    put_scene("m.png");
    for (size_t i = 0; i < ADCGS_COUNTOF(colours); i++) {
        put_mask("m.png", 4, colours[i], alphas[i], 4);
        expect_error(reopen(), ADCGS_ERR_DATA, "m.png: its black hides", "its alpha 50 %");
    }
    put_mask("m.png", 4, colours[0], alphas[0], 0);
    assert_int_equal(hidden_columns(), W / 2);
    adcgs_image mask = {.data = NULL};
    expect_good(adcgs_image_alloc(&mask, 200, 10, 4, "edge", &error));
    for (int i = 0; i < 2000; i++) {
        mask.data[4 * i] = mask.data[4 * i + 1] = mask.data[4 * i + 2] = i % 200 < 100 ? 0.0f : 1.0f;
        mask.data[4 * i + 3] = i % 200 < 101 ? 0.0f : 1.0f; /* a column of an edge: half a percent */
    }
    expect_good(adcgs_mask_settle(&mask, "edge", &error));
    assert_true(mask.channels == 1 && mask.data[100] == 0.0f && mask.data[101] == 1.0f);
    adcgs_image_free(&mask);
}

static const paint black_and_white = {0, 1, 1}, none = {0, 0, 0};

/** A mask of another size is scaled if it has its image's aspect ratio, else refused. */
static void test_sizes(void **state)
{
    static const struct {
        int width, height, fits;
    } cases[] = {{W / 2, H / 2, 1}, {2 * W, 2 * H, 1}, {2 * W, 2 * H - 1, 1}, {W, H / 2, 0}, {H, W, 0}, {W - 4, H, 0}};
    put_scene("m.png");
    for (size_t i = 0; i < ADCGS_COUNTOF(cases); i++) {
        put_sized("m.png", cases[i].width, cases[i].height, 1, black_and_white, none, 0);
        if (cases[i].fits)
            assert_int_equal(hidden_columns(), W / 2);
        else
            expect_error(reopen(), ADCGS_ERR_DATA, "m.png: ", "expected 40x20 like");
    }
}

/** Pixels that JPEG has made nearly black are hidden; in lossless files only 0 hides. */
static void test_jpeg(void **state)
{
    static const paint nearly = {0.02f, 0.97f, 1};
    put_scene("m.jpg");
    put_mask("m.jpg", 3, nearly, none, 0);
    assert_int_equal(hidden_columns(), W / 2);
    put_scene("m.png");
    put_mask("m.png", 3, nearly, none, 0);
    assert_int_equal(hidden_columns(), 0);
}

/** Masks that hide all pixels are refused before training. */
static void test_nothing_left(void **state)
{
    static const paint black = {0, 0, 0};
    put_scene("m.png");
    put_mask("m.png", 1, black, none, 0);
    expect_error(reopen(), ADCGS_ERR_DATA, "m.png: black everywhere", "no pixel is left");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(test_sizes, clean),        cmocka_unit_test_teardown(test_jpeg, clean),
        cmocka_unit_test_teardown(test_nothing_left, clean), cmocka_unit_test_teardown(test_kinds, clean),
        cmocka_unit_test_teardown(test_both, clean),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Colours of input images: EXR is linear light by default and becomes sRGB; 16 bits next to 8; alpha over the background. NaN and
 * other primaries are refused. The reference is IEC 61966-2-1, in double.
 */
#include "outside_files.h"

#include "scene/image_store.h"
#include "scene/layouts/open.h"

#include <math.h>
#include <openexr.h>

enum { WIDTH = 9, HEIGHT = 3, PIXELS = WIDTH * HEIGHT };

/** The levels of one row; the others have multiples of them. */
static const float levels[WIDTH] = {0.0f, 0.0005f, 0.0031308f, 0.01f, 0.18f, 0.5f, 1.0f, 4.0f, -0.125f};

static adcgs_scene *scene;

static double curve(double linear)
{
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1 / 2.4) - 0.055;
}

/** The value of channel c (R, G, B) of a pixel in the files made here. */
static float level(int c, int x, int y)
{
    return levels[x] * (float)(1 + y) / (float)(1 + c);
}

static float alpha_of(int x, int y)
{
    return y == 1 ? 0.0f : (float)(1 + x) / 16.0f;
}

/** Writes an EXR file without a statement on its curve. With alpha, colours are premultiplied. primaries: NULL for none named. */
static void put_exr(const char *name, int has_alpha, const exr_attr_chromaticities_t *primaries, float odd)
{
    static const char *const names[] = {"A", "B", "G", "R"}; /* alphabetical order */
    const exr_attr_box2i_t window = {.min = {{{0, 0}}}, .max = {{{WIDTH - 1, HEIGHT - 1}}}};
    const exr_attr_v2f_t centre = {{{0.0f, 0.0f}}};
    exr_context_t file;
    int part, n = 0;
    assert_int_equal(exr_start_write(&file, in(name), EXR_WRITE_FILE_DIRECTLY, NULL), EXR_ERR_SUCCESS);
    assert_int_equal(exr_add_part(file, "p", EXR_STORAGE_SCANLINE, &part), EXR_ERR_SUCCESS);
    assert_int_equal(exr_initialize_required_attr(file, part, &window, &window, 1.0f, &centre, 1.0f, EXR_LINEORDER_INCREASING_Y,
                                                  EXR_COMPRESSION_NONE),
                     EXR_ERR_SUCCESS);
    for (int i = !has_alpha; i < 4; i++)
        assert_int_equal(exr_add_channel(file, part, names[i], EXR_PIXEL_FLOAT, EXR_PERCEPTUALLY_LINEAR, 1, 1), EXR_ERR_SUCCESS);
    if (primaries)
        assert_int_equal(exr_attr_set_chromaticities(file, part, "chromaticities", primaries), EXR_ERR_SUCCESS);
    assert_int_equal(exr_write_header(file), EXR_ERR_SUCCESS);
    for (int y = 0; y < HEIGHT; y++) {
        float row[4 * WIDTH];
        n = 0;
        for (int i = !has_alpha; i < 4; i++)
            for (int x = 0; x < WIDTH; x++) {
                const float a = has_alpha ? alpha_of(x, y) : 1.0f;
                row[n++] = i ? a * level(3 - i, x, y) : a;
            }
        if (y == 1)
            row[n - 2] = odd == 0.0f ? row[n - 2] : odd; /* R of the last pixel but one */
        assert_int_equal(exr_write_scanline_chunk(file, part, y, row, (uint64_t)n * sizeof *row), EXR_ERR_SUCCESS);
    }
    assert_int_equal(exr_finish(&file), EXR_ERR_SUCCESS);
}

/** Writes a file with our own writer; the samples are multiples of 1/divisor. */
static void put_levels(const char *name, int bits, int channels, uint32_t divisor)
{
    adcgs_image image;
    const adcgs_image_options options = {.bits = bits};
    assert_int_equal(adcgs_image_alloc(&image, WIDTH, HEIGHT, channels, name, &error), ADCGS_OK);
    for (uint32_t i = 0; i < (uint32_t)(PIXELS * channels); i++)
        image.data[i] = (float)(i * 7919u % (divisor + 1u)) / (float)divisor;
    assert_int_equal(adcgs_image_write_as(&image, &options, in(name), &error), ADCGS_OK);
    adcgs_image_free(&image);
}

#define FRAME(name) "{\"file_path\":\"" name "\",\"transform_matrix\":[[1,0,0,0],[0,1,0,0],[0,0,1,4]]}"
#define FRAMES(list) "{\"w\":9,\"h\":3,\"fl_x\":9,\"frames\":[" list "]}"

static void expect_good(adcgs_status status)
{
    if (status != ADCGS_OK)
        fail_msg("%s", error.text);
}

/** The scene's training views are the frames after the first. */
static void open_frames(const char *json)
{
    put_text("transforms.json", json);
    expect_good(adcgs_scene_open(&scene, folder, NULL, &error));
    assert_int_equal(scene->colour_space, 1); /* sRGB, the value that the stream carries */
}

static int close_scene(void **state)
{
    adcgs_scene_free(&scene);
    return 0;
}

static float *load_view(uint32_t view)
{
    float *rgb;
    expect_good(adcgs_scene_image(scene, &scene->views[ADCGS_SPLIT_TRAIN][view], 1, &rgb, NULL, &error));
    return rgb;
}

static void expect_near(double got, double expected)
{
    if (!(fabs(got - expected) <= 2e-6 * (1.0 + fabs(expected))))
        fail_msg("%.9g, expected %.9g", got, expected);
}

static void test_linear(void **state)
{
    put_exr("plain.exr", 0, NULL, 0.0f);
    open_frames(FRAMES(FRAME("plain.exr") "," FRAME("plain.exr")));
    float *rgb = load_view(0);
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < PIXELS; i++)
            expect_near(rgb[c * PIXELS + i], curve(level(c, i % WIDTH, i / WIDTH)));
    free(rgb);
}

/** The correction takes back the stops of each channel. Overexposed pixels become unknown; others are limited to white. */
static void test_stops(void **state)
{
    static const float stops[2][3] = {{1.0f, 0.5f, 2.0f}, {-1.0f, 0.0f, -4.0f}};
    int known = 0, kept = 0, cut = 0;
    put_levels("even.png", 8, 3, 15);
    open_frames(FRAMES(FRAME("even.png") "," FRAME("even.png")));
    float *const taken = load_view(0);
    for (int s = 0; s < 2; s++) {
        memcpy(scene->views[ADCGS_SPLIT_TRAIN][0].stops, stops[s], sizeof stops[s]);
        float *const rgb = load_view(0);
        for (int i = 0; i < PIXELS; i++) {
            const int burnt = !s && (taken[i] >= 0.98f || taken[PIXELS + i] >= 0.98f || taken[2 * PIXELS + i] >= 0.98f);
            known += !burnt && !s;
            for (int c = 0; c < 3; c++) {
                const double even = (double)taken[c * PIXELS + i] * pow(2.0, -(double)stops[s][c]);
                assert_true(!isnan(rgb[c * PIXELS + i]) == !burnt);
                kept += s && even <= 1.0;
                cut += s && even > 1.0;
                if (!burnt)
                    expect_near(rgb[c * PIXELS + i], fmin(even, 1.0));
            }
        }
        free(rgb);
    }
    assert_true(known > 0 && known < PIXELS && kept > 0 && cut > 0);
    free(taken);
}

/** The curve applies to straight colours, and the background comes last, as for every other image. */
static void test_linear_alpha(void **state)
{
    put_exr("alpha.exr", 1, NULL, 0.0f);
    open_frames(FRAMES(FRAME("alpha.exr") "," FRAME("alpha.exr")));
    assert_true(scene->has_alpha && scene->background[0] == 1.0f);
    float *rgb = load_view(0);
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < PIXELS; i++) {
            const double a = alpha_of(i % WIDTH, i / WIDTH);
            expect_near(rgb[c * PIXELS + i], a * curve(level(c, i % WIDTH, i / WIDTH)) + (1.0 - a));
        }
    free(rgb);
}

/** Our own EXR files are labelled sRGB and read back unchanged. */
static void test_labelled(void **state)
{
    put_levels("own.exr", 0, 3, 1000);
    open_frames(FRAMES(FRAME("own.exr") "," FRAME("own.exr")));
    float *rgb = load_view(0);
    for (uint32_t c = 0; c < 3; c++)
        for (uint32_t i = 0; i < PIXELS; i++)
            assert_true(rgb[c * PIXELS + i] == (float)((3 * i + c) * 7919u % 1001u) / 1000.0f);
    free(rgb);
}

/** Images of 16 bits among images of 8: each value is its sample over the largest, also in the trainer's store. */
static void test_sixteen(void **state)
{
    static const char *const names[] = {"8.ppm", "16.ppm", "8.tif", "16.tif", "8.png", "16.png"};
    adcgs_image_store *pictures;
    adcgs_pool *pool;
    const adcgs_image_store_config config = {.split = ADCGS_SPLIT_TRAIN, .divide = 1};
    for (size_t i = 0; i < ADCGS_COUNTOF(names); i++)
        put_levels(names[i], i % 2 ? 16 : 8, 3, i % 2 ? 65535 : 255);
    open_frames(FRAMES(FRAME("8.ppm") "," FRAME("8.ppm") "," FRAME("16.ppm") "," FRAME("8.tif") "," FRAME("16.tif") "," FRAME(
        "8.png") "," FRAME("16.png")));
    assert_int_equal(scene->n_views[ADCGS_SPLIT_TRAIN], ADCGS_COUNTOF(names));
    expect_good(adcgs_pool_create(&pool, 2, &error));
    expect_good(adcgs_image_store_load(&pictures, scene, &config, pool, &error));
    for (uint32_t v = 0; v < ADCGS_COUNTOF(names); v++) {
        const uint32_t divisor = v % 2 ? 65535 : 255;
        float *rgb = load_view(v), kept[3 * PIXELS];
        expect_good(adcgs_image_store_get(pictures, v, kept, &error));
        for (uint32_t c = 0; c < 3; c++)
            for (uint32_t i = 0; i < PIXELS; i++) {
                const double expected = (double)((3 * i + c) * 7919u % (divisor + 1)) / divisor;
                assert_true(fabs((double)rgb[c * PIXELS + i] - expected) < 1e-7);
                assert_true(fabs((double)kept[c * PIXELS + i] - expected) < 1e-7);
            }
        free(rgb);
    }
    adcgs_image_store_free(&pictures);
    adcgs_pool_free(&pool);
}

/** 16 bits with alpha: straight in the file, then composited over the background. */
static void test_sixteen_alpha(void **state)
{
    static const char *const names[] = {"a.png", "a.tif"};
    const adcgs_scene_options options = {.has_background = 1, .background = {0.25f, 0.5f, 0.75f}};
    for (size_t k = 0; k < ADCGS_COUNTOF(names); k++)
        put_levels(names[k], 16, 4, 65535);
    put_text("transforms.json", FRAMES(FRAME("a.png") "," FRAME("a.png") "," FRAME("a.tif")));
    expect_good(adcgs_scene_open(&scene, folder, &options, &error));
    for (uint32_t v = 0; v < 2; v++) {
        float *rgb = load_view(v);
        for (uint32_t c = 0; c < 3; c++)
            for (uint32_t i = 0; i < PIXELS; i++) {
                const double a = (double)((4 * i + 3) * 7919u % 65536u) / 65535, b = (double)options.background[c];
                const double expected = a * ((4 * i + c) * 7919u % 65536u) / 65535 + (1 - a) * b;
                /* TIFF keeps premultiplied colours, in 16 bits */
                assert_true(fabs((double)rgb[c * PIXELS + i] - expected) < 2e-5);
            }
        free(rgb);
    }
}

static void expect_refused(const char *name, adcgs_status status, const char *what)
{
    adcgs_image image;
    expect_error(adcgs_image_read(&image, in(name), &error), status, name, what);
    assert_null(image.data);
}

static void test_refused(void **state)
{
    const exr_attr_chromaticities_t bt709 = {0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f};
    const exr_attr_chromaticities_t acescg = {0.713f, 0.293f, 0.165f, 0.83f, 0.128f, 0.044f, 0.32168f, 0.33767f};
    adcgs_image image;
    put_exr("nan.exr", 0, NULL, NAN);
    expect_refused("nan.exr", ADCGS_ERR_DATA, "pixel 7 of row 1 is not a finite number");
    put_exr("inf.exr", 1, NULL, INFINITY);
    expect_refused("inf.exr", ADCGS_ERR_DATA, "pixel 7 of row 1 is not a finite number");
    put_exr("aces.exr", 0, &acescg, 0.0f);
    expect_refused("aces.exr", ADCGS_ERR_UNSUPPORTED, "not those of BT.709");
    put_exr("named.exr", 0, &bt709, 0.0f);
    expect_good(adcgs_image_read(&image, in("named.exr"), &error));
    expect_near(image.data[3 * 4], curve(0.18));
    adcgs_image_free(&image);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(test_stops, close_scene),
        cmocka_unit_test_teardown(test_linear, close_scene),
        cmocka_unit_test_teardown(test_linear_alpha, close_scene),
        cmocka_unit_test_teardown(test_labelled, close_scene),
        cmocka_unit_test_teardown(test_sixteen, close_scene),
        cmocka_unit_test_teardown(test_sixteen_alpha, close_scene),
        cmocka_unit_test(test_refused),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

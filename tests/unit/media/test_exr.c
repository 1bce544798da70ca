/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * EXR with alpha, depth and a camera, on sRGB's curve and in linear light: read back through our own reader, and channel by
 * channel and attribute by attribute through OpenEXRCore. Alpha and 16 bits in the other formats.
 */
#include "outside_files.h"

#include "media/image/image.h"
#include "media/sink.h"

#include <math.h>
#include <openexr.h>

#define WIDTH 37
#define HEIGHT 21
#define PIXELS (WIDTH * HEIGHT)

static float rgb[3 * PIXELS], alpha[PIXELS], depth[PIXELS];
static adcgs_camera camera =
    {.width = WIDTH, .height = HEIGHT, .fx = 40.0, .fy = 44.0, .cx = 17.0, .cy = 12.5, .near_plane = 0.25, .name = "eye"};

/** Premultiplied colours; a camera turned about two axes. */
static void fill(void)
{
    const double a = 0.7, b = -0.4;
    const double pose[12] = {cos(a), -sin(a) * cos(b), sin(a) * sin(b), 1.5, sin(a), cos(a) * cos(b), -cos(a) * sin(b), -2.0,
                             0.0,    sin(b),           cos(b),          0.75};
    memcpy(camera.cam_to_world, pose, sizeof pose);
    for (int i = 0; i < PIXELS; i++) {
        alpha[i] = (float)(i % 11) / 10.0f;
        depth[i] = i % 11 ? 1.0f + 0.001f * (float)i : 1e10f;
        for (int c = 0; c < 3; c++)
            rgb[3 * i + c] = alpha[i] * (float)((i * 7 + c * 31) % 101) / 100.0f;
    }
}

static adcgs_status write_curve(const char *name, adcgs_depth kind, int has_alpha, int has_z, int linear)
{
    const adcgs_frame frame = {WIDTH, HEIGHT, rgb};
    const adcgs_sink_config config = {.target = in(name),
                                      .depth = kind,
                                      .linear = linear,
                                      .width = WIDTH,
                                      .height = HEIGHT,
                                      .frames = 1,
                                      .has_alpha = has_alpha,
                                      .has_z = has_z};
    const adcgs_sink_extras extras = {has_alpha ? alpha : NULL, has_z ? depth : NULL, &camera, 1.25};
    adcgs_sink *sink;
    ADCGS_TRY(adcgs_sink_open(&sink, &config, &error));
    const adcgs_status status = adcgs_sink_write_with(sink, &frame, &extras, 0, &error);
    if (status != ADCGS_OK)
        adcgs_sink_abort(&sink);
    return status == ADCGS_OK ? adcgs_sink_close(&sink, &error) : status;
}

static adcgs_status write_as(const char *name, adcgs_depth kind, int has_alpha, int has_z)
{
    return write_curve(name, kind, has_alpha, has_z, 0);
}

/** Reads a channel, every sample as binary32. It reads the others too: OpenEXRCore 3.1 does not always skip some of them. */
static void read_channel(const char *path, const char *name, exr_pixel_type_t type, float *out)
{
    static float others[PIXELS];
    exr_context_t file;
    exr_decode_pipeline_t pipe = EXR_DECODE_PIPELINE_INITIALIZER;
    int started = 0, found = 0, lines;
    assert_int_equal(exr_start_read(&file, path, NULL), EXR_ERR_SUCCESS);
    assert_int_equal(exr_get_scanlines_per_chunk(file, 0, &lines), EXR_ERR_SUCCESS);
    for (int y = 0; y < HEIGHT; y += lines) {
        exr_chunk_info_t chunk;
        assert_int_equal(exr_read_scanline_chunk_info(file, 0, y, &chunk), EXR_ERR_SUCCESS);
        assert_int_equal(started ? exr_decoding_update(file, 0, &chunk, &pipe) : exr_decoding_initialize(file, 0, &chunk, &pipe),
                         EXR_ERR_SUCCESS);
        for (int c = 0; c < pipe.channel_count; c++) {
            exr_coding_channel_info_t *channel = &pipe.channels[c];
            const int wanted = !strcmp(channel->channel_name, name);
            channel->decode_to_ptr = (uint8_t *)((wanted ? out : others) + y * WIDTH);
            channel->user_bytes_per_element = 4;
            channel->user_data_type = EXR_PIXEL_FLOAT;
            channel->user_pixel_stride = 4;
            channel->user_line_stride = 4 * WIDTH;
            found |= wanted && channel->data_type == type;
        }
        if (!started)
            assert_int_equal(exr_decoding_choose_default_routines(file, 0, &pipe), EXR_ERR_SUCCESS);
        started = 1;
        assert_int_equal(exr_decoding_run(file, 0, &pipe), EXR_ERR_SUCCESS);
    }
    assert_true(found);
    exr_decoding_destroy(file, &pipe);
    exr_finish(&file);
}

/** The formula of IEC 61966-2-1, for straight colours. */
static double linear_light(double v)
{
    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

/** The stored value of a colour channel; without alpha its factor is 1. */
static double stored(int i, int c, int has_alpha, int linear)
{
    const double value = rgb[3 * i + c], part = has_alpha && alpha[i] > 0.0f ? (double)alpha[i] : 1.0;
    return linear ? part * linear_light(value / part) : value;
}

/** A half rounds to 11 bits, and to multiples of 2^-24 near 0; error is relative. */
static void expect_sample(double got, double expected, int half, double error_before)
{
    const double tolerance = fabs(expected) * ((half ? 0x1p-11 : 0.0) + error_before) + (half ? 0x1p-25 : 0.0);
    if (!(fabs(got - expected) <= tolerance))
        fail_msg("%.9g, expected %.9g", got, expected);
}

static void check_colours(const char *name, int half, int has_alpha, int linear)
{
    static float plane[PIXELS];
    for (int c = 0; c < 3; c++) {
        const char channel[2] = {"RGB"[c], 0};
        read_channel(in(name), channel, half ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT, plane);
        for (int i = 0; i < PIXELS; i++)
            expect_sample(plane[i], stored(i, c, has_alpha, linear), half, linear ? 1e-6 : 0.0);
    }
}

static void check_channels(const char *name, int half, int linear)
{
    static float plane[PIXELS];
    check_colours(name, half, 1, linear);
    read_channel(in(name), "A", half ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT, plane);
    for (int i = 0; i < PIXELS; i++)
        expect_sample(plane[i], alpha[i], half, 0.0);
    read_channel(in(name), "Z", EXR_PIXEL_FLOAT, plane);
    assert_memory_equal(plane, depth, sizeof depth);
}

/** Expects straight colours from our reader. Z is skipped, and never taken for alpha. */
static void check_image(const char *name, int channels, double tolerance)
{
    adcgs_image image;
    int width, height, stored;
    assert_int_equal(adcgs_image_probe(&width, &height, &stored, in(name), &error), ADCGS_OK);
    assert_int_equal(adcgs_image_read(&image, in(name), &error), ADCGS_OK);
    assert_true(width == WIDTH && height == HEIGHT && stored == channels && image.channels == channels);
    for (int i = 0; i < PIXELS; i++)
        for (int c = 0; c < channels; c++) {
            const float part = channels == 4 && alpha[i] > 0.0f ? alpha[i] : 1.0f;
            const float expected = c == 3 ? alpha[i] : rgb[3 * i + c] / part;
            assert_true(fabs(image.data[channels * i + c] - expected) <= tolerance);
        }
    adcgs_image_free(&image);
}

static void test_channels(void **state)
{
    fill();
    assert_int_equal(write_as("f.exr", ADCGS_DEPTH_FLOAT, 1, 1), ADCGS_OK);
    check_channels("f.exr", 0, 0);
    check_image("f.exr", 4, 1e-6);
    assert_int_equal(write_as("h.exr", ADCGS_DEPTH_HALF, 1, 1), ADCGS_OK);
    check_channels("h.exr", 1, 0);
    check_image("h.exr", 4, 3e-3);
    assert_int_equal(write_as("z.exr", ADCGS_DEPTH_FLOAT, 0, 1), ADCGS_OK);
    check_image("z.exr", 3, 0.0);
    assert_int_equal(write_as("c.exr", ADCGS_DEPTH_FLOAT, 0, 0), ADCGS_OK);
    check_image("c.exr", 3, 0.0);
}

/** As fill(), with colours from -0.5 to 1.5 times alpha. */
static void fill_beyond(void)
{
    fill();
    for (int i = 0; i < PIXELS; i++)
        for (int c = 0; c < 3; c++)
            rgb[3 * i + c] = alpha[i] * ((float)((i * 7 + c * 31) % 101) / 50.0f - 0.5f);
}

/** Straight colours go through the curve; alpha and depth stay unchanged; our reader inverts the curve. */
static void test_linear(void **state)
{
    fill_beyond();
    assert_int_equal(write_curve("lf.exr", ADCGS_DEPTH_FLOAT, 1, 1, 1), ADCGS_OK);
    check_channels("lf.exr", 0, 1);
    check_image("lf.exr", 4, 3e-6);
    assert_int_equal(write_curve("lh.exr", ADCGS_DEPTH_HALF, 1, 1, 1), ADCGS_OK);
    check_channels("lh.exr", 1, 1);
    check_image("lh.exr", 4, 2e-3);
    assert_int_equal(write_curve("lc.exr", ADCGS_DEPTH_FLOAT, 0, 0, 1), ADCGS_OK);
    check_colours("lc.exr", 0, 0, 1);
    check_image("lc.exr", 3, 3e-6);
    assert_int_equal(write_curve("ld.exr", ADCGS_DEPTH_DEFAULT, 0, 1, 1), ADCGS_OK);
    check_colours("ld.exr", 1, 0, 1);
    check_image("ld.exr", 3, 1e-3);
}

/** Straight colours are premultiplied when they are written. */
static void test_linear_straight(void **state)
{
    static float straight[4 * PIXELS], kept[4 * PIXELS];
    const adcgs_image image = {WIDTH, HEIGHT, 4, straight};
    const adcgs_image_options options = {.linear = 1};
    fill_beyond();
    for (int i = 0; i < PIXELS; i++)
        for (int c = 0; c < 4; c++)
            straight[4 * i + c] = c == 3 ? alpha[i] : alpha[i] > 0.0f ? rgb[3 * i + c] / alpha[i] : 0.0f;
    memcpy(kept, straight, sizeof kept);
    assert_int_equal(adcgs_image_write_as(&image, &options, in("ls.exr"), &error), ADCGS_OK);
    assert_memory_equal(kept, straight, sizeof kept);
    check_colours("ls.exr", 0, 1, 1);
    check_image("ls.exr", 4, 3e-6);
}

/* ---- Attributes ---- */

static const exr_attribute_t *attribute(exr_context_t file, const char *name, exr_attribute_type_t type)
{
    const exr_attribute_t *found;
    assert_int_equal(exr_get_attribute_by_name(file, 0, name, &found), EXR_ERR_SUCCESS);
    assert_int_equal(found->type, type);
    return found;
}

/** The row (point, 1) times a matrix. */
static void transform(const double point[3], const exr_attr_m44f_t *m, double out[4])
{
    for (int j = 0; j < 4; j++) {
        out[j] = m->m[12 + j];
        for (int i = 0; i < 3; i++)
            out[j] += point[i] * m->m[4 * i + j];
    }
}

/** Projects points in front of the camera to the same place as the camera of camera.h. */
static void check_matrices(const exr_attr_m44f_t *to_camera, const exr_attr_m44f_t *to_ndc)
{
    for (int n = 0; n < 50; n++) {
        const double own[3] = {0.3 * (n % 7 - 3), 0.2 * (n % 5 - 2), 0.25 + n % 9}; /* x right, y down, z forward */
        const double u = camera.fx * own[0] / own[2] + camera.cx, v = camera.fy * own[1] / own[2] + camera.cy;
        double world[3], seen[4], ndc[4];
        for (int i = 0; i < 3; i++) {
            world[i] = camera.cam_to_world[4 * i + 3];
            for (int j = 0; j < 3; j++)
                world[i] += camera.cam_to_world[4 * i + j] * own[j];
        }
        transform(world, to_camera, seen);
        assert_true(fabs(seen[0] - own[0]) < 1e-5 && fabs(seen[1] + own[1]) < 1e-5 && fabs(seen[2] - own[2]) < 1e-5);
        assert_true(seen[3] == 1.0);
        transform(world, to_ndc, ndc);
        assert_true(fabs(ndc[3] - own[2]) < 1e-5);
        assert_true(fabs(ndc[0] / ndc[3] - u / WIDTH) < 1e-5 && fabs(ndc[1] / ndc[3] - v / HEIGHT) < 1e-5);
        assert_true(fabs(ndc[2] / ndc[3] - (1.0 - camera.near_plane / own[2])) < 1e-5);
    }
}

static void test_attributes(void **state)
{
    exr_context_t file;
    fill();
    assert_int_equal(write_as("a.exr", ADCGS_DEPTH_HALF, 1, 1), ADCGS_OK);
    assert_int_equal(exr_start_read(&file, in("a.exr"), NULL), EXR_ERR_SUCCESS);
    check_matrices(attribute(file, "worldToCamera", EXR_ATTR_M44F)->m44f, attribute(file, "worldToNDC", EXR_ATTR_M44F)->m44f);
    /* The window's edges at distance 1, with x to the left and y up, are the edges of the camera's image. */
    const exr_attr_v2f_t *centre = attribute(file, "screenWindowCenter", EXR_ATTR_V2F)->v2f;
    const double width = attribute(file, "screenWindowWidth", EXR_ATTR_FLOAT)->f;
    assert_true(fabs(centre->x + 0.5 * width - camera.cx / camera.fx) < 1e-6);
    assert_true(fabs(centre->x - 0.5 * width - (camera.cx - WIDTH) / camera.fx) < 1e-6);
    assert_true(fabs(centre->y - (camera.cy - 0.5 * HEIGHT) / camera.fy) < 1e-6);
    assert_true(fabs(attribute(file, "pixelAspectRatio", EXR_ATTR_FLOAT)->f - camera.fy / camera.fx) < 1e-6);
    const exr_attr_v2d_t *focal = attribute(file, "adcgs/focal", EXR_ATTR_V2D)->v2d;
    const exr_attr_v2d_t *principal = attribute(file, "adcgs/principal", EXR_ATTR_V2D)->v2d;
    assert_true(focal->x == camera.fx && focal->y == camera.fy && principal->x == camera.cx && principal->y == camera.cy);
    assert_true(attribute(file, "adcgs/time", EXR_ATTR_DOUBLE)->d == 1.25);
    assert_true(attribute(file, "adcgs/near", EXR_ATTR_DOUBLE)->d == 0.25);
    assert_string_equal(attribute(file, "adcgs/camera", EXR_ATTR_STRING)->string->str, "eye");
    assert_non_null(strstr(attribute(file, "software", EXR_ATTR_STRING)->string->str, PACKAGE_VERSION));
    exr_finish(&file);
    /* A camera without a name is valid. */
    camera.name[0] = 0;
    assert_int_equal(write_as("n.exr", ADCGS_DEPTH_FLOAT, 0, 0), ADCGS_OK);
    strcpy(camera.name, "eye");
}

static float aspect_of(const char *name)
{
    exr_context_t file;
    assert_int_equal(exr_start_read(&file, in(name), NULL), EXR_ERR_SUCCESS);
    const float aspect = attribute(file, "pixelAspectRatio", EXR_ATTR_FLOAT)->f;
    exr_finish(&file);
    return aspect;
}

/** A focal length of half as many pixels in x means pixels twice as wide as high. Without a camera pixels are square. */
static void test_aspect(void **state)
{
    const double focal = camera.fx;
    adcgs_image image;
    fill();
    camera.fx = 0.5 * camera.fy;
    assert_int_equal(write_as("wide.exr", ADCGS_DEPTH_HALF, 0, 0), ADCGS_OK);
    assert_true(aspect_of("wide.exr") == 2.0f);
    camera.fx = camera.fy;
    assert_int_equal(write_as("square.exr", ADCGS_DEPTH_HALF, 0, 0), ADCGS_OK);
    assert_true(aspect_of("square.exr") == 1.0f);
    camera.fx = 1e9 * camera.fy; /* beyond the format's range */
    assert_int_equal(write_as("thin.exr", ADCGS_DEPTH_HALF, 0, 0), ADCGS_OK);
    assert_true(aspect_of("thin.exr") > 0.0f);
    camera.fx = focal;
    assert_int_equal(adcgs_image_read(&image, in("square.exr"), &error), ADCGS_OK);
    assert_int_equal(adcgs_image_write(&image, in("none.exr"), 0, &error), ADCGS_OK);
    assert_true(aspect_of("none.exr") == 1.0f);
    adcgs_image_free(&image);
}

/** The file states the meaning of its samples: sRGB's curve, or linear light and its primaries. */
static void test_curve_named(void **state)
{
    exr_context_t file;
    const exr_attribute_t *none;
    fill();
    assert_int_equal(write_as("s.exr", ADCGS_DEPTH_HALF, 0, 0), ADCGS_OK);
    assert_int_equal(exr_start_read(&file, in("s.exr"), NULL), EXR_ERR_SUCCESS);
    assert_string_equal(attribute(file, "oiio:ColorSpace", EXR_ATTR_STRING)->string->str, "sRGB");
    assert_int_equal(exr_get_attribute_by_name(file, 0, "chromaticities", &none), EXR_ERR_NO_ATTR_BY_NAME);
    exr_finish(&file);
    assert_int_equal(write_curve("l.exr", ADCGS_DEPTH_HALF, 0, 0, 1), ADCGS_OK);
    assert_int_equal(exr_start_read(&file, in("l.exr"), NULL), EXR_ERR_SUCCESS);
    assert_string_equal(attribute(file, "oiio:ColorSpace", EXR_ATTR_STRING)->string->str, "Linear");
    const exr_attr_chromaticities_t *c = attribute(file, "chromaticities", EXR_ATTR_CHROMATICITIES)->chromaticities;
    assert_true(c->red_x == 0.64f && c->red_y == 0.33f && c->green_x == 0.3f && c->green_y == 0.6f);
    assert_true(c->blue_x == 0.15f && c->blue_y == 0.06f && c->white_x == 0.3127f && c->white_y == 0.329f);
    exr_finish(&file);
}

/* ---- Other formats ---- */

static void test_sixteen_bits(void **state)
{
    const float values[] = {-1.0f, 0.0f, 0.5f, 1.0f, 2.0f, NAN, 1.4f / 65535.0f, 1.6f / 65535.0f, INFINITY};
    const uint16_t expected[] = {0, 0, 32768, 65535, 65535, 0, 1, 2, 65535};
    uint16_t got[ADCGS_COUNTOF(values)];
    fill();
    adcgs_image_to_u16(values, ADCGS_COUNTOF(values), got);
    assert_memory_equal(got, expected, sizeof got);
    assert_int_equal(write_as("s.ppm", ADCGS_DEPTH_16, 0, 0), ADCGS_OK);
    check_image("s.ppm", 3, 0.50001 / 65535);
    assert_int_equal(write_as("s.tif", ADCGS_DEPTH_16, 0, 0), ADCGS_OK);
    check_image("s.tif", 3, 0.51 / 65535);
    assert_int_equal(write_as("t.tif", ADCGS_DEPTH_16, 1, 0), ADCGS_OK);
    check_image("t.tif", 4, 0.51 / 65535);
    assert_int_equal(write_as("u.tif", ADCGS_DEPTH_DEFAULT, 1, 0), ADCGS_OK);
    check_image("u.tif", 4, 0.51 / 255);
    const adcgs_status status = write_as("s.png", ADCGS_DEPTH_16, 1, 0);
    if (status == ADCGS_ERR_UNSUPPORTED)
        skip();
    check_image("s.png", 4, 0.51 / 65535);
}

static void test_refused(void **state)
{
    fill();
    expect_error(write_as("r.png", ADCGS_DEPTH_DEFAULT, 0, 1), ADCGS_ERR_USAGE, "r.png", "depth needs EXR");
    expect_error(write_as("r.ppm", ADCGS_DEPTH_DEFAULT, 1, 0), ADCGS_ERR_USAGE, "r.ppm", "alpha needs");
    expect_error(write_as("r.y4m", ADCGS_DEPTH_DEFAULT, 1, 0), ADCGS_ERR_USAGE, "r.y4m", "alpha needs");
    expect_error(write_as("r.y4m", ADCGS_DEPTH_16, 0, 0), ADCGS_ERR_USAGE, "r.y4m", "16 bits need");
    expect_error(write_as("r.exr", ADCGS_DEPTH_16, 0, 0), ADCGS_ERR_USAGE, "r.exr", "16 bits need");
    expect_error(write_curve("r.png", ADCGS_DEPTH_DEFAULT, 0, 0, 1), ADCGS_ERR_USAGE, "r.png", "linear light needs EXR");
    const adcgs_status status = write_as("r.jpg", ADCGS_DEPTH_16, 0, 0);
    if (status != ADCGS_ERR_UNSUPPORTED) {
        expect_error(status, ADCGS_ERR_USAGE, "r.jpg", "16 bits");
        expect_error(write_as("r.jpg", ADCGS_DEPTH_DEFAULT, 1, 0), ADCGS_ERR_USAGE, "r.jpg", "alpha");
    }
    const adcgs_image image = {WIDTH, HEIGHT, 3, rgb};
    const adcgs_image_options odd = {.bits = 12}, deep = {.depth = depth}, linear = {.linear = 1};
    expect_error(adcgs_image_write_as(&image, &odd, in("r.png"), &error), ADCGS_ERR_USAGE, "r.png", "12 bits");
    expect_error(adcgs_image_write_as(&image, &deep, in("r.png"), &error), ADCGS_ERR_USAGE, "r.png", "depth");
    expect_error(adcgs_image_write_as(&image, &linear, in("r.png"), &error), ADCGS_ERR_USAGE, "r.png", "linear light");
    assert_true(access(in("r.png"), F_OK) != 0 && access(in("r.jpg"), F_OK) != 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_channels),     cmocka_unit_test(test_linear),  cmocka_unit_test(test_linear_straight),
        cmocka_unit_test(test_attributes),   cmocka_unit_test(test_aspect),  cmocka_unit_test(test_curve_named),
        cmocka_unit_test(test_sixteen_bits), cmocka_unit_test(test_refused),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The variants of PNG and JPEG through our readers: known values, and the results of OpenImageIO for the same files. */
#include "outside_files.h"

#include "media/image/image.h"
#include "media/image/oiio_shim.h"
#include "scene/layouts/open.h"

#include <math.h>
#include <sys/resource.h>

#include <spng.h>
#include <turbojpeg.h>

#define WIDTH 19
#define HEIGHT 7
#define PIXELS (WIDTH * HEIGHT)

static adcgs_image image;

static void read_good(const char *name, int channels)
{
    int width = 0, height = 0, probed = 0;
    if (adcgs_image_read(&image, in(name), &error) != ADCGS_OK ||
        adcgs_image_probe(&width, &height, &probed, in(name), &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    assert_true(width == image.width && height == image.height && probed == image.channels);
    assert_int_equal(image.channels, channels);
}

/** OpenImageIO's reader is independent of ours. Where it is available, both agree; its 16 bits may round differently. */
static void expect_as_by_oiio(const char *name)
{
    const adcgs_oiio *oiio;
    adcgs_image other;
    if (adcgs_oiio_get(&oiio, in(name), &error) != ADCGS_OK)
        return;
    FILE *const file = fopen(in(name), "rb");
    assert_non_null(file);
    const adcgs_status status = oiio->read(&other, file, strstr(name, ".png") ? "png" : "jpeg", in(name), &error);
    fclose(file);
    if (status == ADCGS_ERR_UNSUPPORTED)
        return;
    assert_int_equal(status, ADCGS_OK);
    assert_true(other.width == image.width && other.height == image.height && other.channels == image.channels);
    for (int i = 0; i < image.width * image.height * image.channels; i++)
        if (fabs((double)other.data[i] - (double)image.data[i]) > 1.01 / 255 / 256)
            fail_msg("%s: value %d is %g, OpenImageIO gives %g", name, i, (double)image.data[i], (double)other.data[i]);
    adcgs_image_free(&other);
}

static void done(const char *name)
{
    expect_as_by_oiio(name);
    adcgs_image_free(&image);
}

/* ---- PNG ---- */

/** The contents of a file; samples are those of the format, in the host's order. */
typedef struct recipe {
    int bits, type;
    const struct spng_plte *palette;
    const struct spng_trns *transparent;
    uint32_t gamma; /**< times 100000; 0: none */
    int srgb;
} recipe;

static void put_png(const char *name, const recipe *r, const void *samples, size_t bytes)
{
    struct spng_ihdr head = {.width = WIDTH, .height = HEIGHT, .bit_depth = (uint8_t)r->bits, .color_type = (uint8_t)r->type};
    struct spng_plte palette;
    struct spng_trns transparent;
    int code;
    size_t size;
    spng_ctx *png = spng_ctx_new(SPNG_CTX_ENCODER);
    assert_int_equal(spng_set_option(png, SPNG_ENCODE_TO_BUFFER, 1), 0);
    assert_int_equal(spng_set_ihdr(png, &head), 0);
    if (r->palette) {
        palette = *r->palette;
        assert_int_equal(spng_set_plte(png, &palette), 0);
    }
    if (r->transparent) {
        transparent = *r->transparent;
        assert_int_equal(spng_set_trns(png, &transparent), 0);
    }
    if (r->gamma)
        assert_int_equal(spng_set_gama_int(png, r->gamma), 0);
    if (r->srgb)
        assert_int_equal(spng_set_srgb(png, 0), 0);
    assert_int_equal(spng_encode_image(png, samples, bytes, SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE), 0);
    void *file = spng_get_png_buffer(png, &size, &code);
    assert_non_null(file);
    put_bytes(name, file, size);
    free(file);
    spng_ctx_free(png);
}

/** Grey of 1, 2 and 4 bits: levels from 0 to 1, the lowest and the highest among them. */
static void test_few_bits(void **state)
{
    for (int bits = 1; bits <= 4; bits *= 2) {
        const int top = (1 << bits) - 1, per_byte = 8 / bits, row = (WIDTH + per_byte - 1) / per_byte;
        uint8_t packed[HEIGHT * WIDTH] = {0};
        for (int i = 0; i < PIXELS; i++) {
            const int x = i % WIDTH, level = i % (top + 1);
            packed[i / WIDTH * row + x / per_byte] |= (uint8_t)(level << (8 - bits - x % per_byte * bits));
        }
        put_png("few.png", &(recipe){.bits = bits}, packed, (size_t)(row * HEIGHT));
        read_good("few.png", 1);
        for (int i = 0; i < PIXELS; i++)
            assert_true(image.data[i] == (float)(i % (top + 1) * (255 / top)) / 255.0f);
        done("few.png");
    }
}

static const struct spng_plte colours = {3, {{255, 0, 10, 0}, {1, 2, 3, 0}, {200, 100, 50, 0}}};

static void test_palette(void **state)
{
    const struct spng_trns some = {.n_type3_entries = 2, .type3_alpha = {0, 51}};
    uint8_t index[PIXELS];
    for (int i = 0; i < PIXELS; i++)
        index[i] = (uint8_t)(i % 3);
    for (int alpha = 0; alpha < 2; alpha++) {
        put_png("p.png", &(recipe){.bits = 8, .type = 3, .palette = &colours, .transparent = alpha ? &some : NULL}, index,
                sizeof index);
        read_good("p.png", 3 + alpha);
        for (int i = 0; i < PIXELS; i++) {
            const float *pixel = image.data + i * image.channels;
            const struct spng_plte_entry *entry = &colours.entries[i % 3];
            assert_true(pixel[0] == (float)entry->red / 255.0f && pixel[1] == (float)entry->green / 255.0f);
            assert_true(pixel[2] == (float)entry->blue / 255.0f);
            assert_true(!alpha || pixel[3] == (i % 3 == 0 ? 0.0f : i % 3 == 1 ? 0.2f : 1.0f));
        }
        done("p.png");
    }
}

/** One level, or one colour, that is transparent, at 8 and 16 bits. */
static void test_transparent(void **state)
{
    for (int type = 0; type <= 2; type += 2)
        for (int bits = 8; bits <= 16; bits += 8) {
            const struct spng_trns key = {.gray = 7, .red = 7, .green = 7, .blue = 7};
            const int n = type ? 3 : 1;
            uint8_t narrow[3 * PIXELS];
            uint16_t wide[3 * PIXELS];
            for (int i = 0; i < PIXELS * n; i++) {
                wide[i] = (uint16_t)(i / n % 5 == 2 ? 7 : bits == 16 ? 60000 - i : 250 - i % 200);
                narrow[i] = (uint8_t)wide[i];
            }
            put_png("t.png", &(recipe){.bits = bits, .type = type, .transparent = &key}, bits == 16 ? (void *)wide : narrow,
                    (size_t)(PIXELS * n * bits / 8));
            read_good("t.png", n + 1);
            for (int i = 0; i < PIXELS; i++) {
                assert_true(image.data[i * (n + 1) + n] == (i % 5 == 2 ? 0.0f : 1.0f));
                assert_true(image.data[i * (n + 1)] == (float)wide[i * n] / (bits == 16 ? 65535.0f : 255.0f));
            }
            done("t.png");
        }
}

static void test_wide(void **state)
{
    static const int types[4] = {0, 4, 2, 6};
    uint16_t samples[4 * PIXELS];
    for (int i = 0; i < 4 * PIXELS; i++)
        samples[i] = (uint16_t)(i * 7919);
    for (int n = 1; n <= 4; n++) {
        put_png("w.png", &(recipe){.bits = 16, .type = types[n - 1]}, samples, (size_t)(2 * n * PIXELS));
        read_good("w.png", n);
        for (int i = 0; i < n * PIXELS; i++)
            assert_true(image.data[i] == (float)samples[i] / 65535.0f);
        done("w.png");
    }
}

static double curve(double v)
{
    return v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1 / 2.4) - 0.055;
}

/** gAMA of 1 means linear light; sRGB overrules it; other exponents are taken for sRGB's curve. */
static void test_gamma(void **state)
{
    static const struct {
        uint32_t gamma;
        int srgb, linear;
    } cases[] = {{0, 0, 0}, {100000, 0, 1}, {45455, 0, 0}, {100000, 1, 0}, {45455, 1, 0}};
    uint16_t samples[PIXELS];
    for (int i = 0; i < PIXELS; i++)
        samples[i] = (uint16_t)(i * 65535 / (PIXELS - 1));
    for (size_t k = 0; k < ADCGS_COUNTOF(cases); k++) {
        put_png("g.png", &(recipe){.bits = 16, .gamma = cases[k].gamma, .srgb = cases[k].srgb}, samples, sizeof samples);
        read_good("g.png", 1);
        for (int i = 0; i < PIXELS; i++) {
            const double stored = samples[i] / 65535.0, expected = cases[k].linear ? curve(stored) : stored;
            assert_true(fabs((double)image.data[i] - expected) < 2e-6);
        }
        done("g.png");
    }
}

/** Five by five levels of grey, 50 y + 7 x, with the rows of Adam7. */
static void test_interlaced(void **state)
{
    static const uint8_t file[] = {0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44,
                                   0x52, 0x00, 0x00, 0x00, 0x05, 0x00, 0x00, 0x00, 0x05, 0x08, 0x00, 0x00, 0x00, 0x01, 0xdf,
                                   0x03, 0x49, 0xaf, 0x00, 0x00, 0x00, 0x2d, 0x49, 0x44, 0x41, 0x54, 0x78, 0xda, 0x63, 0x60,
                                   0x60, 0x90, 0x61, 0x38, 0xf1, 0x84, 0x81, 0x8f, 0xe1, 0x1a, 0x43, 0x4a, 0x51, 0x03, 0x03,
                                   0xbb, 0x28, 0x43, 0x76, 0x25, 0xc3, 0xf9, 0xbb, 0x0c, 0x46, 0x96, 0x0e, 0xee, 0x7e, 0x0c,
                                   0xd3, 0xe6, 0x2e, 0x59, 0xbd, 0x09, 0x00, 0xa8, 0x33, 0x0b, 0x23, 0xb3, 0x87, 0x28, 0x28,
                                   0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
    put_bytes("i.png", file, sizeof file);
    read_good("i.png", 1);
    assert_true(image.width == 5 && image.height == 5);
    for (int i = 0; i < 25; i++)
        assert_true(image.data[i] == (float)(50 * (i / 5) + 7 * (i % 5)) / 255.0f);
    done("i.png");
}

/** A PNG file named like another format is read as PNG, and likewise a JPEG file. */
static void test_names(void **state)
{
    uint8_t samples[PIXELS] = {0};
    put_png("png.jpg", &(recipe){.bits = 8}, samples, sizeof samples);
    read_good("png.jpg", 1);
    adcgs_image_free(&image);
}

#define SIDE 6000

static long peak_kib(void)
{
    struct rusage usage;
    assert_int_equal(getrusage(RUSAGE_SELF, &usage), 0);
    return usage.ru_maxrss;
}

/** Reducing a large image while reading takes memory for a few rows only: 36 million pixels are 144 MB as binary32. */
static void test_large(void **state)
{
    struct spng_ihdr head = {.width = SIDE, .height = SIDE, .bit_depth = 8, .color_type = SPNG_COLOR_TYPE_GRAYSCALE};
    adcgs_scene *scene;
    adcgs_camera camera;
    float *rgb;
    uint8_t *const row = malloc(SIDE);
    FILE *const file = fopen(in("large.png"), "wb");
    spng_ctx *png = spng_ctx_new(SPNG_CTX_ENCODER);
    assert_true(row && file && png && !spng_set_png_file(png, file) && !spng_set_ihdr(png, &head));
    assert_int_equal(spng_set_option(png, SPNG_IMG_COMPRESSION_LEVEL, 1), 0);
    assert_int_equal(spng_set_option(png, SPNG_FILTER_CHOICE, SPNG_FILTER_CHOICE_NONE), 0);
    assert_int_equal(spng_encode_image(png, NULL, 0, SPNG_FMT_PNG, SPNG_ENCODE_PROGRESSIVE | SPNG_ENCODE_FINALIZE), 0);
    for (int y = 0, code = 0; y < SIDE; y++) {
        memset(row, y / 8 % 2 ? 255 : 51, SIDE); /* alternate rows of the reduced image */
        code = spng_encode_row(png, row, SIDE);
        assert_true(code == (y + 1 < SIDE ? 0 : SPNG_EOI));
    }
    spng_ctx_free(png);
    fclose(file);
    free(row);
    put_text("transforms.json", "{\"camera_angle_x\":0.8,\"w\":6000,\"h\":6000,\"frames\":[{\"file_path\":\"large.png\","
                                "\"transform_matrix\":[[1,0,0,0],[0,1,0,0],[0,0,1,4],[0,0,0,1]]},{\"file_path\":\"large.png\","
                                "\"transform_matrix\":[[1,0,0,1],[0,1,0,0],[0,0,1,4],[0,0,0,1]]}]}");
    assert_int_equal(adcgs_scene_open(&scene, in("transforms.json"), NULL, &error), ADCGS_OK);
    const long before = peak_kib();
    assert_int_equal(adcgs_scene_image(scene, &scene->views[0][0], 8, &rgb, &camera, &error), ADCGS_OK);
    assert_true(peak_kib() - before < 48 << 10);
    assert_true(camera.width == SIDE / 8 && camera.height == SIDE / 8);
    for (int i = 0; i < 3 * SIDE / 8 * SIDE / 8; i += 7)
        assert_true(fabs((double)rgb[i] - (i / (SIDE / 8) % (SIDE / 8) % 2 ? 1.0 : 0.2)) < 1e-6);
    free(rgb);
    adcgs_scene_free(&scene);
}

/* ---- JPEG ---- */

static void put_jpeg(const char *name, int format, const uint8_t *samples, const void *before_end, size_t n)
{
    static uint8_t bytes[65536];
    unsigned char *file = NULL;
    unsigned long size = 0;
    tjhandle encoder = tjInitCompress();
    const int sampling = format == TJPF_GRAY ? TJSAMP_GRAY : TJSAMP_420;
    assert_int_equal(tjCompress2(encoder, samples, WIDTH, 0, HEIGHT, format, &file, &size, sampling, 90, 0), 0);
    assert_true(size + n <= sizeof bytes);
    memcpy(bytes, file, size - 2);
    memcpy(bytes + size - 2, before_end, n);
    memcpy(bytes + size - 2 + n, file + size - 2, 2);
    put_bytes(name, bytes, size + n);
    tjFree(file);
    tjDestroy(encoder);
}

/** RGB with halved chroma, grey, and CMYK: as libjpeg decodes them for OpenImageIO, to the bit. */
static void test_jpeg(void **state)
{
    static const int kinds[][3] = {{TJPF_RGB, 3, 3}, {TJPF_GRAY, 1, 1}, {TJPF_CMYK, 4, 3}};
    uint8_t samples[4 * PIXELS];
    for (size_t k = 0; k < ADCGS_COUNTOF(kinds); k++) {
        const int n = kinds[k][1];
        for (int i = 0; i < n * PIXELS; i++)
            samples[i] = (uint8_t)(255 - (i / n % WIDTH * 9 + i / n / WIDTH * 7 + i % n * 20) % 256);
        put_jpeg("a.jpg", kinds[k][0], samples, "", 0);
        read_good("a.jpg", kinds[k][2]);
        if (n < 4) /* smooth images stay near */
            for (int i = 0; i < n * PIXELS; i++)
                assert_true(fabs((double)image.data[i] - samples[i] / 255.0) < 0.2);
        else /* ink times black */
            for (int i = 0; i < PIXELS; i++)
                assert_true(fabs((double)image.data[3 * i] - samples[4 * i] * samples[4 * i + 3] / 65025.0) < 0.2);
        done("a.jpg");
    }
}

/** Extra bytes are skipped. Coded data that end early or are damaged are an error. */
static void test_damaged_jpeg(void **state)
{
    uint8_t samples[3 * PIXELS], bytes[65536];
    for (int i = 0; i < 3 * PIXELS; i++)
        samples[i] = (uint8_t)(i * 7919 >> 3);
    put_jpeg("x.jpg", TJPF_RGB, samples, "\x01\x02\x03", 3);
    read_good("x.jpg", 3);
    adcgs_image_free(&image);
    FILE *file = fopen(in("x.jpg"), "rb");
    const size_t size = fread(bytes, 1, sizeof bytes, file);
    fclose(file);
    const size_t cut = size - 100; /* in the coded data */
    bytes[cut] = 0xff;
    bytes[cut + 1] = 0xd9;
    put_bytes("y.jpg", bytes, cut + 2);
    expect_error(adcgs_image_read(&image, in("y.jpg"), &error), ADCGS_ERR_DATA, "y.jpg: damaged image", "remature end");
    assert_null(image.data);
}

static void test_jpeg_written(void **state)
{
    adcgs_image grey = {0};
    assert_int_equal(adcgs_image_alloc(&grey, WIDTH, HEIGHT, 1, "grey", &error), ADCGS_OK);
    for (int i = 0; i < PIXELS; i++)
        grey.data[i] = (float)(i % WIDTH) / WIDTH;
    assert_int_equal(adcgs_image_write(&grey, in("g.jpeg"), 0, &error), ADCGS_OK);
    read_good("g.jpeg", 1);
    for (int i = 0; i < PIXELS; i++)
        assert_true(fabs((double)image.data[i] - (double)grey.data[i]) < 0.02);
    done("g.jpeg");
    adcgs_image_free(&grey);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_large),        cmocka_unit_test(test_few_bits),     cmocka_unit_test(test_palette),
        cmocka_unit_test(test_transparent),  cmocka_unit_test(test_wide),         cmocka_unit_test(test_gamma),
        cmocka_unit_test(test_interlaced),   cmocka_unit_test(test_names),        cmocka_unit_test(test_jpeg),
        cmocka_unit_test(test_damaged_jpeg), cmocka_unit_test(test_jpeg_written),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

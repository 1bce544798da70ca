/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Photos made upright and smaller: the place of each pixel for each EXIF orientation, and that even areas stay even. Panoramas.
 */
#include "outside_files.h"

#include "media/image/panorama.h"
#include "media/image/photo.h"

#include <math.h>

enum { WIDTH = 3, HEIGHT = 2 };

static void make(adcgs_image *image, int width, int height, float step)
{
    assert_int_equal(adcgs_image_alloc(image, width, height, 1, "x", &error), ADCGS_OK);
    for (int i = 0; i < width * height; i++)
        image->data[i] = step * (float)i;
}

/** The first stored row is, upright, at the top, top, bottom, bottom; or at the left, right, right, left. */
static void test_turns(void **state)
{
    for (int turn = 1; turn <= 8; turn++) {
        const int lies = adcgs_photo_lies(turn), width = lies ? HEIGHT : WIDTH, height = lies ? WIDTH : HEIGHT;
        const int from_bottom = turn == 3 || turn == 4 || turn == 7 || turn == 8;
        const int from_right = turn == 2 || turn == 3 || turn == 6 || turn == 7;
        adcgs_image image;
        make(&image, WIDTH, HEIGHT, 0.125f);
        assert_int_equal(adcgs_photo_shape(&image, turn, width, height, "x", &error), ADCGS_OK);
        assert_int_equal(image.width, width);
        assert_int_equal(image.height, height);
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++) {
                const int across = from_right ? width - 1 - x : x, down = from_bottom ? height - 1 - y : y;
                const int at = lies ? across * WIDTH + down : down * WIDTH + across;
                assert_true(image.data[y * width + x] == 0.125f * (float)at);
            }
        adcgs_image_free(&image);
    }
}

/** An image of one colour keeps it; the mean of any image stays. */
static void test_smaller(void **state)
{
    adcgs_image image;
    double before = 0.0, after = 0.0;
    make(&image, 64, 48, 0.0f);
    for (int i = 0; i < 64 * 48; i++)
        image.data[i] = 0.5f;
    assert_int_equal(adcgs_photo_shape(&image, 6, 20, 27, "x", &error), ADCGS_OK);
    for (int i = 0; i < 20 * 27; i++)
        assert_true(fabs(image.data[i] - 0.5) < 1e-5);
    adcgs_image_free(&image);
    make(&image, 64, 48, 1e-4f);
    for (int i = 0; i < 64 * 48; i++)
        before += image.data[i] / (64 * 48);
    assert_int_equal(adcgs_photo_shape(&image, ADCGS_PHOTO_UPRIGHT, 32, 24, "x", &error), ADCGS_OK);
    for (int i = 0; i < 32 * 24; i++)
        after += image.data[i] / (32 * 24);
    assert_true(fabs(before - after) < 1e-3);
    adcgs_image_free(&image);
}

/** The beginning of a JPEG: a segment of EXIF, then one with a packet of XMP. Cut off after n bytes, if they are fewer. */
static const char *projection_in(const char *name, const char *packet, size_t n)
{
    static char found[ADCGS_PANORAMA_NAME];
    static const char begin[] = "\xff\xd8\xff\xe1\0\x08GPano:\xff\xe1";
    const size_t length = 2 + strlen(name) + 1 + strlen(packet), whole = sizeof begin - 1 + length;
    uint8_t *const data = malloc(whole);
    assert_non_null(data);
    memcpy(data, begin, sizeof begin - 1);
    data[sizeof begin - 1] = (uint8_t)(length >> 8);
    data[sizeof begin] = (uint8_t)length;
    memcpy(data + sizeof begin + 1, name, strlen(name) + 1);
    memcpy(data + sizeof begin + 1 + strlen(name) + 1, packet, strlen(packet));
    uint8_t *const cut = malloc(n < whole ? n + !n : whole); /* a sanitizer notices reads behind its end */
    assert_non_null(cut);
    memcpy(cut, data, n < whole ? n : whole);
    adcgs_panorama_find(found, cut, n < whole ? n : whole);
    free(cut);
    free(data);
    return found;
}

static void test_panorama(void **state)
{
    static const char xmp[] = "http://ns.adobe.com/xap/1.0/", sphere[] = "<a GPano:ProjectionType=\"equirectangular\"/>";
    assert_string_equal(projection_in(xmp, sphere, SIZE_MAX), "equirectangular");
    assert_string_equal(projection_in(xmp, "<GPano:ProjectionType>\n equirectangular </GPano:ProjectionType>", SIZE_MAX),
                        "equirectangular");
    assert_string_equal(projection_in(xmp, "<a GPano:ProjectionType = 'abcdefghijklmnopqrstuvwxyz'>", SIZE_MAX),
                        "abcdefghijklmnopqrstuvw");
    assert_string_equal(projection_in(xmp, "<a tiff:Make=\"A\"/>", SIZE_MAX), "");
    assert_string_equal(projection_in("http://ns.example.org/other/", sphere, SIZE_MAX), "");
    for (size_t n = 0; n < 100; n++)
        assert_memory_equal(projection_in(xmp, sphere, n), "equirectangular", strlen(projection_in(xmp, sphere, n)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_turns), cmocka_unit_test(test_smaller),
                                       cmocka_unit_test(test_panorama)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

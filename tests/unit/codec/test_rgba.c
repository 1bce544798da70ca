/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Images of 8 bits a sample against frames and coverage, converted here; strides, rows from the bottom, CPU levels, threads.
 */
#include "config.h"

#include "decoder_fixture.h"

#include <math.h>

#define GUARD 0xa5
#define ROW (4 * FIXTURE_WIDTH)
#define PADDED (ROW + 13)
#define TIME 0.045

static uint8_t level_of(double v)
{
    return (uint8_t)floor((v > 0 ? v < 1 ? v : 1 : 0) * 255 + 0.5);
}

/** The expected image: from a frame and its coverage, in double. It may differ by a step where rounding decides. */
static void expect(const fixture *f, adcgs_decoder *d, adcgs_alpha mode, uint8_t *out)
{
    float *rgb = calloc(3 * FIXTURE_PIXELS, sizeof *rgb), *alpha = calloc(FIXTURE_PIXELS, sizeof *alpha);
    assert_true(rgb && alpha);
    adcgs_frame frame = {FIXTURE_WIDTH, FIXTURE_HEIGHT, rgb};
    assert_int_equal(adcgs_render(d, &fixture_camera, TIME, &frame, NULL), ADCGS_OK);
    assert_int_equal(adcgs_render_depth(d, &fixture_camera, TIME, NULL, alpha, NULL), ADCGS_OK);
    int part = 0;
    for (size_t i = 0; i < FIXTURE_PIXELS; i++) {
        const double a = mode == ADCGS_ALPHA_OPAQUE ? 1 : (double)alpha[i];
        for (size_t c = 0; c < 3; c++) {
            const double own = (double)rgb[3 * i + c] - (1 - a) * (double)f->stream.background[c];
            out[4 * i + c] = level_of(mode == ADCGS_ALPHA_STRAIGHT && a > 0 ? own / a : own);
        }
        out[4 * i + 3] = level_of(a);
        part += a > 0.1 && a < 0.9;
    }
    assert_true(part > 50 || mode == ADCGS_ALPHA_OPAQUE);
    free(rgb);
    free(alpha);
}

static void assert_near(const uint8_t *expected, const uint8_t *found, size_t stride, int most, const uint8_t *coverage)
{
    for (size_t y = 0; y < FIXTURE_HEIGHT; y++)
        for (size_t x = 0; x < ROW; x++) {
            const int difference = abs(expected[y * ROW + x] - found[y * stride + x]);
            /* Straight colours of pixels with almost no coverage are quotients of rounding errors. */
            if (difference > most && (!coverage || coverage[y * ROW + x / 4 * 4 + 3] > 2))
                fail_msg("row %zu, byte %zu: %d, expected %d", y, x, found[y * stride + x], expected[y * ROW + x]);
        }
}

static void test_modes(void **state)
{
    const fixture *f = *state;
    adcgs_decoder *d = open_with(f, NULL);
    uint8_t *expected = malloc(4 * FIXTURE_PIXELS), *found = malloc(4 * FIXTURE_PIXELS);
    assert_true(expected && found);
    for (int mode = ADCGS_ALPHA_OPAQUE; mode <= ADCGS_ALPHA_PREMULTIPLIED; mode++) {
        expect(f, d, (adcgs_alpha)mode, expected);
        assert_int_equal(adcgs_render_rgba8(d, &fixture_camera, TIME, (adcgs_alpha)mode, found, ROW, NULL), ADCGS_OK);
        assert_near(expected, found, ROW, mode == ADCGS_ALPHA_OPAQUE ? 0 : 1, mode == ADCGS_ALPHA_STRAIGHT ? expected : NULL);
        if (mode != ADCGS_ALPHA_OPAQUE)
            for (size_t i = 0; i < FIXTURE_PIXELS; i++) /* uncovered pixels contain no background */
                assert_true(expected[4 * i + 3] || !(found[4 * i] | found[4 * i + 1] | found[4 * i + 2]) ||
                            mode == ADCGS_ALPHA_STRAIGHT);
    }
    free(expected);
    free(found);
    adcgs_close(&d);
}

static void test_strides(void **state)
{
    const fixture *f = *state;
    adcgs_decoder *d = open_with(f, NULL);
    const size_t size = (size_t)PADDED * FIXTURE_HEIGHT;
    uint8_t *plain = malloc(4 * FIXTURE_PIXELS), *padded = malloc(size);
    adcgs_error error;
    assert_true(plain && padded);
    assert_int_equal(adcgs_render_rgba8(d, &fixture_camera, TIME, ADCGS_ALPHA_STRAIGHT, plain, ROW, NULL), ADCGS_OK);
    for (int up = 0; up < 2; up++) {
        uint8_t *first = padded + (up ? (size_t)PADDED * (FIXTURE_HEIGHT - 1) : 0);
        memset(padded, GUARD, size);
        assert_int_equal(adcgs_render_rgba8(d, &fixture_camera, TIME, ADCGS_ALPHA_STRAIGHT, first, up ? -PADDED : PADDED, NULL),
                         ADCGS_OK);
        for (size_t y = 0; y < FIXTURE_HEIGHT; y++) {
            const uint8_t *row = padded + (up ? FIXTURE_HEIGHT - 1 - y : y) * PADDED;
            assert_memory_equal(row, plain + y * ROW, ROW);
            for (size_t x = ROW; x < PADDED; x++)
                assert_int_equal(row[x], GUARD);
        }
    }
    const ptrdiff_t wrong[] = {0, ROW - 1, -ROW + 1};
    for (size_t i = 0; i < ADCGS_COUNTOF(wrong); i++) {
        assert_int_equal(adcgs_render_rgba8(d, &fixture_camera, TIME, ADCGS_ALPHA_OPAQUE, plain, wrong[i], &error),
                         ADCGS_ERR_USAGE);
        assert_non_null(strstr(error.text, "stride"));
    }
    assert_int_equal(adcgs_render_rgba8(d, &fixture_camera, TIME, (adcgs_alpha)3, plain, ROW, &error), ADCGS_ERR_USAGE);
    free(plain);
    free(padded);
    adcgs_close(&d);
}

static void test_levels_and_threads(void **state)
{
    const fixture *f = *state;
    uint8_t *first = malloc(4 * FIXTURE_PIXELS), *other = malloc(4 * FIXTURE_PIXELS);
    assert_true(first && other);
    for (int threads = 1; threads <= 4; threads += 3)
        for (int cpu = ADCGS_CPU_SCALAR; cpu <= (int)adcgs_cpu_best(); cpu++) {
            uint8_t *to = threads == 1 && cpu == ADCGS_CPU_SCALAR ? first : other;
            adcgs_config config;
            adcgs_config_init(&config, sizeof config);
            config.threads = threads;
            config.cpu = (adcgs_cpu_level)cpu;
            adcgs_decoder *d = open_with(f, &config);
            assert_int_equal(adcgs_render_rgba8(d, &fixture_camera, TIME, ADCGS_ALPHA_PREMULTIPLIED, to, ROW, NULL), ADCGS_OK);
            assert_memory_equal(to, first, 4 * FIXTURE_PIXELS);
            adcgs_close(&d);
        }
    free(first);
    free(other);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_modes),
        cmocka_unit_test(test_strides),
        cmocka_unit_test(test_levels_and_threads),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A process in another floating-point mode gets no decoder and no frame, and the message gives the reason. */
#include "base/cpu_detect.h"
#include "base/strict.h"

#include <adcgs/adcgs.h>

#include <fenv.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

#define WIDTH 8

static uint8_t *stream;
static size_t stream_bytes;
static float rgb[3 * WIDTH * WIDTH];

static int load_stream(void **state)
{
    const char *source = getenv("srcdir");
    char path[1024];
    (void)state;
    snprintf(path, sizeof path, "%s/conformance/vectors/good-geom-one-anchor.adcgs", source ? source : ".");
    FILE *file = fopen(path, "rb");
    stream = malloc(1 << 20);
    if (!file || !stream)
        return -1;
    stream_bytes = fread(stream, 1, 1 << 20, file);
    return fclose(file);
}

static int free_stream(void **state)
{
    (void)state;
    free(stream);
    return 0;
}

static adcgs_status render(adcgs_decoder *decoder, adcgs_error *error)
{
    adcgs_frame frame = {.width = WIDTH, .height = WIDTH, .rgb = rgb};
    adcgs_camera camera = {.width = WIDTH, .height = WIDTH, .fx = 8, .fy = 8, .cx = 4, .cy = 4, .near_plane = 0.01};
    for (int i = 0; i < 3; i++)
        camera.cam_to_world[5 * i] = 1;
    return adcgs_render(decoder, &camera, 0, &frame, error);
}

/* Runs in the wrong mode: no output of the test framework here; the verdicts are returned. */
typedef struct verdicts {
    adcgs_status modes, check, open, render, primitives;
    adcgs_error why;
} verdicts;

static verdicts try_everything(adcgs_decoder *opened)
{
    verdicts v;
    adcgs_decoder *decoder;
    adcgs_primitives primitives;
    v.modes = adcgs_strict_modes(NULL);
    v.check = adcgs_strict_check(NULL);
    v.open = adcgs_open_memory(&decoder, stream, stream_bytes, NULL, &v.why);
    adcgs_close(&decoder);
    v.render = render(opened, NULL);
    v.primitives = adcgs_get_primitives(opened, 0, &primitives, NULL);
    return v;
}

static void assert_all(const verdicts *v, adcgs_status status)
{
    assert_int_equal(v->modes, status);
    assert_int_equal(v->check, status);
    assert_int_equal(v->open, status);
    assert_int_equal(v->render, status);
    assert_int_equal(v->primitives, status);
}

static adcgs_decoder *open_decoder(void)
{
    adcgs_decoder *decoder;
    adcgs_error error = {0};
    if (adcgs_open_memory(&decoder, stream, stream_bytes, NULL, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    return decoder;
}

static void test_rounding(void **state)
{
    static const int directions[] = {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO};
    adcgs_decoder *decoder = open_decoder();
    (void)state;
    for (size_t i = 0; i < ADCGS_COUNTOF(directions); i++) {
        assert_int_equal(fesetround(directions[i]), 0);
        const verdicts v = try_everything(decoder);
        fesetround(FE_TONEAREST);
        assert_all(&v, ADCGS_ERR_FPENV);
        assert_string_equal(v.why.text, "rounding is not to nearest, ties to even");
    }
    const verdicts v = try_everything(decoder);
    assert_all(&v, ADCGS_OK);
    adcgs_close(&decoder);
}

#ifdef __SSE2__
/* The effect of a library linked with -ffast-math on the process: flush to zero, subnormals are zero, both. */
static void test_flushing(void **state)
{
    static const unsigned modes[] = {0x8000, 0x0040, 0x8040};
    adcgs_decoder *decoder = open_decoder();
    const unsigned saved = _mm_getcsr();
    (void)state;
    for (size_t i = 0; i < ADCGS_COUNTOF(modes); i++) {
        _mm_setcsr(saved | modes[i]);
        const verdicts v = try_everything(decoder);
        _mm_setcsr(saved);
        assert_all(&v, ADCGS_ERR_FPENV);
        assert_string_equal(v.why.text, "subnormal numbers are flushed to zero");
    }
    const verdicts v = try_everything(decoder);
    assert_all(&v, ADCGS_OK);
    adcgs_close(&decoder);
}
#endif

/* The check costs a decoder that opens well under a millisecond. */
static void test_cost(void **state)
{
    double least = 1;
    (void)state;
    for (int i = 0; i < 20; i++) {
        const double begin = adcgs_seconds();
        assert_int_equal(adcgs_strict_check(NULL), ADCGS_OK);
        const double seconds = adcgs_seconds() - begin;
        least = ADCGS_MIN(least, seconds);
    }
    assert_true(least < 1e-3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rounding),
#ifdef __SSE2__
        cmocka_unit_test(test_flushing),
#endif
        cmocka_unit_test(test_cost),
    };
    return cmocka_run_group_tests_name("strict", tests, load_stream, free_stream);
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The public decoder: every source gives the same, segments are chosen by time, frames do not depend on threads or CPU. */
#include "config.h"

#include "decoder_fixture.h"

#include "base/digest.h"
#include "render/render.h"
#include "splat/splat.h"

#include <math.h>
#include <stdio.h>
#include <unistd.h>

/* REQ-LATN-009 */
static void test_info(void **state)
{
    fixture *f = *state;
    adcgs_decoder *d = open_with(f, NULL);
    adcgs_info info;
    adcgs_camera camera;
    uint8_t expected[16], found[16];
    assert_int_equal(adcgs_get_info(d, &info, sizeof info, NULL), ADCGS_OK);
    assert_int_equal(info.segments, 3);
    assert_int_equal(info.anchors, fixture_anchors(f));
    assert_int_equal(info.k, 4);
    assert_int_equal(info.layers, 3);
    assert_true(info.bytes.total == f->bytes.size && info.bytes.geometry > 0 && info.bytes.layer[4] == 0);
    assert_true(info.scene_scale == 2.5 && info.scene_origin[1] == 0.75 && info.frame_rate == 30);
    assert_true(info.time_start == 0 && info.time_end == f->stream.segments[2].time_end);
    assert_int_equal(info.weights, f->stream.weights);
    assert_string_equal(info.colour, "sRGB");
    assert_string_equal(info.axes, "right-handed, z up");
    assert_string_equal(info.units, "metre");
    assert_int_equal(adcgs_get_camera(d, info.cameras, &camera, NULL), ADCGS_ERR_USAGE);
    assert_int_equal(adcgs_get_camera(d, -1, &camera, NULL), ADCGS_ERR_USAGE);
    assert_string_equal(adcgs_get_metadata(d, "key1"), f->stream.meta[1].value);
    assert_null(adcgs_get_metadata(d, "nothing"));
    for (int i = 0; i < 3; i++) {
        adcgs_model_digest(&f->stream.segments[i], expected);
        assert_int_equal(adcgs_get_model_digest(d, i, found, NULL), ADCGS_OK);
        assert_memory_equal(expected, found, 16);
    }
    assert_int_equal(adcgs_get_model_digest(d, 3, found, NULL), ADCGS_ERR_USAGE);
    adcgs_close(&d);
    assert_null(d);
    adcgs_close(&d);
}

static void test_sources(void **state)
{
    const fixture *f = *state;
    char path[] = "/tmp/adcgs-test-XXXXXX";
    adcgs_decoder *d = NULL;
    adcgs_error error;
    uint8_t a[16], b[16];
    const int handle = mkstemp(path);
    assert_true(handle >= 0);
    FILE *file = fdopen(handle, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(f->bytes.data, 1, f->bytes.size, file), f->bytes.size);
    assert_int_equal(fclose(file), 0);
    assert_int_equal(adcgs_open_file(&d, path, NULL, &error), ADCGS_OK);
    adcgs_get_model_digest(d, 2, a, &error);
    adcgs_model_digest(&f->stream.segments[2], b);
    assert_memory_equal(a, b, 16);
    adcgs_close(&d);
    assert_int_equal(truncate(path, 100), 0);
    assert_int_equal(adcgs_open_file(&d, path, NULL, &error), ADCGS_ERR_TRUNCATED);
    assert_int_equal(strncmp(error.text, path, strlen(path)), 0); /* the message names the file */
    assert_null(strstr(error.text, "stream:"));
    assert_int_equal(adcgs_open_file(&d, path, NULL, NULL), ADCGS_ERR_TRUNCATED);
    unlink(path);
    assert_int_equal(adcgs_open_file(&d, path, NULL, &error), ADCGS_ERR_IO);
    assert_null(d);
    assert_non_null(strstr(error.text, path));
    assert_int_equal(adcgs_open_memory(&d, "no stream at all", 16, NULL, &error), ADCGS_ERR_DATA);
    assert_int_equal(adcgs_open_memory(&d, f->bytes.data, 0, NULL, NULL), ADCGS_ERR_TRUNCATED);
    assert_null(d);
}

static void test_config(void **state)
{
    const fixture *f = *state;
    adcgs_config config;
    adcgs_decoder *d = NULL;
    adcgs_error error;
    adcgs_info info;
    adcgs_config_init(&config, sizeof config);
    config.threads = 257;
    assert_int_equal(adcgs_open_memory(&d, f->bytes.data, f->bytes.size, &config, &error), ADCGS_ERR_USAGE);
    adcgs_config_init(&config, sizeof config);
    config.size = 3;
    assert_int_equal(adcgs_open_memory(&d, f->bytes.data, f->bytes.size, &config, &error), ADCGS_ERR_USAGE);
    adcgs_config_init(&config, sizeof config);
    config.memory_limit = 10000;
    assert_int_equal(adcgs_open_memory(&d, f->bytes.data, f->bytes.size, &config, &error), ADCGS_ERR_LIMIT);
    adcgs_config_init(&config, sizeof config);
    config.layers = 1;
    d = open_with(f, &config);
    adcgs_get_info(d, &info, sizeof info, &error);
    assert_int_equal(info.layers, 1);
    adcgs_close(&d);
    adcgs_config_init(&config, sizeof config);
    config.strict_end = 1;
    assert_int_equal(adcgs_open_memory(&d, f->bytes.data, f->bytes.size - 1, &config, &error), ADCGS_ERR_TRUNCATED);
    config.strict_end = 0;
    assert_int_equal(adcgs_open_memory(&d, f->bytes.data, f->bytes.size - 1, &config, &error), ADCGS_OK);
    adcgs_get_info(d, &info, sizeof info, &error);
    assert_true(info.truncated && info.segments == 3);
    adcgs_close(&d);
}

/** REQ-PRIM-021, REQ-PRIM-023: the last segment that starts at or before the time, at its nearest time; all layers or one. */
static void test_segments_by_time(void **state)
{
    fixture *f = *state;
    const double middle = f->stream.segments[1].time_start;
    const double times[] =
        {-5, 0, nextafter(middle, 0), middle, f->stream.segments[1].time_end, f->stream.segments[2].time_start, 1e9, NAN};
    const int expected[] = {0, 0, 0, 1, 1, 2, 2, 0};
    adcgs_config config;
    adcgs_config_init(&config, sizeof config);
    for (config.layers = 0; config.layers < 2; config.layers++) {
        adcgs_decoder *d = open_with(f, &config);
        for (size_t i = 0; i < ADCGS_COUNTOF(times); i++) {
            const adcgs_model *m = &f->stream.segments[expected[i]];
            adcgs_primitives p;
            assert_int_equal(adcgs_get_primitives(d, times[i], &p, NULL), ADCGS_OK);
            assert_int_equal(p.n, (m->n + 63) / 64 * 64 * 4);
            for (uint32_t j = 0; j < m->n; j++) /* masks distinguish the segments */
                for (uint32_t k = 0; k < 4; k++)
                    assert_int_equal(p.opacity[(j / 64 * 4 + k) * 64 + j % 64] > 0, m->mask[j] >> k & 1);
        }
        adcgs_close(&d);
    }
}

/**
 * REQ-PRIM-019: digests of splats, by time, each with its own segment's masks. REQ-REND-011: of a frame, its samples in order as
 * little-endian bytes.
 */
static void test_digests(void **state)
{
    fixture *f = *state;
    adcgs_decoder *d = open_with(f, NULL);
    const adcgs_model *m = &f->stream.segments[1];
    const double times[] = {0, m->time_start, m->time_end};
    float rgb[] = {1.0f, -0.0f, 0.5f};
    const adcgs_frame frame = {1, 1, rgb};
    adcgs_primitives p;
    uint8_t found[3][16], expected[16];
    adcgs_md5 md5;
    for (size_t i = 0; i < 3; i++) {
        assert_int_equal(adcgs_get_splat_digest(d, times[i], found[i], NULL), ADCGS_OK);
        assert_int_equal(adcgs_get_primitives(d, times[i], &p, NULL), ADCGS_OK);
        adcgs_splat_digest(i ? m : &f->stream.segments[0], &p, expected);
        assert_memory_equal(found[i], expected, 16);
        for (size_t j = 0; j < i; j++)
            assert_memory_not_equal(found[i], found[j], 16);
    }
    adcgs_close(&d);
    adcgs_md5_init(&md5);
    adcgs_md5_update(&md5, "\0\0\x80\x3f\0\0\0\x80\0\0\0\x3f", 12);
    adcgs_md5_final(&md5, expected);
    adcgs_frame_digest(&frame, found[0]);
    assert_memory_equal(found[0], expected, 16);
}

/* REQ-CONF-004, REQ-REND-009 */
static void test_frames(void **state)
{
    const fixture *f = *state;
    const size_t n = 3 * FIXTURE_PIXELS;
    float *first = malloc(n * sizeof *first), *other = malloc(n * sizeof *other);
    uint8_t *bytes = malloc(n);
    adcgs_error error = {ADCGS_OK, ""};
    assert_true(first && other && bytes);
    for (int threads = 1; threads <= 7; threads += 3)
        for (int cpu = ADCGS_CPU_SCALAR; cpu <= (int)adcgs_cpu_best(); cpu++) {
            adcgs_config config;
            adcgs_config_init(&config, sizeof config);
            config.threads = threads;
            config.cpu = (adcgs_cpu_level)cpu;
            adcgs_decoder *d = open_with(f, &config);
            adcgs_frame frame = {FIXTURE_WIDTH, FIXTURE_HEIGHT, threads == 1 && cpu == 1 ? first : other};
            if (adcgs_render(d, &fixture_camera, 0.045, &frame, &error) != ADCGS_OK)
                fail_msg("%s", error.text);
            if (frame.rgb == other)
                assert_memory_equal(first, other, n * sizeof *first);
            frame.width = 60;
            assert_int_equal(adcgs_render(d, &fixture_camera, 0.045, &frame, &error), ADCGS_ERR_USAGE);
            adcgs_close(&d);
        }
    size_t drawn = 0;
    for (size_t i = 0; i < n; i += 3)
        drawn += first[i] != 0.5f;
    assert_true(drawn > 50);
    const adcgs_frame frame = {FIXTURE_WIDTH, FIXTURE_HEIGHT, first};
    first[0] = -1;
    first[1] = 2;
    first[2] = 0.5f;
    adcgs_frame_to_u8(&frame, bytes);
    assert_true(bytes[0] == 0 && bytes[1] == 255 && bytes[2] == 128);
    free(first);
    free(other);
    free(bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_info),   cmocka_unit_test(test_sources),          cmocka_unit_test(test_config),
        cmocka_unit_test(test_frames), cmocka_unit_test(test_segments_by_time), cmocka_unit_test(test_digests),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Bytes as they come: cut anywhere they give what reading in order gives, every prefix of a stream too; what can be drawn on the
 * way is what a stream that ends there would show; calls take a part at a time, failures are final, what was there stays.
 */
#include "random_model.h"

#include "base/digest.h"
#include "stream/chunk.h"

#include <adcgs/adcgs.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

enum { SEGMENTS = 4 };

typedef struct fixture {
    adcgs_stream stream;
    adcgs_buffer bytes;
} fixture;

/** Small, so that every prefix can be tried: a key, two that are predicted, a key; layers of several slices. */
static int setup(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    adcgs_params params;
    uint64_t seed = 12;
    adcgs_stream *s = &f->stream;
    adcgs_random_small_params(&params, 2, &seed);
    adcgs_buffer_init(&f->bytes);
    adcgs_stream_init(s);
    s->params = params;
    s->slice_log2 = ADCGS_SLICE_LOG2_MIN;
    s->cameras = adcgs_alloc(NULL, 1, sizeof *s->cameras, NULL);
    s->n_cameras = 1;
    s->cameras[0] = (adcgs_camera){ .width = 8, .height = 8, .fx = 8, .fy = 8, .cx = 4, .cy = 4, .near_plane = 0.1,
                                    .cam_to_world = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -3 } };
    if (adcgs_random_turns(s, SEGMENTS, 80, 4, 70, &seed, NULL) != ADCGS_OK)
        return -1;
    *state = f;
    return adcgs_stream_write(s, &f->bytes, NULL) == ADCGS_OK ? 0 : -1;
}

static int teardown(void **state)
{
    fixture *f = *state;
    adcgs_stream_clear(&f->stream, NULL);
    adcgs_buffer_clear(&f->bytes);
    free(f);
    return 0;
}

static adcgs_decoder *open_push(void)
{
    adcgs_decoder *d = NULL;
    adcgs_config config;
    adcgs_config_init(&config, sizeof config);
    config.threads = 1;
    assert_int_equal(adcgs_open_push(&d, &config, NULL), ADCGS_OK);
    return d;
}

/** The digests of all models, one after the other; how many. */
static int digests(adcgs_decoder *d, uint8_t out[SEGMENTS][16])
{
    int n = 0;
    while (n < SEGMENTS && adcgs_get_model_digest(d, n, out[n], NULL) == ADCGS_OK)
        n++;
    return n;
}

/** Push some bytes in pieces of chance, at most so many at a time. */
static adcgs_status push_all(adcgs_decoder *d, const uint8_t *data, size_t bytes, uint64_t *seed, int64_t piece)
{
    adcgs_status status = ADCGS_OK;
    while (bytes > 0 && status == ADCGS_OK) {
        const size_t some = (size_t)adcgs_random_range(seed, 1, piece), n = ADCGS_MIN(bytes, some);
        size_t used;
        adcgs_arrival arrived;
        status = adcgs_push(d, data, n, &used, &arrived, NULL);
        assert_true(used <= n);
        if (arrived == ADCGS_ARRIVED_END)
            return status;
        data += used;
        bytes -= used;
    }
    return status;
}

static void test_cut_anywhere(void **state)
{
    const fixture *f = *state;
    uint64_t seed = 4;
    uint8_t expected[SEGMENTS][16], found[SEGMENTS][16];
    for (uint32_t i = 0; i < SEGMENTS; i++)
        adcgs_model_digest(&f->stream.segments[i], expected[i]);
    for (int64_t piece = 1; piece < 100000; piece *= 3) {
        adcgs_decoder *d = open_push();
        adcgs_info info;
        assert_int_equal(push_all(d, f->bytes.data, f->bytes.size, &seed, piece), ADCGS_OK);
        assert_int_equal(adcgs_push_end(d, NULL), ADCGS_OK);
        assert_int_equal(digests(d, found), SEGMENTS);
        assert_memory_equal(found, expected, sizeof found);
        assert_int_equal(adcgs_get_info(d, &info, sizeof info, NULL), ADCGS_OK);
        assert_int_equal(info.segments, SEGMENTS);
        assert_false(info.truncated);
        adcgs_close(&d);
    }
}

/** After each prefix the picture is that of the stream that ends there, before it is said that it does, and afterwards. */
static void test_every_prefix(void **state)
{
    const fixture *f = *state;
    adcgs_decoder *d = open_push();
    uint64_t seed = 5;
    for (size_t size = 0; size <= f->bytes.size; size++) {
        uint8_t now[SEGMENTS][16], whole[SEGMENTS][16], ended[SEGMENTS][16];
        adcgs_decoder *ends = NULL, *in_order = NULL;
        if (size > 0)
            assert_int_equal(push_all(d, f->bytes.data + size - 1, 1, &seed, 1), ADCGS_OK);
        const int n = digests(d, now);
        if (size % 7 && size + 40 < f->bytes.size) /* the rest is slow */
            continue;
        const adcgs_status status = adcgs_open_memory(&in_order, f->bytes.data, size, NULL, NULL);
        ends = open_push();
        push_all(ends, f->bytes.data, size, &seed, 5000);
        assert_int_equal(adcgs_push_end(ends, NULL), status);
        if (status == ADCGS_OK) {
            const int expected = digests(in_order, whole);
            assert_int_equal(digests(ends, ended), expected);
            assert_memory_equal(ended, whole, (size_t)expected * 16);
            /* Of a part that is cut off, reading to the end may use slices, and so have a segment more, or more of the last. */
            assert_in_range(n, expected - 1, expected);
            assert_memory_equal(now, whole, (size_t)(expected - 1) * 16);
        } else {
            assert_int_equal(n, 0);
        }
        adcgs_close(&in_order);
        adcgs_close(&ends);
    }
    adcgs_close(&d);
}

/** What comes in which order, and that a call takes no more than one part. */
static void test_arrivals(void **state)
{
    const fixture *f = *state;
    adcgs_decoder *d = open_push();
    const uint8_t *data = f->bytes.data;
    size_t left = f->bytes.size, used;
    int seen[5] = { 0 }, parts = 0, last = 0;
    adcgs_camera camera;
    adcgs_info info;
    uint8_t digest[16];
    assert_int_equal(adcgs_get_info(d, &info, sizeof info, NULL), ADCGS_ERR_USAGE);
    assert_int_equal(adcgs_get_splat_digest(d, 0, digest, NULL), ADCGS_ERR_USAGE);
    while (left > 0 && last != ADCGS_ARRIVED_END) {
        adcgs_arrival arrived;
        assert_int_equal(adcgs_push(d, data, left, &used, &arrived, NULL), ADCGS_OK);
        assert_true(used > 0);
        if (arrived != ADCGS_ARRIVED_NOTHING)
            last = (int)arrived;
        seen[arrived]++;
        parts++;
        data += used;
        left -= used;
        if (arrived == ADCGS_ARRIVED_HEADER)
            assert_int_equal(adcgs_get_info(d, &info, sizeof info, NULL), ADCGS_OK);
        if (arrived == ADCGS_ARRIVED_CAMERAS)
            assert_int_equal(adcgs_get_camera(d, 0, &camera, NULL), ADCGS_OK);
        if (arrived == ADCGS_ARRIVED_SEGMENT)
            assert_int_equal(adcgs_get_splat_digest(d, 0.05, digest, NULL), ADCGS_OK);
    }
    assert_int_equal(left, 0);
    assert_true(seen[ADCGS_ARRIVED_HEADER] == 1 && seen[ADCGS_ARRIVED_CAMERAS] == 1 && seen[ADCGS_ARRIVED_END] == 1);
    assert_in_range(seen[ADCGS_ARRIVED_SEGMENT], 2 * SEGMENTS, parts);
    assert_int_equal(adcgs_push(d, data, 0, &used, &(adcgs_arrival){ 0 }, NULL), ADCGS_OK);
    adcgs_close(&d);

    adcgs_decoder *other = NULL;
    adcgs_arrival arrived;
    assert_int_equal(adcgs_open_memory(&other, f->bytes.data, f->bytes.size, NULL, NULL), ADCGS_OK);
    assert_int_equal(adcgs_push(other, data, 0, &used, &arrived, NULL), ADCGS_ERR_USAGE);
    assert_int_equal(adcgs_push_end(other, NULL), ADCGS_ERR_USAGE);
    adcgs_close(&other);
}

/** Damage is met where it is; the same failure comes again; segments before it are there. */
static void test_damage(void **state)
{
    const fixture *f = *state;
    uint64_t seed = 6;
    for (int i = 0; i < 300; i++) {
        adcgs_buffer b;
        adcgs_decoder *d = open_push(), *in_order = NULL;
        adcgs_error error = { ADCGS_OK, "" }, again = { ADCGS_OK, "" };
        uint8_t found[SEGMENTS][16], expected[16];
        size_t used;
        adcgs_arrival arrived;
        adcgs_buffer_init(&b);
        adcgs_write_bytes(&b, f->bytes.data, f->bytes.size);
        b.data[adcgs_random_range(&seed, 0, (int64_t)b.size - 1)] ^= (uint8_t)adcgs_random_range(&seed, 1, 255);
        const adcgs_status status = adcgs_open_memory(&in_order, b.data, b.size, NULL, &error);
        push_all(d, b.data, b.size, &seed, 700);
        assert_int_equal(adcgs_push_end(d, &again), status);
        if (status != ADCGS_OK) {
            assert_string_equal(error.text, again.text);
            assert_int_equal(adcgs_push(d, b.data, 1, &used, &arrived, NULL), status);
        }
        const int n = digests(d, found);
        for (int k = 0; k < n - 1; k++) {
            adcgs_model_digest(&f->stream.segments[k], expected);
            assert_memory_equal(found[k], expected, 16);
        }
        adcgs_close(&in_order);
        adcgs_close(&d);
        adcgs_buffer_clear(&b);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cut_anywhere),
        cmocka_unit_test(test_every_prefix),
        cmocka_unit_test(test_arrivals),
        cmocka_unit_test(test_damage),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}

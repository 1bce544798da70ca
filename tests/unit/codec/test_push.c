/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Pushed bytes. Cut at any place, they give the same result as reading in order, and so does every prefix of a stream. Before the
 * end, the decoder can render the same as a stream that ends there. A call takes one part at a time. Failures are final and leave
 * the decoded data usable. Frames that are reported as final do not change, and past data may be discarded.
 */
#include "stream_fixture.h"

#include "base/digest.h"
#include "stream/chunk.h"

#include <adcgs/adcgs.h>

#include <math.h>

enum { SEGMENTS = 4 };

/** Small, so that the test can try every prefix: a key, two predicted segments, a key; layers of several slices. */
static int setup(void **state)
{
    fixture *f = fixture_new(state);
    adcgs_params params;
    uint64_t seed = 14;
    adcgs_stream *s = &f->stream;
    adcgs_random_small_params(&params, 2, &seed);
    if (adcgs_random_front(s, NULL) != ADCGS_OK)
        return -1;
    return fixture_turns(f, &params, SEGMENTS, 80, 4, 70, &seed);
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

/** The digests of all models, one after the other. Returns their number. */
static int digests(adcgs_decoder *d, uint8_t out[SEGMENTS][16])
{
    int n = 0;
    while (n < SEGMENTS && adcgs_get_model_digest(d, n, out[n], NULL) == ADCGS_OK)
        n++;
    return n;
}

/** Pushes bytes in pieces of random size up to `piece`. */
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

/** After each prefix the state equals that of the stream that ends there, both before and after the end is signalled. */
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
        if (size % 7 && size + 40 < f->bytes.size) /* trying every size would be slow */
            continue;
        const adcgs_status status = adcgs_open_memory(&in_order, f->bytes.data, size, NULL, NULL);
        ends = open_push();
        push_all(ends, f->bytes.data, size, &seed, 5000);
        assert_int_equal(adcgs_push_end(ends, NULL), status);
        if (status == ADCGS_OK) {
            const int expected = digests(in_order, whole);
            assert_int_equal(digests(ends, ended), expected);
            assert_memory_equal(ended, whole, (size_t)expected * 16);
            /* Reading to the end may also use the slices of a cut part, and so have one segment more, or more of the last one. */
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

/** The order of arrivals; a call takes at most one part. */
static void test_arrivals(void **state)
{
    const fixture *f = *state;
    adcgs_decoder *d = open_push();
    const uint8_t *data = f->bytes.data;
    size_t left = f->bytes.size, used;
    int seen[5] = {0}, parts = 0, last = 0;
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
    assert_int_equal(adcgs_push(d, data, 0, &used, &(adcgs_arrival){0}, NULL), ADCGS_OK);
    adcgs_close(&d);

    adcgs_decoder *other = NULL;
    adcgs_arrival arrived;
    assert_int_equal(adcgs_open_memory(&other, f->bytes.data, f->bytes.size, NULL, NULL), ADCGS_OK);
    assert_int_equal(adcgs_push(other, data, 0, &used, &arrived, NULL), ADCGS_ERR_USAGE);
    assert_int_equal(adcgs_push_end(other, NULL), ADCGS_ERR_USAGE);
    adcgs_close(&other);
}

/** Damage is found at its place. The same failure is returned again, and the segments before it stay available. */
static void test_damage(void **state)
{
    const fixture *f = *state;
    uint64_t seed = 6;
    for (int i = 0; i < 300; i++) {
        adcgs_buffer b;
        adcgs_decoder *d = open_push(), *in_order = NULL;
        adcgs_error error = {ADCGS_OK, ""}, again = {ADCGS_OK, ""};
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

/** Final frames are final: their splats are those of the whole stream, whatever bytes follow. */
static void test_final(void **state)
{
    const fixture *f = *state;
    adcgs_decoder *d = open_push(), *whole = NULL;
    adcgs_info info, all;
    double time = f->stream.segments[0].time_start;
    uint64_t seed = 7;
    int early = 0;
    assert_int_equal(adcgs_open_memory(&whole, f->bytes.data, f->bytes.size, NULL, NULL), ADCGS_OK);
    assert_int_equal(adcgs_get_info(whole, &all, sizeof all, NULL), ADCGS_OK);
    assert_true(isinf(all.time_committed) && all.time_committed > 0);
    for (size_t at = 0; at < f->bytes.size; at++) {
        assert_int_equal(push_all(d, f->bytes.data + at, 1, &seed, 1), ADCGS_OK);
        if (adcgs_get_info(d, &info, sizeof info, NULL) != ADCGS_OK)
            continue;
        assert_true(info.time_end == all.time_end && info.bytes.total == at + 1);
        assert_int_equal(info.segments_total, SEGMENTS);
        for (; time <= all.time_end && time < info.time_committed; time += 1e-3) {
            uint8_t ours[16], theirs[16];
            assert_int_equal(adcgs_get_splat_digest(d, time, ours, NULL), ADCGS_OK);
            assert_int_equal(adcgs_get_splat_digest(whole, time, theirs, NULL), ADCGS_OK);
            assert_memory_equal(ours, theirs, sizeof ours);
            early += at < f->bytes.size / 2;
        }
    }
    assert_true(time > all.time_end && early > 0);
    assert_true(info.time_start == all.time_start && info.weights == all.weights && info.segments == SEGMENTS);
    assert_memory_equal(&info.bytes, &all.bytes, sizeof info.bytes);
    adcgs_close(&d);
    adcgs_close(&whole);
}

/** Pushes a stream and renders final frames on the way. forgets: each time is the first one that is still needed. */
static adcgs_status play_through(const fixture *f, uint64_t memory_limit, int forgets)
{
    const adcgs_stream *s = &f->stream;
    adcgs_decoder *d = NULL;
    adcgs_config config;
    adcgs_config_init(&config, sizeof config);
    config.threads = 1;
    config.memory_limit = memory_limit;
    assert_int_equal(adcgs_open_push(&d, &config, NULL), ADCGS_OK);
    adcgs_status status = ADCGS_OK;
    uint32_t next = 0; /* segment to render */
    for (size_t at = 0, used = 0; at < f->bytes.size && status == ADCGS_OK; at += used) {
        adcgs_arrival arrived;
        adcgs_info info = {.time_committed = -INFINITY};
        status = adcgs_push(d, f->bytes.data + at, f->bytes.size - at, &used, &arrived, NULL);
        adcgs_get_info(d, &info, sizeof info, NULL);
        for (; status == ADCGS_OK && next < s->n_segments && s->segments[next].time_start < info.time_committed; next++) {
            uint8_t digest[16], expected[16];
            if (forgets)
                assert_int_equal(adcgs_push_discard_before(d, s->segments[next].time_start, NULL), ADCGS_OK);
            status = adcgs_get_splat_digest(d, s->segments[next].time_start, digest, NULL);
            if (status == ADCGS_OK)
                status = adcgs_get_model_digest(d, (int)next, digest, NULL);
            adcgs_model_digest(&s->segments[next], expected);
            assert_true(status != ADCGS_OK || memcmp(digest, expected, 16) == 0);
            if (forgets && next > 1)
                assert_int_equal(adcgs_get_model_digest(d, (int)next - 2, digest, NULL), ADCGS_ERR_USAGE);
        }
    }
    if (status == ADCGS_OK) {
        adcgs_info info;
        assert_int_equal(next, s->n_segments);
        assert_int_equal(adcgs_get_info(d, &info, sizeof info, NULL), ADCGS_OK);
        assert_int_equal(info.segments, s->n_segments);
        assert_true(info.time_start == s->segments[0].time_start);
    }
    adcgs_close(&d);
    return status;
}

/** The approximate memory that the decoder needs. */
static uint64_t least_memory(const fixture *f, int forgets)
{
    uint64_t limit = 1 << 16;
    while (play_through(f, limit, forgets) == ADCGS_ERR_LIMIT)
        limit += limit / 8;
    assert_int_equal(play_through(f, limit, forgets), ADCGS_OK);
    return limit;
}

/** Discarded segments take no memory. */
static void test_forget(void **state)
{
    const fixture *f = *state;
    void *other;
    fixture *longer = fixture_new(&other);
    adcgs_params params;
    uint64_t seed = 8;
    adcgs_random_small_params(&params, 2, &seed);
    assert_int_equal(fixture_turns(longer, &params, 48, 300, 5, 20, &seed), 0);
    assert_int_equal(play_through(f, 0, 1), ADCGS_OK);
    const uint64_t all = least_memory(longer, 0), few = least_memory(longer, 1);
    print_message("48 segments take %llu bytes, or %llu with discarding\n", (unsigned long long)all, (unsigned long long)few);
    assert_true(few < all / 2); /* the networks of 16 keys remain */
    teardown(&other);

    adcgs_decoder *whole = NULL;
    assert_int_equal(adcgs_open_memory(&whole, f->bytes.data, f->bytes.size, NULL, NULL), ADCGS_OK);
    assert_int_equal(adcgs_push_discard_before(whole, 0, NULL), ADCGS_ERR_USAGE);
    adcgs_close(&whole);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cut_anywhere), cmocka_unit_test(test_every_prefix), cmocka_unit_test(test_arrivals),
        cmocka_unit_test(test_damage),       cmocka_unit_test(test_final),        cmocka_unit_test(test_forget),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Reading on demand: a seeker gives the same result as reading the whole stream, in any order. It reads only the necessary bytes,
 * holds one segment, or two during a crossfade, and detects damage as well.
 */
#include "stream_fixture.h"

#include "base/cpu_detect.h"
#include "stream/chunk.h"
#include "stream/input.h"
#include "stream/seek.h"

#include <adcgs/adcgs.h>

#include <stdio.h>

enum { SEGMENTS = 9 };

/** A stream in memory that can be read anywhere and counts the bytes read. */
typedef struct source {
    const uint8_t *data;
    size_t size;
    uint64_t bytes;
    uint64_t fails_at; /* byte that cannot be read; 0: all can */
    size_t piece;      /* maximum bytes per read */
} source;

static int64_t read_at(void *user, uint64_t offset, void *buffer, size_t bytes)
{
    source *s = user;
    const size_t n = bytes < s->piece ? bytes : s->piece;
    assert_true(offset < s->size && bytes <= s->size - offset);
    if (s->fails_at && offset <= s->fails_at && s->fails_at < offset + n)
        return -1;
    memcpy(buffer, s->data + offset, n);
    s->bytes += n;
    return (int64_t)n;
}

static uint8_t digests[SEGMENTS][16];

static source source_of(const adcgs_buffer *bytes)
{
    return (source){.data = bytes->data, .size = bytes->size, .piece = SIZE_MAX};
}

/** Keys and predicted segments in turns of three. */
static int setup(void **state)
{
    fixture *f = fixture_new(state);
    adcgs_stream *s = &f->stream;
    uint64_t seed = 21;
    adcgs_random_params(&s->params, 1, &seed);
    if (adcgs_random_turns(s, SEGMENTS, 150, 5, 20, &seed, NULL) != ADCGS_OK)
        return -1;
    for (int i = 0; i < SEGMENTS; i++)
        adcgs_model_digest(&s->segments[i], digests[i]);
    return adcgs_stream_write(s, &f->bytes, NULL) == ADCGS_OK ? 0 : -1;
}

static adcgs_decoder *open_on_demand(source *s)
{
    adcgs_decoder *d = NULL;
    adcgs_error error = {ADCGS_OK, ""};
    if (adcgs_open_at(&d, read_at, s, s->size, NULL, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    return d;
}

static void check_segment(adcgs_decoder *d, const fixture *f, int segment)
{
    uint8_t digest[16];
    adcgs_error error = {ADCGS_OK, ""};
    if (adcgs_get_model_digest(d, segment, digest, &error) != ADCGS_OK)
        fail_msg("segment %d: %s", segment, error.text);
    assert_memory_equal(digest, digests[segment], sizeof digest);
}

/** Any order, forwards, backwards and again: models and splats are those of the whole stream. */
static void test_any_order(void **state)
{
    const fixture *f = *state;
    source s = source_of(&f->bytes);
    s.piece = 100;
    adcgs_decoder *d = open_on_demand(&s), *whole = NULL;
    uint64_t seed = 5;
    assert_int_equal(adcgs_open_memory(&whole, f->bytes.data, f->bytes.size, NULL, NULL), ADCGS_OK);
    for (int i = 0; i < SEGMENTS; i++)
        check_segment(d, f, i);
    for (int i = SEGMENTS - 1; i >= 0; i--)
        check_segment(d, f, i);
    for (int i = 0; i < 60; i++) {
        const double time = (double)adcgs_random_range(&seed, -20, 40 * SEGMENTS + 20) * 1e-3;
        uint8_t ours[16], theirs[16];
        check_segment(d, f, (int)adcgs_random_range(&seed, 0, SEGMENTS - 1));
        assert_int_equal(adcgs_get_splat_digest(d, time, ours, NULL), ADCGS_OK);
        assert_int_equal(adcgs_get_splat_digest(whole, time, theirs, NULL), ADCGS_OK);
        assert_memory_equal(ours, theirs, sizeof ours);
    }
    adcgs_info a, b;
    adcgs_get_info(d, &a, sizeof a, NULL);
    adcgs_get_info(whole, &b, sizeof b, NULL);
    assert_int_equal(a.segments, SEGMENTS);
    assert_true(a.time_start == b.time_start && a.time_end == b.time_end && a.frame_rate == b.frame_rate);
    adcgs_close(&whole);
    adcgs_close(&d);
}

/** Offsets of the segments' chunks: the data before segment i ends at begin[i], and the last segment at begin[SEGMENTS]. */
static void find_segments(const adcgs_buffer *bytes, size_t begin[SEGMENTS + 1])
{
    size_t n = 0;
    for (size_t at = ADCGS_SIGNATURE_BYTES; at < bytes->size; at += ADCGS_CHUNK_BYTES + adcgs_load_le32(bytes->data + at + 4)) {
        const uint32_t type = adcgs_load_le32(bytes->data + at);
        if (type == ADCGS_TYPE_SEGM || type == ADCGS_TYPE_INDX)
            begin[n++] = at;
    }
    assert_int_equal(n, SEGMENTS + 1);
}

/**
 * Opening reads the header and the index, seeking the segments back to the key, and nothing else. Continuing reads the next
 * segment alone.
 */
static void test_bytes_read(void **state)
{
    const fixture *f = *state;
    size_t begin[SEGMENTS + 1];
    find_segments(&f->bytes, begin);
    const size_t index = f->bytes.size - begin[SEGMENTS] - 32, front = begin[0] + index;
    for (int i = 0; i < SEGMENTS; i++) {
        const int key = i - i % 3;
        source s = source_of(&f->bytes);
        uint8_t digest[16];
        adcgs_decoder *d = open_on_demand(&s);
        /* Headers of chunks are read before the chunks: 16 bytes each, twice. */
        const uint64_t opened = s.bytes, most_headers = 16 * 64;
        assert_in_range(opened, front, front + most_headers);
        assert_int_equal(adcgs_get_splat_digest(d, 0.001 * (40 * i + 1), digest, NULL), ADCGS_OK);
        const uint64_t wanted = begin[i + 1] - begin[key];
        assert_in_range(s.bytes - opened, wanted, wanted + most_headers);
        const uint64_t then = s.bytes;
        assert_int_equal(adcgs_get_splat_digest(d, 0.001 * (40 * i + 39), digest, NULL), ADCGS_OK);
        assert_int_equal(s.bytes, then);
        if (i + 1 < SEGMENTS) {
            check_segment(d, f, i + 1);
            assert_in_range(s.bytes - then, begin[i + 2] - begin[i + 1], begin[i + 2] - begin[i + 1] + most_headers);
        }
        adcgs_info info;
        adcgs_get_info(d, &info, sizeof info, NULL);
        assert_int_equal(info.bytes.total, s.bytes);
        adcgs_close(&d);
    }
}

/** Copies a stream without one of its chunks. No checksum detects this. */
static void leave_out(adcgs_buffer *to, const adcgs_buffer *from, size_t begin, size_t end)
{
    adcgs_buffer_init(to);
    adcgs_write_bytes(to, from->data, begin);
    adcgs_write_bytes(to, from->data + end, from->size - end);
}

/** If the index is missing, damaged or misplaced, headers of chunks are used to find the segments. */
static void test_no_index(void **state)
{
    const fixture *f = *state;
    size_t begin[SEGMENTS + 1];
    adcgs_buffer bytes;
    find_segments(&f->bytes, begin);
    leave_out(&bytes, &f->bytes, begin[SEGMENTS], f->bytes.size - 32);
    for (int damage = 0; damage < 3; damage++) {
        source s = source_of(&bytes);
        adcgs_decoder *d = open_on_demand(&s);
        assert_in_range(s.bytes, begin[0], begin[0] + f->bytes.size / 4);
        for (int i = SEGMENTS - 1; i >= 0; i--)
            check_segment(d, f, i);
        adcgs_close(&d);
        adcgs_buffer_clear(&bytes);
        leave_out(&bytes, &f->bytes, 0, 0);
        if (damage == 0)
            bytes.data[begin[SEGMENTS] + 30] ^= 1;
        else
            adcgs_write_bytes(&bytes, (const uint8_t *)"behind the end", 14);
    }
    adcgs_buffer_clear(&bytes);
}

/** A damaged segment is an error when it is requested. The others stay available. */
static void test_damage(void **state)
{
    const fixture *f = *state;
    size_t begin[SEGMENTS + 1];
    adcgs_buffer bytes;
    uint8_t digest[16];
    adcgs_error error = {ADCGS_OK, ""};
    find_segments(&f->bytes, begin);
    leave_out(&bytes, &f->bytes, 0, 0);
    bytes.data[begin[5] - 60] ^= 4; /* in segment 4, whose key is 3 */
    source s = source_of(&bytes);
    adcgs_decoder *d = open_on_demand(&s);
    for (int i = 0; i < SEGMENTS; i++)
        if (i == 4 || i == 5)
            assert_int_equal(adcgs_get_model_digest(d, i, digest, &error), ADCGS_ERR_DATA);
        else
            check_segment(d, f, i);
    assert_true(error.text[0] && !strchr(error.text, '\n'));
    s.fails_at = begin[7] + 40;
    assert_int_equal(adcgs_get_splat_digest(d, 0.29, digest, &error), ADCGS_ERR_IO);
    s.fails_at = 0;
    check_segment(d, f, 7);
    adcgs_close(&d);
    adcgs_buffer_clear(&bytes);
}

/** Every byte of the front and the index, one at a time, is changed. The result is an error or another way to the same models. */
static void test_every_byte(void **state)
{
    const fixture *f = *state;
    size_t begin[SEGMENTS + 1];
    adcgs_buffer bytes;
    find_segments(&f->bytes, begin);
    leave_out(&bytes, &f->bytes, 0, 0);
    for (size_t i = 0; i < bytes.size; i++) {
        if (i == begin[0] + 100)
            i = begin[SEGMENTS];
        bytes.data[i] ^= 0x10;
        source s = source_of(&bytes);
        adcgs_decoder *d = NULL;
        uint8_t digest[16];
        adcgs_error error = {ADCGS_OK, ""};
        if (adcgs_open_at(&d, read_at, &s, s.size, NULL, &error) == ADCGS_OK &&
            adcgs_get_model_digest(d, 8, digest, &error) == ADCGS_OK)
            assert_memory_equal(digest, digests[8], sizeof digest);
        adcgs_close(&d);
        bytes.data[i] ^= 0x10;
    }
    adcgs_buffer_clear(&bytes);
}

/** Cut anywhere, with the same result as reading in order. */
static void test_truncated(void **state)
{
    const fixture *f = *state;
    for (size_t size = 0; size < f->bytes.size; size += f->bytes.size / 211 + 1) {
        source s = {.data = f->bytes.data, .size = size, .piece = SIZE_MAX};
        adcgs_decoder *d = NULL, *whole = NULL;
        adcgs_error error = {ADCGS_OK, ""};
        const adcgs_status status = adcgs_open_memory(&whole, f->bytes.data, size, NULL, NULL);
        assert_int_equal(adcgs_open_at(&d, read_at, &s, size, NULL, &error), status);
        adcgs_info a, b;
        if (status == ADCGS_OK) {
            adcgs_get_info(d, &a, sizeof a, NULL);
            adcgs_get_info(whole, &b, sizeof b, NULL);
            assert_int_equal(a.segments, b.segments);
            assert_true(a.truncated);
        }
        adcgs_close(&d);
        adcgs_close(&whole);
    }
}

/** A hundred segments take the memory of a few. */
static void test_memory(void **state)
{
    adcgs_stream stream;
    adcgs_params params;
    adcgs_buffer bytes;
    uint64_t seed = 3;
    (void)state;
    adcgs_random_params(&params, 1, &seed);
    adcgs_stream_init(&stream);
    adcgs_buffer_init(&bytes);
    stream.params = params;
    stream.segments = adcgs_alloc(NULL, 100, sizeof *stream.segments, NULL);
    for (uint32_t i = 0; i < 100; i++) {
        adcgs_model *m = &stream.segments[stream.n_segments++];
        if (i % 5)
            assert_int_equal(adcgs_random_follower(m, m - 1, 30, &seed, NULL), ADCGS_OK);
        else
            assert_int_equal(adcgs_random_model(m, &params, 400, 5, &seed, NULL), ADCGS_OK);
        m->time_start = adcgs_ticks_to_seconds(&stream, i);
        m->time_end = adcgs_ticks_to_seconds(&stream, i + 1);
        m->reach = adcgs_ticks_to_seconds(&stream, 1);
    }
    assert_int_equal(adcgs_stream_write(&stream, &bytes, NULL), ADCGS_OK);
    source s = source_of(&bytes);
    adcgs_memory memory = {.limit = 0};
    const adcgs_read_options options = {.cpu = ADCGS_CPU_SCALAR, .memory = &memory};
    adcgs_stream played;
    adcgs_seek *seek;
    adcgs_span span = {.next = bytes.data, .left = bytes.size};
    assert_int_equal(adcgs_stream_read(&played, adcgs_span_read, &span, &options, NULL, NULL, NULL), ADCGS_OK);
    const uint64_t whole = memory.peak;
    adcgs_stream_clear(&played, &memory);
    memory.peak = 0;
    adcgs_stream_init(&played);
    assert_int_equal(adcgs_seek_open(&seek, &played, read_at, &s, s.size, &options, NULL), ADCGS_OK);
    for (uint32_t i = 0; i < 100; i++) {
        adcgs_error difference;
        assert_int_equal(adcgs_seek_to(seek, i, i > 0, NULL), ADCGS_OK);
        for (uint32_t j = i > 0 ? i - 1 : i; j <= i; j++) {
            const adcgs_model *const model = adcgs_seek_at_hand(seek, j);
            assert_non_null(model);
            if (!adcgs_model_equal(model, &stream.segments[j], &difference))
                fail_msg("segment %u: %s", j, difference.text);
        }
        assert_true(played.n_segments == (i > 0 ? 2 : 1));
    }
    assert_in_range(memory.peak, 1, whole / 8);
    adcgs_seek_free(&seek);
    adcgs_stream_clear(&played, &memory);
    assert_int_equal(memory.used, 0);
    adcgs_stream_clear(&stream, NULL);
    adcgs_buffer_clear(&bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_any_order), cmocka_unit_test(test_bytes_read), cmocka_unit_test(test_no_index),
        cmocka_unit_test(test_damage),    cmocka_unit_test(test_every_byte), cmocka_unit_test(test_truncated),
        cmocka_unit_test(test_memory),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Growing streams hold the same data as streams written at once, and are read alike. A failure changes nothing. After tune-in at
 * any byte, a decoder has everything from the next key on.
 */
#include "random_model.h"

#include "stream/chunk.h"
#include "stream/grow.h"
#include "stream/input.h"

#include <adcgs/adcgs.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

enum { SEGMENTS = 7, TURN = 3 }; /* every third segment is a key */

typedef struct fixture {
    adcgs_stream stream;
    adcgs_buffer whole, grown;
    size_t at[SEGMENTS + 1]; /* offsets of the segments in grown, and the end of the last */
    adcgs_buffer head;       /* of grown, settled */
} fixture;

/** The data shared by all segments, without the segments. */
static adcgs_stream front_of(const adcgs_stream *s, uint8_t level)
{
    adcgs_stream front = *s;
    front.segments = NULL;
    front.n_segments = 0;
    front.level = level;
    return front;
}

static adcgs_status grow_all(fixture *f)
{
    adcgs_stream front = front_of(&f->stream, 3);
    adcgs_grow *grow;
    adcgs_status status = adcgs_grow_create(&grow, &front, 1000, NULL);
    for (uint32_t i = 0; i < SEGMENTS && status == ADCGS_OK; i++) {
        adcgs_model *model = &f->stream.segments[i];
        f->at[i] = f->grown.size;
        status = adcgs_grow_segment(grow, i ? model - 1 : NULL, model, &f->grown, NULL);
    }
    f->at[SEGMENTS] = f->grown.size;
    if (status == ADCGS_OK)
        status = adcgs_grow_end(grow, &f->grown, NULL);
    if (status == ADCGS_OK)
        status = adcgs_grow_settle(grow, &f->head, NULL);
    adcgs_grow_free(&grow);
    return status;
}

static int setup(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    adcgs_params params;
    uint64_t seed = 33;
    adcgs_stream *s = &f->stream;
    adcgs_random_small_params(&params, 2, &seed);
    adcgs_buffer_init(&f->whole);
    adcgs_buffer_init(&f->grown);
    adcgs_buffer_init(&f->head);
    adcgs_stream_init(s);
    s->params = params;
    s->slice_log2 = ADCGS_SLICE_LOG2_MIN;
    if (adcgs_random_front(s, NULL) != ADCGS_OK || adcgs_random_turns(s, SEGMENTS, 80, TURN, 70, &seed, NULL) != ADCGS_OK)
        return -1;
    *state = f;
    return adcgs_stream_write(s, &f->whole, NULL) == ADCGS_OK && grow_all(f) == ADCGS_OK ? 0 : -1;
}

static int teardown(void **state)
{
    fixture *f = *state;
    adcgs_stream_clear(&f->stream, NULL);
    adcgs_buffer_clear(&f->whole);
    adcgs_buffer_clear(&f->grown);
    adcgs_buffer_clear(&f->head);
    free(f);
    return 0;
}

/** Expects the decoder's segments to be those of the stream from `first` on. */
static void check_models(const fixture *f, adcgs_decoder *d, uint32_t first)
{
    uint8_t expected[16], found[16];
    for (uint32_t i = first; i < SEGMENTS; i++) {
        adcgs_model_digest(&f->stream.segments[i], expected);
        assert_int_equal(adcgs_get_model_digest(d, (int)i, found, NULL), ADCGS_OK);
        assert_memory_equal(found, expected, 16);
    }
    assert_int_equal(adcgs_get_model_digest(d, (int)first - 1, found, NULL), ADCGS_ERR_USAGE);
    assert_int_equal(adcgs_get_model_digest(d, SEGMENTS, found, NULL), ADCGS_ERR_USAGE);
}

/** The next chunk at or behind *at that is no HEAD. */
static adcgs_chunk next_other(const adcgs_buffer *b, size_t *at)
{
    adcgs_chunk chunk;
    do {
        assert_true(*at + ADCGS_CHUNK_BYTES <= b->size);
        assert_int_equal(adcgs_chunk_header(b->data + *at, *at, &chunk, NULL), ADCGS_OK);
        *at += ADCGS_CHUNK_BYTES + chunk.header.length;
    } while (chunk.type == ADCGS_TYPE_HEAD);
    return chunk;
}

/** Except for HEAD, INDX and ENDC, a grown stream has the same chunks as one written at once. */
static void test_same(void **state)
{
    const fixture *f = *state;
    size_t a = ADCGS_SIGNATURE_BYTES, b = ADCGS_SIGNATURE_BYTES;
    uint32_t type;
    adcgs_decoder *d = NULL;
    adcgs_info info;
    do {
        const adcgs_chunk x = next_other(&f->whole, &a), y = next_other(&f->grown, &b);
        type = x.type;
        assert_int_equal(x.type, y.type);
        assert_int_equal(x.header.length, y.header.length);
        if (type != ADCGS_TYPE_INDX && type != ADCGS_TYPE_ENDC)
            assert_memory_equal(f->whole.data + x.origin, f->grown.data + y.origin, ADCGS_CHUNK_BYTES + x.header.length);
    } while (type != ADCGS_TYPE_ENDC);
    assert_int_equal(b, f->grown.size);
    assert_int_equal(adcgs_open_memory(&d, f->grown.data, f->grown.size, NULL, NULL), ADCGS_OK); /* checks INDX and ENDC */
    check_models(f, d, 0);
    assert_int_equal(adcgs_get_info(d, &info, sizeof info, NULL), ADCGS_OK);
    assert_int_equal(info.first_segment, 0);
    adcgs_close(&d);
}

static int64_t read_at(void *user, uint64_t offset, void *buffer, size_t bytes)
{
    const adcgs_buffer *b = user;
    memcpy(buffer, b->data + offset, bytes);
    return (int64_t)bytes;
}

/** Segments are found by the headers of all chunks, or by the index if HEAD is settled. */
static void test_seek(void **state)
{
    fixture *f = *state;
    adcgs_decoder *d = NULL;
    adcgs_info info;
    assert_int_equal(adcgs_open_at(&d, read_at, &f->grown, f->grown.size, NULL, NULL), ADCGS_OK);
    check_models(f, d, 0);
    assert_int_equal(adcgs_get_info(d, &info, sizeof info, NULL), ADCGS_OK);
    assert_int_equal(info.segments, SEGMENTS);
    adcgs_close(&d);
}

/** The settled HEAD equals that of the stream written at once. The grown one only has room for more anchors. */
static void test_settle(void **state)
{
    const fixture *f = *state;
    adcgs_chunk chunk;
    assert_int_equal(adcgs_chunk_header(f->whole.data + ADCGS_SIGNATURE_BYTES, 0, &chunk, NULL), ADCGS_OK);
    assert_int_equal(f->head.size, chunk.header.length);
    assert_memory_equal(f->head.data, f->whole.data + ADCGS_SIGNATURE_BYTES + ADCGS_CHUNK_HEADER_BYTES, f->head.size);
}

/** Segments that do not fit, or do not follow, change nothing. */
static void test_refused(void **state)
{
    const fixture *f = *state;
    adcgs_stream front = front_of(&f->stream, 3), small = front_of(&f->stream, 1);
    adcgs_grow *grow = NULL;
    adcgs_buffer out;
    adcgs_buffer_init(&out);
    adcgs_model *models = f->stream.segments;
    assert_int_equal(adcgs_grow_create(&grow, &front, ADCGS_ANCHORS_MAX + 1, NULL), ADCGS_ERR_LIMIT);
    assert_int_equal(adcgs_grow_create(&grow, &small, 5000, NULL), ADCGS_ERR_LIMIT);
    assert_null(grow);
    assert_int_equal(adcgs_grow_create(&grow, &front, 1000, NULL), ADCGS_OK);
    assert_int_equal(adcgs_grow_end(grow, &out, NULL), ADCGS_ERR_USAGE);
    assert_int_equal(adcgs_grow_segment(grow, NULL, &models[1], &out, NULL), ADCGS_ERR_USAGE); /* predicted */
    assert_int_equal(adcgs_grow_segment(grow, NULL, &models[0], &out, NULL), ADCGS_OK);
    assert_int_equal(adcgs_grow_segment(grow, NULL, &models[0], &out, NULL), ADCGS_ERR_USAGE); /* the same segment again */
    assert_int_equal(out.size, f->at[1]);
    assert_int_equal(adcgs_grow_segment(grow, &models[0], &models[1], &out, NULL), ADCGS_OK);
    assert_int_equal(out.size, f->at[2]);
    assert_memory_equal(out.data, f->grown.data, out.size);
    adcgs_grow_free(&grow);

    out.size = 0;
    adcgs_model deep = models[3];
    deep.depth = 13; /* deeper than the level allows, which is detected when HEAD and SEGM are written */
    assert_int_equal(adcgs_grow_create(&grow, &small, models[0].n - 1, NULL), ADCGS_OK);
    assert_int_equal(adcgs_grow_segment(grow, NULL, &models[0], &out, NULL), ADCGS_ERR_LIMIT); /* larger than promised */
    assert_int_equal(out.size, 0);
    adcgs_grow_free(&grow);
    assert_int_equal(adcgs_grow_create(&grow, &small, 400, NULL), ADCGS_OK);
    for (uint32_t i = 0; i < 3; i++)
        assert_int_equal(adcgs_grow_segment(grow, i ? &models[i - 1] : NULL, &models[i], &out, NULL), ADCGS_OK);
    assert_int_equal(adcgs_grow_segment(grow, &models[2], &deep, &out, NULL), ADCGS_ERR_LIMIT);
    assert_int_equal(out.size, f->at[3]);
    assert_int_equal(adcgs_grow_segment(grow, &models[2], &models[3], &out, NULL), ADCGS_OK);
    assert_int_equal(out.size, f->at[4]);
    out.failed = 1; /* memory ran out */
    assert_int_equal(adcgs_grow_end(grow, &out, NULL), ADCGS_ERR_MEMORY);
    assert_int_equal(out.size, f->at[4]);
    out.failed = 0;
    assert_int_equal(adcgs_grow_end(grow, &out, NULL), ADCGS_OK);
    adcgs_decoder *d = NULL;
    uint8_t digest[16];
    assert_int_equal(adcgs_open_memory(&d, out.data, out.size, NULL, NULL), ADCGS_OK);
    assert_int_equal(adcgs_get_model_digest(d, 3, digest, NULL), ADCGS_OK);
    assert_int_equal(adcgs_get_model_digest(d, 4, digest, NULL), ADCGS_ERR_USAGE);
    adcgs_close(&d);
    adcgs_grow_free(&grow);
    adcgs_buffer_clear(&out);
}

/* ---- Tune-in ---- */

static adcgs_config joining(void)
{
    adcgs_config config;
    adcgs_config_init(&config, sizeof config);
    config.threads = 1;
    config.tune_in = 1;
    return config;
}

/** The first key whose HEAD is at or behind this byte of the stream. */
static uint32_t next_key(const fixture *f, size_t at)
{
    uint32_t i = TURN;
    if (at <= ADCGS_SIGNATURE_BYTES)
        return 0;
    while (i < SEGMENTS && at > f->at[i])
        i += TURN;
    return i;
}

static adcgs_status push_from(adcgs_decoder *d, const adcgs_buffer *b, size_t at, size_t end, size_t piece, int heads[1],
                              adcgs_error *error)
{
    adcgs_status status = ADCGS_OK;
    adcgs_arrival arrived = ADCGS_ARRIVED_NOTHING;
    while (at < end && status == ADCGS_OK && arrived != ADCGS_ARRIVED_END) {
        size_t used;
        status = adcgs_push(d, b->data + at, ADCGS_MIN(piece, end - at), &used, &arrived, error);
        heads[0] += arrived == ADCGS_ARRIVED_HEADER;
        at += used;
    }
    return status == ADCGS_OK ? adcgs_push_end(d, error) : status;
}

/** Tune-in at each byte gives all segments from the next key on, and reports which key that is; nothing if there is none. */
static void test_join(void **state)
{
    const fixture *f = *state;
    const adcgs_config config = joining();
    for (size_t at = 0; at < f->grown.size; at += at < 200 || at % 13 == 0 || at + 40 > f->at[TURN] ? 1 : 2) {
        const uint32_t first = next_key(f, at);
        const size_t left = f->grown.size - at;
        adcgs_decoder *pushed = NULL, *read = NULL;
        adcgs_span from = {.next = f->grown.data + at, .left = left, .step = 50};
        adcgs_info info;
        int heads[1] = {0};
        if (at % 9 && at > 200 && at + 3 < f->at[first < SEGMENTS ? first : SEGMENTS]) /* trying every byte would be slow */
            continue;
        assert_int_equal(adcgs_open_push(&pushed, &config, NULL), ADCGS_OK);
        const adcgs_status status = push_from(pushed, &f->grown, at, f->grown.size, at % 7 ? 1000 : 1, heads, NULL);
        assert_int_equal(adcgs_open_stream(&read, adcgs_span_read, &from, &config, NULL), status);
        assert_int_equal(status, first < SEGMENTS ? ADCGS_OK : ADCGS_ERR_DATA);
        if (status == ADCGS_OK) {
            assert_int_equal(heads[0], 1);
            check_models(f, pushed, first);
            check_models(f, read, first);
            assert_int_equal(adcgs_get_info(read, &info, sizeof info, NULL), ADCGS_OK);
            assert_int_equal(info.first_segment, first);
            assert_int_equal(info.cameras, first == 0);
            assert_true(info.time_start == f->stream.segments[first].time_start && !info.truncated);
            assert_int_equal(adcgs_get_info(pushed, &info, sizeof info, NULL), ADCGS_OK);
            assert_int_equal(info.first_segment, first);
        }
        adcgs_close(&read);
        adcgs_close(&pushed);
    }
}

/** After tune-in nothing can be rendered before a usable part of the key is present. */
static void test_join_early(void **state)
{
    const fixture *f = *state;
    const adcgs_config config = joining();
    const double time = f->stream.segments[TURN].time_start;
    adcgs_decoder *d = NULL;
    adcgs_primitives primitives;
    adcgs_arrival arrived = ADCGS_ARRIVED_NOTHING;
    size_t at = f->at[TURN], parts = 0;
    assert_int_equal(adcgs_open_push(&d, &config, NULL), ADCGS_OK);
    while (arrived != ADCGS_ARRIVED_SEGMENT) {
        size_t used;
        assert_int_equal(adcgs_push(d, f->grown.data + at, f->grown.size - at, &used, &arrived, NULL), ADCGS_OK);
        at += used;
        parts++;
        assert_int_equal(adcgs_get_primitives(d, time, &primitives, NULL),
                         arrived == ADCGS_ARRIVED_SEGMENT ? ADCGS_OK : ADCGS_ERR_USAGE);
    }
    assert_true(parts > 3); /* HEAD, SEGM, GEOM, a layer */
    adcgs_close(&d);
}

/** Garbage in front; an invalid header; a damaged payload of a header; a stream that ends before its key; no tune-in. */
static void test_join_damage(void **state)
{
    const fixture *f = *state;
    const adcgs_config config = joining();
    const size_t key = f->at[TURN], head = f->head.size + ADCGS_CHUNK_BYTES;
    adcgs_decoder *d = NULL;
    adcgs_error error;
    adcgs_buffer b;
    adcgs_span from;
    int heads[1] = {0};
    adcgs_buffer_init(&b);
    for (int i = 0; i < 5000; i++)
        adcgs_write_bytes(&b,
                          &"HEADaHEA\x8B"
                           "ADCG"[i % 7],
                          6);
    const size_t damaged = b.size;
    adcgs_write_bytes(&b, f->grown.data + key, head);
    b.data[damaged + 30] ^= 4;
    adcgs_write_bytes(&b, f->grown.data + key, f->grown.size - key);
    assert_int_equal(adcgs_open_push(&d, &config, NULL), ADCGS_OK);
    assert_int_equal(push_from(d, &b, 0, b.size, 333, heads, NULL), ADCGS_OK);
    check_models(f, d, TURN);
    adcgs_close(&d);

    for (size_t end = damaged; end < b.size; end += end < b.size - 400 ? 11 : 1) { /* after tune-in the stream may end early */
        assert_int_equal(adcgs_open_push(&d, &config, NULL), ADCGS_OK);
        const adcgs_status status = push_from(d, &b, 0, end, 4096, heads, &error);
        assert_true(status == ADCGS_OK || status == (end < damaged + 2 * head ? ADCGS_ERR_DATA : ADCGS_ERR_TRUNCATED));
        adcgs_close(&d);
    }
    assert_int_equal(adcgs_open_push(&d, &config, NULL), ADCGS_OK);
    assert_int_equal(push_from(d, &b, 0, damaged, 4096, heads, &error), ADCGS_ERR_DATA);
    assert_non_null(strstr(error.text, "30000 bytes"));
    adcgs_close(&d);
    from = (adcgs_span){.next = f->grown.data + 100, .left = f->grown.size - 100};
    assert_int_equal(adcgs_open_stream(&d, adcgs_span_read, &from, NULL, NULL), ADCGS_ERR_DATA);
    assert_null(d);
    adcgs_buffer_clear(&b);
}

/** The source is read to the end of the stream and not beyond, with and without tune-in. */
static void test_not_beyond(void **state)
{
    const fixture *f = *state;
    const adcgs_config config = joining();
    adcgs_buffer b;
    adcgs_buffer_init(&b);
    adcgs_write_bytes(&b, f->grown.data, f->grown.size);
    adcgs_write_bytes(&b, "what follows", 12);
    for (size_t at = 0; at < 2; at++) {
        adcgs_decoder *d = NULL;
        adcgs_span from = {.next = b.data + at, .left = b.size - at};
        assert_int_equal(adcgs_open_stream(&d, adcgs_span_read, &from, &config, NULL), ADCGS_OK);
        assert_int_equal(from.left, 12);
        adcgs_close(&d);
    }
    adcgs_buffer_clear(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_same),       cmocka_unit_test(test_seek),       cmocka_unit_test(test_settle),
        cmocka_unit_test(test_refused),    cmocka_unit_test(test_join),       cmocka_unit_test(test_join_damage),
        cmocka_unit_test(test_join_early), cmocka_unit_test(test_not_beyond),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}

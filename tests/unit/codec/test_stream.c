/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Streams: writing and reading are inverse for any valid model, for any order of arrival and any way of decoding. */
#include "checked_streams.h"
#include "random_model.h"

#include "base/cpu_detect.h"
#include "base/digest.h"
#include "base/thread_pool.h"
#include "model/latents.h"
#include "model/model_priv.h"
#include "stream/chunk.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

/** Bytes that arrive in pieces. */
typedef struct pipe {
    const uint8_t *data;
    size_t size, pos, piece;
} pipe;

static int64_t read_pipe(void *user, void *buffer, size_t bytes)
{
    pipe *p = user;
    const size_t n = ADCGS_MIN(ADCGS_MIN(bytes, p->piece), p->size - p->pos);
    if (n > 0)
        memcpy(buffer, p->data + p->pos, n);
    p->pos += n;
    return (int64_t)n;
}

static void check_round_trip(adcgs_stream *stream)
{
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_stream back;
    adcgs_buffer bytes, again;
    adcgs_buffer_init(&bytes);
    adcgs_buffer_init(&again);
    check(adcgs_stream_write(stream, &bytes, &error), &error);
    assert_true(stream->bytes.total == bytes.size);
    check(read_stream(&back, bytes.data, bytes.size, &plain, &error), &error);
    check_equal(stream, &back);
    assert_false(back.truncated);
    check(adcgs_stream_write(&back, &again, &error), &error);
    assert_int_equal(bytes.size, again.size);
    assert_memory_equal(bytes.data, again.data, bytes.size);
    adcgs_buffer_clear(&bytes);
    adcgs_buffer_clear(&again);
    adcgs_stream_clear(&back, NULL);
}

static void make_stream(adcgs_stream *stream, int moving, uint32_t segments, uint32_t n, uint64_t seed)
{
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_params params;
    adcgs_random_params(&params, moving, &seed);
    check(adcgs_random_stream(stream, &params, segments, n, 5, &seed, &error), &error);
}

/* REQ-STRM-001, REQ-STRM-006, REQ-STRM-007, REQ-STRM-013, REQ-STRM-016, REQ-LATN-001, REQ-LATN-002, REQ-LATN-003,
   REQ-LATN-004, REQ-LATN-005, REQ-LATN-006, REQ-LATN-010 */
static void test_round_trip(void **state)
{
    static const uint32_t counts[] = {1, 3, 63, 64, 65, 300, 700};
    (void)state;
    for (uint64_t seed = 1; seed <= 42; seed++) {
        adcgs_stream stream;
        make_stream(&stream, (int)(seed & 1), 1 + (uint32_t)(seed % 4), counts[seed % ADCGS_COUNTOF(counts)], seed);
        check_round_trip(&stream);
        adcgs_stream_clear(&stream, NULL);
    }
}

/** Bodies in any order, with static anchors between them, are decoded exactly. */
/* REQ-LATN-013 */
static void test_bodies(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 12; seed++) {
        adcgs_error error = {ADCGS_OK, ""};
        adcgs_params params;
        adcgs_stream stream;
        uint64_t random = seed;
        adcgs_random_params(&params, 1, &random);
        params.bodies = (uint8_t)(seed % 3 ? ADCGS_BODIES_MAX : 1);
        params.spans = 0;
        check(adcgs_random_stream(&stream, &params, 1, 200, 5, &random, &error), &error);
        adcgs_model *const m = &stream.segments[0];
        for (uint32_t i = 0; i < m->n; i++)
            m->body[i] = (uint8_t)(m->is_static[i] ? 0 : seed & 4 ? i / 40 % (params.bodies + 1U) : i % (params.bodies + 1U));
        check_round_trip(&stream);
        adcgs_stream_clear(&stream, NULL);
    }
}

/** Decodes the flags of two moving anchors with all primitives and these bodies; a negative one: the same as before. */
static adcgs_status decode_bodies(adcgs_model *m, int first, int second, adcgs_error *error)
{
    adcgs_adaptive flag[1], same[2], tree[16], mask[4];
    adcgs_range_enc e;
    adcgs_range_dec d;
    adcgs_buffer out;
    adcgs_buffer_init(&out);
    adcgs_range_enc_init(&e, &out);
    adcgs_adaptive_init(flag, 1);
    adcgs_adaptive_init(same, 2);
    adcgs_adaptive_init(tree, 16);
    adcgs_adaptive_init(mask, 4);
    for (int i = 0; i < 2; i++) {
        const int body = i ? second : first;
        adcgs_adaptive_enc(&e, &flag[0], 0);
        adcgs_adaptive_enc(&e, &same[i && first > 0], body < 0);
        for (int node = 1, bit = 3; body >= 0 && bit >= 0; bit--) {
            adcgs_adaptive_enc(&e, &tree[node], body >> bit & 1);
            node = 2 * node + (body >> bit & 1);
        }
        for (int k = 0; k < m->params.k; k++)
            adcgs_adaptive_enc(&e, &mask[3], 1);
    }
    adcgs_range_enc_finish(&e);
    adcgs_range_dec_init(&d, out.data, out.size);
    const adcgs_status status = adcgs_latents_decode_flags(m, 0, 2, &d, error);
    adcgs_buffer_clear(&out);
    return status;
}

/** A coded body must exist, and differ from the body that is inferred without coding. */
/* REQ-LATN-013, REQ-LATN-014 */
static void test_bodies_refused(void **state)
{
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_model m = {.n = 2, .params = {.k = 2, .n_fv = 1, .chunks = 1, .bodies = 5, .time_rows = 1, .time_width = 1}};
    (void)state;
    check(adcgs_model_alloc(&m, NULL, &error), &error);
    for (int first = -1; first < 16; first++)
        for (int second = -1; second < 16; second++) {
            const int a = first < 0 ? 0 : first, b = second < 0 ? a : second;
            const int good = first != 0 && a <= 5 && second != a && b <= 5;
            assert_int_equal(decode_bodies(&m, first, second, &error), good ? ADCGS_OK : ADCGS_ERR_DATA);
            if (good)
                assert_true(m.body[0] == a && m.body[1] == b && m.mask[0] == 3 && m.mask[1] == 3);
            else
                assert_non_null(strstr(error.text, first != 0 && a <= 5 ? "body of anchor 1" : "body of anchor 0"));
        }
    adcgs_model_clear(&m, NULL);
}

/** A model decoded with fewer layers has these layers, and predicted means for the rest. */
/* REQ-LATN-005, REQ-LATN-007 */
static void test_layers(void **state)
{
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_params params;
    adcgs_stream stream;
    adcgs_buffer bytes;
    uint64_t seed = 7;
    (void)state;
    adcgs_random_params(&params, 1, &seed);
    params.chunks = 4;
    params.n_fg = 8;
    check(adcgs_random_stream(&stream, &params, 2, 200, 6, &seed, &error), &error);
    adcgs_buffer_init(&bytes);
    check(adcgs_stream_write(&stream, &bytes, &error), &error);
    for (int layers = 1; layers <= ADCGS_LAYERS; layers++) {
        adcgs_stream back;
        adcgs_read_options options = plain;
        options.layers = layers;
        check(read_stream(&back, bytes.data, bytes.size, &options, &error), &error);
        for (uint32_t s = 0; s < 2; s++) {
            const adcgs_model *a = &stream.segments[s], *b = &back.segments[s];
            size_t different = 0;
            assert_int_equal(b->layers, layers);
            assert_memory_equal(a->fv, b->fv, (size_t)a->n * params.n_fv * sizeof *a->fv);
            for (size_t i = 0; i < (size_t)a->n * params.k * params.n_fg; i++) {
                if (i % params.n_fg < 2U * ((unsigned)layers - 1))
                    assert_int_equal(a->fg[i], b->fg[i]);
                different += a->fg[i] != b->fg[i];
            }
            assert_true(layers == ADCGS_LAYERS ? different == 0 : different > 0);
        }
        adcgs_stream_clear(&back, NULL);
    }
    adcgs_buffer_clear(&bytes);
    adcgs_stream_clear(&stream, NULL);
}

/* REQ-CONF-004 */
static void test_threads_and_cpus(void **state)
{
    static const int threads[] = {1, 2, 7};
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_stream stream;
    adcgs_buffer bytes;
    (void)state;
    make_stream(&stream, 1, 2, 1000, 99);
    adcgs_buffer_init(&bytes);
    check(adcgs_stream_write(&stream, &bytes, &error), &error);
    for (size_t i = 0; i < ADCGS_COUNTOF(threads); i++)
        for (int cpu = ADCGS_CPU_SCALAR; cpu <= (int)adcgs_cpu_best(); cpu++) {
            adcgs_stream back;
            adcgs_read_options options = {.cpu = (adcgs_cpu_level)cpu};
            check(adcgs_pool_create(&options.pool, threads[i], &error), &error);
            check(read_stream(&back, bytes.data, bytes.size, &options, &error), &error);
            check_equal(&stream, &back);
            adcgs_stream_clear(&back, NULL);
            adcgs_pool_free(&options.pool);
        }
    adcgs_buffer_clear(&bytes);
    adcgs_stream_clear(&stream, NULL);
}

/* REQ-CONF-004, REQ-CONF-005 */
static void test_pieces_and_memory(void **state)
{
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_stream stream, back;
    adcgs_buffer bytes;
    (void)state;
    make_stream(&stream, 1, 2, 130, 5);
    adcgs_buffer_init(&bytes);
    check(adcgs_stream_write(&stream, &bytes, &error), &error);
    pipe p = {bytes.data, bytes.size, 0, 1};
    adcgs_memory memory = {0, 0, 0};
    adcgs_read_options options = {.cpu = ADCGS_CPU_SCALAR, .memory = &memory, .strict_end = 1};
    check(adcgs_stream_read(&back, read_pipe, &p, &options, NULL, NULL, &error), &error);
    check_equal(&stream, &back);
    adcgs_stream_clear(&back, &memory);
    assert_true(memory.used == 0 && memory.peak > 0);
    const uint64_t peak = memory.peak;
    for (uint64_t limit = 100; limit < peak; limit += peak / 50) { /* running out at any point is clean */
        memory = (adcgs_memory){.limit = limit};
        assert_int_equal(read_stream(&back, bytes.data, bytes.size, &options, &error), ADCGS_ERR_LIMIT);
        assert_true(memory.used == 0);
    }
    adcgs_buffer_clear(&bytes);
    adcgs_stream_clear(&stream, NULL);
}

/** A trace goes forward from chunk to chunk, names every one of them, and does not depend on threads. */
typedef struct trace {
    int chunks, checksums, ends, elements;
    char title[32]; /**< the first text */
    uint64_t last;
    adcgs_md5 md5;
} trace;

static void count_element(void *user, uint64_t bit, const char *element, const char *value)
{
    trace *t = user;
    t->elements++;
    assert_true(value[0] != 0);
    t->checksums += strcmp(element, "chunk.payload_crc") == 0;
    t->ends += strstr(element, ".range_end") != NULL;
    if (strcmp(element, "meta.value") == 0 && !t->title[0])
        snprintf(t->title, sizeof t->title, "%s", value);
    if (strcmp(element, "chunk.type") == 0) {
        assert_true(bit > t->last);
        t->last = bit;
        t->chunks++;
    }
    adcgs_md5_update(&t->md5, &bit, sizeof bit);
    adcgs_md5_update(&t->md5, element, strlen(element) + 1);
    adcgs_md5_update(&t->md5, value, strlen(value) + 1);
}

static void trace_stream(const adcgs_buffer *bytes, int threads, trace *t, uint8_t digest[16])
{
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_stream back;
    adcgs_read_options options = plain;
    pipe p = {bytes->data, bytes->size, 0, SIZE_MAX};
    *t = (trace){.chunks = 0};
    adcgs_md5_init(&t->md5);
    check(adcgs_pool_create(&options.pool, threads, &error), &error);
    check(adcgs_stream_read(&back, read_pipe, &p, &options, count_element, t, &error), &error);
    adcgs_pool_free(&options.pool);
    adcgs_stream_clear(&back, NULL);
    adcgs_md5_final(&t->md5, digest);
}

static void test_trace(void **state)
{
    adcgs_error error = {ADCGS_OK, ""};
    uint8_t digest[16], again[16];
    adcgs_stream stream;
    adcgs_buffer bytes;
    trace t;
    (void)state;
    make_stream(&stream, 1, 1, 300, 12);
    adcgs_random_one_tier(&stream.segments[0]);
    stream.slice_log2 = ADCGS_SLICE_LOG2_MIN;
    memcpy(stream.meta[0].value, "\"\\\177\n", 5); /* the four characters that a trace must escape */
    adcgs_buffer_init(&bytes);
    check(adcgs_stream_write(&stream, &bytes, &error), &error);
    const int layers = adcgs_params_layers(&stream.params);
    trace_stream(&bytes, 1, &t, digest);
    /* HEAD, meta, SEGM, NETW, GEOM, layers, hash, ENDC, perhaps cams */
    assert_int_equal(t.chunks, 7 + layers + (stream.n_cameras > 0));
    assert_int_equal(t.checksums, t.chunks);
    assert_int_equal(t.ends, 2 + 5 * layers);
    assert_true(t.elements > 60);
    assert_string_equal(t.title, "\"\\x22\\x5c\\x7f\\x0a\"");
    trace_stream(&bytes, 3, &t, again);
    assert_memory_equal(digest, again, sizeof digest);
    adcgs_buffer_clear(&bytes);
    adcgs_stream_clear(&stream, NULL);
}

/** The writer refuses values that the networks cannot give, times off the ticks, and models that differ in parameters. */
static void test_writer_refuses(void **state)
{
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_stream stream;
    adcgs_buffer bytes;
    (void)state;
    make_stream(&stream, 0, 1, 20, 3);
    adcgs_buffer_init(&bytes);
    adcgs_model *m = &stream.segments[0];
    m->sigma[5] = (int16_t)(m->sigma[5] > 0 ? m->sigma[5] - 1 : m->sigma[5] + 1);
    assert_int_equal(adcgs_stream_write(&stream, &bytes, &error), ADCGS_ERR_USAGE);
    assert_int_equal(bytes.size, 0);
    m->sigma[5] = INT16_MIN;
    assert_int_equal(adcgs_stream_write(&stream, &bytes, &error), ADCGS_ERR_DATA);
    adcgs_stream_clear(&stream, NULL);

    make_stream(&stream, 0, 2, 20, 3);
    stream.segments[1].time_end += 1e-5;
    assert_int_equal(adcgs_stream_write(&stream, &bytes, &error), ADCGS_ERR_USAGE);
    stream.segments[1].time_end = stream.segments[1].time_start = stream.segments[0].time_start;
    assert_int_equal(adcgs_stream_write(&stream, &bytes, &error), ADCGS_ERR_USAGE);
    adcgs_stream_clear(&stream, NULL);

    make_stream(&stream, 0, 1, 20, 3);
    stream.params.k ^= 1;
    assert_int_equal(adcgs_stream_write(&stream, &bytes, &error), ADCGS_ERR_USAGE);
    adcgs_stream_clear(&stream, NULL);
    adcgs_buffer_clear(&bytes);
}

/** Level 0 picks the lowest that fits; an explicit level that does not fit is refused by both sides. */
/* REQ-STRM-010, REQ-STRM-011, REQ-STRM-034 */
static void test_levels(void **state)
{
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_params params;
    adcgs_stream stream, back;
    adcgs_buffer bytes;
    uint64_t seed = 4;
    (void)state;
    adcgs_random_params(&params, 0, &seed);
    params.k = 1;
    params.n_fv = 2;
    params.n_fg = 0;
    check(adcgs_random_stream(&stream, &params, 1, 4097, 5, &seed, &error), &error);
    adcgs_buffer_init(&bytes);
    check(adcgs_stream_write(&stream, &bytes, &error), &error);
    assert_int_equal(stream.level, 2);
    stream.level = 1;
    adcgs_buffer none;
    adcgs_buffer_init(&none);
    assert_int_equal(adcgs_stream_write(&stream, &none, &error), ADCGS_ERR_LIMIT);
    adcgs_buffer_clear(&none);

    uint8_t *head = bytes.data + ADCGS_SIGNATURE_BYTES, *payload = head + ADCGS_CHUNK_HEADER_BYTES;
    const uint32_t length = adcgs_load_le32(head + 4);
    assert_int_equal(payload[5], 2); /* after version and profile */
    payload[5] = 1;
    adcgs_store_le32(payload + length, adcgs_crc32c(0, payload, length));
    assert_int_equal(read_stream(&back, bytes.data, bytes.size, &plain, &error), ADCGS_ERR_LIMIT);
    assert_non_null(strstr(error.text, "max_anchors"));
    payload[5] = 9;
    adcgs_store_le32(payload + length, adcgs_crc32c(0, payload, length));
    assert_int_equal(read_stream(&back, bytes.data, bytes.size, &plain, &error), ADCGS_ERR_UNSUPPORTED);
    adcgs_buffer_clear(&bytes);
    adcgs_stream_clear(&stream, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_round_trip),
        cmocka_unit_test(test_layers),
        cmocka_unit_test(test_threads_and_cpus),
        cmocka_unit_test(test_pieces_and_memory),
        cmocka_unit_test(test_trace),
        cmocka_unit_test(test_writer_refuses),
        cmocka_unit_test(test_levels),
        cmocka_unit_test(test_bodies),
        cmocka_unit_test(test_bodies_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

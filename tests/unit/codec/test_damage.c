/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Damaged, cut and foreign streams: each gives a clean error or a usable result, never anything else. */
#include "random_model.h"
#include "stream_edit.h"

#include "base/digest.h"
#include "model/model_priv.h"
#include "stream/chunk.h"
#include "stream/input.h"

#include <adcgs/version.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

static adcgs_status read_stream(adcgs_stream *stream, const uint8_t *data, size_t bytes, int strict_end, adcgs_error *error)
{
    const adcgs_read_options options = {.cpu = ADCGS_CPU_SCALAR, .strict_end = strict_end};
    adcgs_span s = {.next = data, .left = bytes};
    return adcgs_stream_read(stream, adcgs_span_read, &s, &options, NULL, NULL, error);
}

static void make_bytes(adcgs_stream *stream, adcgs_buffer *bytes, uint32_t segments, uint32_t n, int n_fg, uint64_t seed)
{
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_params params;
    adcgs_random_small_params(&params, n_fg, &seed);
    params.octaves = 1;
    adcgs_buffer_init(bytes);
    if (adcgs_random_stream(stream, &params, segments, n, 4, &seed, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    stream->slice_log2 = ADCGS_SLICE_LOG2_MIN;
    for (uint32_t i = 0; i < segments; i++)
        adcgs_random_one_tier(&stream->segments[i]);
    if (adcgs_stream_write(stream, bytes, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
}

/** Every decoded part of a model must be valid and equal the original. */
static void check_usable(const adcgs_stream *whole, const adcgs_stream *part)
{
    adcgs_error error = {ADCGS_OK, ""};
    assert_true(part->n_segments >= 1 && part->n_segments <= whole->n_segments);
    for (uint32_t i = 0; i < part->n_segments; i++) {
        const adcgs_model *a = &whole->segments[i], *b = &part->segments[i];
        if (adcgs_model_validate(b, &error) != ADCGS_OK)
            fail_msg("segment %u: %s", i, error.text);
        assert_int_equal(a->n, b->n);
        assert_true(b->layers >= 1 && b->layers <= adcgs_params_layers(&b->params));
        assert_memory_equal(a->pos, b->pos, 3 * (size_t)a->n * sizeof *a->pos);
        assert_memory_equal(a->mask, b->mask, a->n * sizeof *a->mask);
        assert_memory_equal(a->fv, b->fv, (size_t)a->n * a->params.n_fv * sizeof *a->fv);
        if (b->layers == adcgs_params_layers(&b->params))
            assert_true(adcgs_model_equal(a, b, NULL));
        else
            assert_true(i == part->n_segments - 1);
    }
}

/* REQ-STRM-031, REQ-STRM-032 */
static void test_cut_anywhere(void **state)
{
    adcgs_stream stream, part;
    adcgs_buffer bytes;
    adcgs_error error;
    uint32_t most = 0;
    int layers_seen = 0;
    (void)state;
    make_bytes(&stream, &bytes, 2, 70, 4, 1);
    for (size_t n = 0; n < bytes.size; n++) {
        uint8_t *copy = malloc(n + (n == 0)); /* exactly n bytes: a sanitizer detects a read beyond */
        assert_non_null(copy);
        memcpy(copy, bytes.data, n);
        const adcgs_status status = read_stream(&part, copy, n, 0, &error);
        if (status == ADCGS_OK) {
            assert_true(part.truncated);
            check_usable(&stream, &part);
            assert_true(part.n_segments >= most); /* more bytes never give less */
            most = part.n_segments;
            layers_seen |= 1 << part.segments[part.n_segments - 1].layers;
        } else {
            assert_int_equal(status, ADCGS_ERR_TRUNCATED);
            assert_int_equal(most, 0);
        }
        adcgs_stream_clear(&part, NULL);
        if (n % 7 == 0)
            assert_int_equal(read_stream(&part, copy, n, 1, &error), ADCGS_ERR_TRUNCATED);
        free(copy);
    }
    assert_int_equal(most, 2);
    assert_int_equal(layers_seen, 14); /* 1, 2 and 3 layers */
    adcgs_buffer_clear(&bytes);
    adcgs_stream_clear(&stream, NULL);
}

/** A cut inside a layer keeps the slices in front of it. */
/* REQ-STRM-031, REQ-STRM-038 */
static void test_slices_before_cut(void **state)
{
    adcgs_stream stream, part;
    adcgs_buffer bytes;
    adcgs_error error;
    size_t pos = ADCGS_SIGNATURE_BYTES, cut = 0;
    (void)state;
    make_bytes(&stream, &bytes, 1, 192, 4, 2);
    while (!cut) { /* in the last slice of FEA1 */
        const uint32_t type = adcgs_load_le32(bytes.data + pos);
        pos += ADCGS_CHUNK_BYTES + adcgs_load_le32(bytes.data + pos + 4);
        if (type == ADCGS_TYPE_FEA(1))
            cut = pos - 5;
    }
    assert_int_equal(read_stream(&part, bytes.data, cut, 0, &error), ADCGS_OK);
    const adcgs_model *a = &stream.segments[0], *b = &part.segments[0];
    assert_int_equal(b->layers, 1);
    for (uint32_t i = 0; i < 128; i++)
        for (int k = 0; k < 2; k++)
            assert_memory_equal(a->fg + (i * 2U + (unsigned)k) * 4U, b->fg + (i * 2U + (unsigned)k) * 4U, 2 * sizeof *a->fg);
    adcgs_stream_clear(&part, NULL);
    adcgs_buffer_clear(&bytes);
    adcgs_stream_clear(&stream, NULL);
}

/* REQ-STRM-004, REQ-STRM-033 */
static void test_flip_every_byte(void **state)
{
    adcgs_stream stream, part;
    adcgs_buffer bytes;
    adcgs_error error;
    (void)state;
    make_bytes(&stream, &bytes, 2, 40, 4, 3);
    for (size_t i = 0; i < bytes.size; i++)
        for (int bit = 0; bit < 8; bit += 7) {
            bytes.data[i] ^= (uint8_t)(1 << bit);
            const adcgs_status status = read_stream(&part, bytes.data, bytes.size, 0, &error);
            if (status == ADCGS_OK)
                fail_msg("flipped bit %d of byte %zu was not detected", bit, i);
            assert_true(error.text[0] != 0 && !strchr(error.text, '\n'));
            bytes.data[i] ^= (uint8_t)(1 << bit);
        }
    adcgs_buffer_clear(&bytes);
    adcgs_stream_clear(&stream, NULL);
}

/** Damage under valid checksums. Every second stream has no digest that would detect it. */
/* REQ-CONF-005 */
static void test_malice(void **state)
{
    adcgs_stream stream, part;
    adcgs_buffer bytes, bad;
    adcgs_error error;
    uint64_t seed = 4;
    int usable = 0, refused = 0;
    (void)state;
    make_bytes(&stream, &bytes, 2, 70, 4, 5);
    adcgs_buffer_init(&bad);
    for (int round = 0; round < 3000; round++) {
        bad.size = 0;
        adcgs_write_bytes(&bad, bytes.data, bytes.size);
        for (size_t i = 0; round & 1 && i + 4 < bad.size; i++)
            if (memcmp(bad.data + i, "hash", 4) == 0)
                bad.data[i] = 'n';
        for (int n = (int)adcgs_random_range(&seed, 1, 3); n > 0; n--) {
            const size_t at = (size_t)adcgs_random_range(&seed, ADCGS_SIGNATURE_BYTES, (int64_t)bad.size - 1);
            bad.data[at] = (uint8_t)(n & 1 ? bad.data[at] ^ 1 << (round & 7) : adcgs_random_range(&seed, 0, 255));
        }
        adcgs_repair_stream(bad.data, bad.size, 0);
        if (read_stream(&part, bad.data, bad.size, 0, &error) != ADCGS_OK) {
            refused++;
            continue;
        }
        for (uint32_t i = 0; i < part.n_segments; i++)
            if (adcgs_model_validate(&part.segments[i], &error) != ADCGS_OK)
                fail_msg("round %d, segment %u: %s", round, i, error.text);
        usable++;
        adcgs_stream_clear(&part, NULL);
    }
    assert_true(usable > 20 && refused > 500);
    adcgs_buffer_clear(&bad);
    adcgs_buffer_clear(&bytes);
    adcgs_stream_clear(&stream, NULL);
}

/** Copies a stream with one more chunk in front of ENDC, and makes everything else consistent. */
static void insert_chunk(adcgs_buffer *out, const adcgs_buffer *in, uint32_t type)
{
    const size_t tail = ADCGS_CHUNK_BYTES + 12;
    out->size = 0;
    adcgs_write_bytes(out, in->data, in->size - tail);
    const size_t begin = adcgs_chunk_begin(out, type, 0, 0);
    adcgs_write_bytes(out, "anything", 8);
    adcgs_chunk_end(out, begin);
    adcgs_write_bytes(out, in->data + in->size - tail, tail);
    adcgs_store_le64(out->data + out->size - 16, out->size);
    adcgs_repair_stream(out->data, out->size, 0);
}

/* REQ-STRM-003, REQ-STRM-004, REQ-STRM-005 */
static void test_unknown_chunks(void **state)
{
    adcgs_stream stream, part;
    adcgs_buffer bytes, more;
    adcgs_error error;
    (void)state;
    make_bytes(&stream, &bytes, 1, 20, 0, 6);
    adcgs_buffer_init(&more);
    insert_chunk(&more, &bytes, ADCGS_TYPE('t', 'h', 'm', 'b'));
    assert_int_equal(read_stream(&part, more.data, more.size, 1, &error), ADCGS_OK);
    assert_true(part.bytes.metadata == stream.bytes.metadata + 8 && part.bytes.total == more.size);
    assert_true(adcgs_model_equal(&stream.segments[0], &part.segments[0], NULL));
    adcgs_stream_clear(&part, NULL);
    insert_chunk(&more, &bytes, ADCGS_TYPE('L', 'O', 'D', '1'));
    assert_int_equal(read_stream(&part, more.data, more.size, 1, &error), ADCGS_ERR_UNSUPPORTED);
    assert_non_null(strstr(error.text, "LOD1"));
    insert_chunk(&more, &bytes, ADCGS_TYPE('\n', 'O', 'D', '1'));
    assert_int_equal(read_stream(&part, more.data, more.size, 1, &error), ADCGS_ERR_DATA);
    adcgs_buffer_clear(&more);
    adcgs_buffer_clear(&bytes);
    adcgs_stream_clear(&stream, NULL);
}

/** Other versions may change everything after the elements for version and tools: it is not read. */
/* REQ-STRM-010 */
static void test_future_head(void **state)
{
    static const uint8_t elements[] =
        {ADCGS_BITSTREAM_MAJOR, 0, ADCGS_BITSTREAM_MINOR, 0, 0, 1, 0, 0, 0, 0, 0, 0xff, 0xff, 0xff, 0xff};
    adcgs_stream stream;
    adcgs_buffer bytes;
    adcgs_error error;
    (void)state;
    adcgs_buffer_init(&bytes);
    adcgs_write_bytes(&bytes, ADCGS_SIGNATURE, ADCGS_SIGNATURE_BYTES);
    const size_t begin = adcgs_chunk_begin(&bytes, ADCGS_TYPE_HEAD, 0, 0);
    adcgs_write_bytes(&bytes, elements, sizeof elements);
    adcgs_chunk_end(&bytes, begin);
    assert_int_equal(read_stream(&stream, bytes.data, bytes.size, 0, &error), ADCGS_ERR_DATA);
    bytes.data[begin + ADCGS_CHUNK_HEADER_BYTES + 2]++;
    adcgs_repair_stream(bytes.data, bytes.size, 0);
    assert_int_equal(read_stream(&stream, bytes.data, bytes.size, 0, &error), ADCGS_ERR_UNSUPPORTED);
    adcgs_buffer_clear(&bytes);
}

/** A stream without its last layers plays with the rest. */
/* REQ-STRM-009, REQ-LATN-007, REQ-STRM-038 */
static void test_layers_taken_out(void **state)
{
    adcgs_stream stream, part;
    adcgs_buffer bytes, less;
    adcgs_error error;
    (void)state;
    make_bytes(&stream, &bytes, 1, 100, 4, 7);
    adcgs_buffer_init(&less);
    adcgs_write_bytes(&less, bytes.data, ADCGS_SIGNATURE_BYTES);
    for (size_t pos = ADCGS_SIGNATURE_BYTES; pos < bytes.size;) {
        const size_t length = ADCGS_CHUNK_BYTES + adcgs_load_le32(bytes.data + pos + 4);
        if (adcgs_load_le32(bytes.data + pos) != ADCGS_TYPE_FEA(2))
            adcgs_write_bytes(&less, bytes.data + pos, length);
        pos += length;
    }
    adcgs_store_le64(less.data + less.size - 16, less.size);
    adcgs_repair_stream(less.data, less.size, 0);
    assert_int_equal(read_stream(&part, less.data, less.size, 1, &error), ADCGS_OK);
    assert_int_equal(part.segments[0].layers, 2);
    assert_false(part.truncated);
    check_usable(&stream, &part);
    adcgs_stream_clear(&part, NULL);
    adcgs_buffer_clear(&less);
    adcgs_buffer_clear(&bytes);
    adcgs_stream_clear(&stream, NULL);
}

static adcgs_status read_layers(adcgs_stream *stream, const adcgs_buffer *bytes, int layers, adcgs_error *error)
{
    const adcgs_read_options options = {.cpu = ADCGS_CPU_SCALAR, .layers = layers};
    adcgs_span s = {.next = bytes->data, .left = bytes->size};
    return adcgs_stream_read(stream, adcgs_span_read, &s, &options, NULL, NULL, error);
}

/** Data in layers that are left out is not read, except for the checksums of chunks and the existence of the layer. */
/* REQ-STRM-042 */
static void test_layers_left_out(void **state)
{
    adcgs_stream stream, part;
    adcgs_buffer bytes;
    adcgs_error error;
    (void)state;
    make_bytes(&stream, &bytes, 1, 100, 4, 7);
    size_t pos = ADCGS_SIGNATURE_BYTES;
    while (adcgs_load_le32(bytes.data + pos) != ADCGS_TYPE_FEA(2))
        pos += ADCGS_CHUNK_BYTES + adcgs_load_le32(bytes.data + pos + 4);
    uint8_t *const payload = bytes.data + pos + ADCGS_CHUNK_HEADER_BYTES;
    memset(payload, 0xff, adcgs_load_le32(bytes.data + pos + 4));
    assert_int_equal(read_layers(&part, &bytes, 2, &error), ADCGS_ERR_DATA); /* payload_crc */
    adcgs_repair_stream(bytes.data, bytes.size, 0);
    assert_int_equal(read_layers(&part, &bytes, 3, &error), ADCGS_ERR_DATA);
    assert_int_equal(read_layers(&part, &bytes, 0, &error), ADCGS_ERR_DATA);
    assert_int_equal(read_layers(&part, &bytes, 2, &error), ADCGS_OK);
    assert_int_equal(part.segments[0].layers, 2);
    check_usable(&stream, &part);
    adcgs_stream_clear(&part, NULL);
    bytes.data[pos + 3] = '4'; /* FEA4, which a stream of three layers does not have */
    adcgs_repair_stream(bytes.data, bytes.size, 0);
    assert_int_equal(read_layers(&part, &bytes, 1, &error), ADCGS_ERR_DATA);
    adcgs_buffer_clear(&bytes);
    adcgs_stream_clear(&stream, NULL);
}

/** A length field of a gigabyte allocates no gigabyte. */
/* REQ-STRM-004, REQ-STRM-034, REQ-CONF-005 */
static void test_false_length(void **state)
{
    adcgs_buffer bytes;
    adcgs_stream stream, part;
    adcgs_error error;
    (void)state;
    make_bytes(&stream, &bytes, 1, 10, 0, 8);
    const size_t second = ADCGS_SIGNATURE_BYTES + ADCGS_CHUNK_BYTES + adcgs_load_le32(bytes.data + ADCGS_SIGNATURE_BYTES + 4);
    uint8_t *header = bytes.data + second;
    bytes.data[ADCGS_SIGNATURE_BYTES + ADCGS_CHUNK_HEADER_BYTES + 5] = 3; /* level, for its limit of 2^30 */
    adcgs_store_le32(bytes.data + second - 4, adcgs_crc32c(0, bytes.data + ADCGS_SIGNATURE_BYTES + ADCGS_CHUNK_HEADER_BYTES,
                                                           second - 4 - ADCGS_SIGNATURE_BYTES - ADCGS_CHUNK_HEADER_BYTES));
    adcgs_store_le32(header + 4, 1U << 30);
    adcgs_store_le32(header + 12, adcgs_crc32c(0, header, 12));
    adcgs_memory memory = {.limit = 1 << 20};
    const adcgs_read_options options = {.cpu = ADCGS_CPU_SCALAR, .memory = &memory};
    adcgs_span s = {.next = bytes.data, .left = bytes.size};
    assert_int_equal(adcgs_stream_read(&part, adcgs_span_read, &s, &options, NULL, NULL, &error), ADCGS_ERR_TRUNCATED);
    assert_true(memory.peak < 1 << 19 && memory.used == 0);
    adcgs_store_le32(header + 4, (1U << 30) + 1);
    adcgs_store_le32(header + 12, adcgs_crc32c(0, header, 12));
    assert_int_equal(read_stream(&part, bytes.data, bytes.size, 0, &error), ADCGS_ERR_DATA);
    adcgs_buffer_clear(&bytes);
    adcgs_stream_clear(&stream, NULL);
}

static void put_zeros(adcgs_buffer *out, size_t length)
{
    static const uint8_t zeros[4096];
    const size_t begin = adcgs_chunk_begin(out, UINT32_C(0x6f72657a), 0, 0); /* zero */
    for (size_t left = length, n; left > 0; left -= n) {
        n = ADCGS_MIN(left, sizeof zeros);
        adcgs_write_bytes(out, zeros, n);
    }
    adcgs_chunk_end(out, begin);
}

/** The stream, extended to this size by two chunks of zeros before its end. */
static void make_long(adcgs_buffer *out, const adcgs_buffer *bytes, size_t size)
{
    const size_t end = bytes->size - ADCGS_CHUNK_BYTES - 12; /* end of the data before ENDC */
    adcgs_buffer_init(out);
    adcgs_write_bytes(out, bytes->data, end);
    put_zeros(out, 1U << 21);
    put_zeros(out, size - bytes->size - (1U << 21) - 2 * ADCGS_CHUNK_BYTES);
    adcgs_write_bytes(out, bytes->data + end, bytes->size - end);
    assert_int_equal(out->size, size);
    adcgs_repair_stream(out->data, out->size, 0);
}

/** Level 1's bound on the bytes of a stream, for which any vector would be too large. */
/* REQ-STRM-004, REQ-STRM-034 */
static void test_stream_bytes(void **state)
{
    adcgs_buffer bytes, longer;
    adcgs_stream stream, part;
    adcgs_error error;
    (void)state;
    make_bytes(&stream, &bytes, 1, 10, 0, 8);
    make_long(&longer, &bytes, 1U << 22);
    assert_int_equal(read_stream(&part, longer.data, longer.size, 0, &error), ADCGS_OK);
    adcgs_stream_clear(&part, NULL);
    adcgs_buffer_clear(&longer);
    make_long(&longer, &bytes, (1U << 22) + 1);
    assert_int_equal(read_stream(&part, longer.data, longer.size, 0, &error), ADCGS_ERR_LIMIT);
    assert_non_null(strstr(error.text, "ENDC: the stream exceeds"));
    adcgs_buffer_clear(&longer);
    adcgs_buffer_clear(&bytes);
    adcgs_stream_clear(&stream, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cut_anywhere),     cmocka_unit_test(test_slices_before_cut), cmocka_unit_test(test_flip_every_byte),
        cmocka_unit_test(test_malice),           cmocka_unit_test(test_unknown_chunks),    cmocka_unit_test(test_future_head),
        cmocka_unit_test(test_layers_taken_out), cmocka_unit_test(test_layers_left_out),   cmocka_unit_test(test_false_length),
        cmocka_unit_test(test_stream_bytes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

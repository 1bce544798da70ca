/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Damaged streams. Intact streams are read as usual. Wrong, missing or doubled bits, bytes and pieces are reported, and the used
 * rest equals the original.
 */
#include "stream_fixture.h"

#include "base/cpu_detect.h"
#include "base/digest.h"
#include "model/model_priv.h"
#include "stream/chunk.h"
#include "stream/input.h"
#include "stream/salvage.h"

#include <adcgs/adcgs.h>

#include <stdio.h>

enum { SEGMENTS = 8 };

/** Keys and predicted segments in turns of three; several slices and layers. */
static int setup(void **state)
{
    fixture *f = fixture_new(state);
    adcgs_params params;
    uint64_t seed = 31;
    adcgs_random_params(&params, 1, &seed);
    params.n_fg = 4;
    params.chunks = 2;
    return fixture_turns(f, &params, SEGMENTS, 200, 5, 100, &seed);
}

static int64_t read_at(void *user, uint64_t offset, void *buffer, size_t bytes)
{
    const adcgs_buffer *b = user;
    assert_true(offset < b->size && bytes <= b->size - offset);
    memcpy(buffer, b->data + offset, bytes);
    return (int64_t)bytes;
}

static uint32_t told;

static void count(void *user, adcgs_log_level level, const char *text)
{
    (void)user;
    assert_true(text[0] && !strchr(text, '\n'));
    told += level == ADCGS_LOG_WARNING;
}

static adcgs_status salvage(adcgs_stream *out, adcgs_buffer *bytes, uint32_t *faults)
{
    const adcgs_read_options options = {.cpu = ADCGS_CPU_SCALAR, .log = {count, NULL}};
    adcgs_error error = {ADCGS_OK, ""};
    told = 0;
    const adcgs_status status = adcgs_stream_salvage(out, read_at, bytes, bytes->size, &options, faults, &error);
    assert_int_equal(told, *faults);
    assert_true(status == ADCGS_OK || (error.text[0] && !strchr(error.text, '\n')));
    return status;
}

/** The segment that was written with these times; -1 if none. */
static int number_of(const fixture *f, const adcgs_model *m)
{
    for (int i = 0; i < SEGMENTS; i++)
        if (f->stream.segments[i].time_start == m->time_start && f->stream.segments[i].time_end == m->time_end)
            return i;
    return -1;
}

/**
 * Expects every model with all layers and tiers to equal the written one. Returns the number of models; *whole: of complete ones.
 */
static uint32_t check_models(const fixture *f, const adcgs_stream *s, uint32_t *whole)
{
    *whole = 0;
    for (uint32_t i = 0; i < s->n_segments; i++) {
        adcgs_error difference = {ADCGS_OK, ""};
        const int number = number_of(f, &s->segments[i]);
        assert_true(number >= 0);
        if (s->segments[i].layers < adcgs_params_layers(&s->params) || s->segments[i].absent)
            continue;
        if (!adcgs_model_equal(&s->segments[i], &f->stream.segments[number], &difference))
            fail_msg("segment %d: %s", number, difference.text);
        ++*whole;
    }
    return s->n_segments;
}

static void copy(adcgs_buffer *to, const adcgs_buffer *from)
{
    adcgs_buffer_init(to);
    adcgs_write_bytes(to, from->data, from->size);
}

static void test_whole(void **state)
{
    fixture *f = *state;
    adcgs_stream s;
    adcgs_buffer again;
    uint32_t faults, whole;
    assert_int_equal(salvage(&s, &f->bytes, &faults), ADCGS_OK);
    assert_int_equal(faults, 0);
    assert_int_equal(check_models(f, &s, &whole), SEGMENTS);
    assert_int_equal(whole, SEGMENTS);
    assert_false(s.truncated);
    adcgs_buffer_init(&again); /* the repaired stream equals the original */
    assert_int_equal(adcgs_stream_write(&s, &again, NULL), ADCGS_OK);
    assert_int_equal(again.size, f->bytes.size);
    assert_memory_equal(again.data, f->bytes.data, again.size);
    adcgs_buffer_clear(&again);
    adcgs_stream_clear(&s, NULL);
}

/** Offset of the chunk of a type and a segment; its length with header and checksum. */
static size_t chunk_at(const adcgs_buffer *b, uint32_t type, int segment, size_t *length)
{
    for (size_t at = ADCGS_SIGNATURE_BYTES; at < b->size; at += *length) {
        *length = ADCGS_CHUNK_BYTES + adcgs_load_le32(b->data + at + 4);
        if (adcgs_load_le32(b->data + at) == type && adcgs_load_le16(b->data + at + 8) == segment)
            return at;
    }
    fail_msg("no such chunk");
    return 0;
}

/** Flips one bit of a chunk's payload and expects this many segments, and this many complete ones. */
static void check_bit(const fixture *f, uint32_t type, int segment, uint32_t left, uint32_t whole_left)
{
    adcgs_buffer b;
    adcgs_stream s;
    size_t length;
    uint32_t faults, whole;
    copy(&b, &f->bytes);
    const size_t at = chunk_at(&b, type, segment, &length);
    b.data[at + length - 5] ^= 2;
    assert_int_equal(salvage(&s, &b, &faults), ADCGS_OK);
    assert_true(faults > 0);
    assert_int_equal(check_models(f, &s, &whole), left);
    assert_int_equal(whole, whole_left);
    /* The repaired stream has no faults, and the same models. */
    adcgs_buffer repaired;
    adcgs_stream again;
    adcgs_buffer_init(&repaired);
    assert_int_equal(adcgs_stream_write(&s, &repaired, NULL), ADCGS_OK);
    assert_int_equal(salvage(&again, &repaired, &faults), ADCGS_OK);
    assert_int_equal(faults, 0);
    assert_int_equal(again.n_segments, s.n_segments);
    for (uint32_t i = 0; i < s.n_segments; i++) {
        adcgs_error difference;
        assert_true(adcgs_model_equal(&s.segments[i], &again.segments[i], &difference));
    }
    adcgs_buffer_clear(&repaired);
    adcgs_stream_clear(&again, NULL);
    adcgs_stream_clear(&s, NULL);
    adcgs_buffer_clear(&b);
}

/** Segments 0, 3 and 6 are keys; 8 in all. */
static void test_lost_segments(void **state)
{
    const fixture *f = *state;
    check_bit(f, ADCGS_TYPE_INDX, 0, 8, 8);
    check_bit(f, ADCGS_TYPE_ENDC, 0, 8, 8);
    check_bit(f, ADCGS_TYPE_hash, 4, 8, 8);
    check_bit(f, ADCGS_TYPE_FEA(2), 0, 8, 5); /* the segments predicted from it have a concealed part as well */
    check_bit(f, ADCGS_TYPE_FEA(1), 5, 8, 7);
    check_bit(f, ADCGS_TYPE_FEA(0), 0, 5, 5);
    check_bit(f, ADCGS_TYPE_FEA(0), 1, 6, 6);
    check_bit(f, ADCGS_TYPE_GEOM, 4, 6, 6);
    check_bit(f, ADCGS_TYPE_KEEP, 1, 6, 6);
    check_bit(f, ADCGS_TYPE_SEGM, 3, 5, 5);
    check_bit(f, ADCGS_TYPE_SEGM, 7, 7, 7);
}

/** A piece in the middle is missing, doubled or foreign: only the data that it touches is lost. */
static void test_pieces(void **state)
{
    const fixture *f = *state;
    uint64_t seed = 9;
    for (int i = 0; i < 200; i++) {
        adcgs_buffer b;
        adcgs_stream s;
        uint32_t faults, whole;
        const size_t first = (size_t)adcgs_random_range(&seed, 400, (int64_t)f->bytes.size - 2);
        const size_t n = (size_t)adcgs_random_range(&seed, 1, ADCGS_MIN(3000, (int64_t)(f->bytes.size - first)));
        adcgs_buffer_init(&b);
        adcgs_write_bytes(&b, f->bytes.data, first);
        if (i % 3 == 0) {
            adcgs_write_bytes(&b, f->bytes.data + first + n, f->bytes.size - first - n);
        } else {
            adcgs_write_bytes(&b, f->bytes.data + (i % 3 == 1 ? first : 1), n);
            adcgs_write_bytes(&b, f->bytes.data + first, f->bytes.size - first);
        }
        if (salvage(&s, &b, &faults) == ADCGS_OK) {
            check_models(f, &s, &whole);
            adcgs_stream_clear(&s, NULL);
        }
        adcgs_buffer_clear(&b);
    }
}

/** A few or many wrong bytes anywhere: no model that differs from the written one passes as complete. */
static void test_bytes(void **state)
{
    const fixture *f = *state;
    uint64_t seed = 10;
    uint32_t saved = 0;
    for (int i = 0; i < 300; i++) {
        adcgs_buffer b;
        adcgs_stream s;
        uint32_t faults, whole;
        copy(&b, &f->bytes);
        for (int k = 0; k <= i % 20; k++)
            b.data[adcgs_random_range(&seed, 0, (int64_t)b.size - 1)] ^= (uint8_t)adcgs_random_range(&seed, 1, 255);
        if (salvage(&s, &b, &faults) == ADCGS_OK) {
            saved += check_models(f, &s, &whole);
            assert_true(faults > 0);
            adcgs_stream_clear(&s, NULL);
        }
        adcgs_buffer_clear(&b);
    }
    assert_true(saved > 300); /* of 2,400 */
}

/** Nested headers, each of a chunk that claims all following bytes, need bounded time. */
static void test_nested(void **state)
{
    const fixture *f = *state;
    adcgs_buffer b;
    adcgs_stream s;
    uint32_t faults;
    size_t length;
    adcgs_buffer_init(&b);
    adcgs_write_bytes(&b, f->bytes.data, chunk_at(&f->bytes, ADCGS_TYPE_SEGM, 0, &length));
    const size_t total = 1 << 20;
    while (b.size + 16 < total) {
        uint8_t header[16] = {'N', 'E', 'T', 'W'};
        adcgs_store_le32(header + 4, (uint32_t)(total - b.size - 16));
        adcgs_store_le32(header + 12, adcgs_crc32c(0, header, 12));
        adcgs_write_bytes(&b, header, sizeof header);
    }
    assert_int_equal(salvage(&s, &b, &faults), ADCGS_ERR_DATA);
    adcgs_buffer_clear(&b);
}

/** The same through the decoder's option. */
static void test_decoder(void **state)
{
    const fixture *f = *state;
    adcgs_config config;
    adcgs_decoder *d = NULL;
    adcgs_buffer b;
    adcgs_info info;
    size_t length;
    copy(&b, &f->bytes);
    b.data[chunk_at(&b, ADCGS_TYPE_KEEP, 4, &length) + 17] ^= 1;
    adcgs_config_init(&config, sizeof config);
    assert_int_equal(adcgs_open_memory(&d, b.data, b.size, &config, NULL), ADCGS_ERR_DATA);
    config.conceal = 1;
    assert_int_equal(adcgs_open_memory(&d, b.data, b.size, &config, NULL), ADCGS_OK);
    adcgs_get_info(d, &info, sizeof info, NULL);
    assert_int_equal(info.segments, 6);
    assert_true(info.faults > 0);
    adcgs_close(&d);
    adcgs_buffer_clear(&b);
}

/** The number of useful bytes follows from the level, as soon as a valid header is present. */
static void test_useful_bytes(void **state)
{
    const fixture *f = *state;
    const size_t head = ADCGS_SIGNATURE_BYTES + ADCGS_CHUNK_BYTES + adcgs_load_le32(f->bytes.data + ADCGS_SIGNATURE_BYTES + 4);
    adcgs_buffer b;
    for (size_t bytes = 0; bytes < head; bytes++)
        assert_int_equal(adcgs_salvage_bytes(f->bytes.data, bytes), ADCGS_SALVAGE_BYTES);
    assert_int_equal(adcgs_salvage_bytes(f->bytes.data, head), adcgs_level_get(1)->file_bytes);
    copy(&b, &f->bytes);
    for (size_t i = ADCGS_SIGNATURE_BYTES; i < head; i++) {
        b.data[i] ^= 3;
        assert_int_equal(adcgs_salvage_bytes(b.data, b.size), ADCGS_SALVAGE_BYTES);
        b.data[i] ^= 3;
    }
    adcgs_buffer_clear(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_whole),        cmocka_unit_test(test_lost_segments), cmocka_unit_test(test_pieces),
        cmocka_unit_test(test_bytes),        cmocka_unit_test(test_nested),        cmocka_unit_test(test_decoder),
        cmocka_unit_test(test_useful_bytes),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}

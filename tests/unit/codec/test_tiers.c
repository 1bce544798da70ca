/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Tiers. A decoder that renders the first tiers shows the same as a stream that ends behind them. Every prefix of a stream is the
 * model without the missing anchors, read in order or pushed. So is a stream that lost a chunk.
 */
#include "random_model.h"

#include "model/model_priv.h"
#include "stream/chunk.h"
#include "stream/input.h"
#include "stream/salvage.h"

#include <adcgs/adcgs.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

enum { SEEDS = 12 };

/** A stream of one segment with two or three tiers. */
static void make(adcgs_stream *stream, adcgs_buffer *bytes, uint64_t seed)
{
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_params params;
    adcgs_random_small_params(&params, 2, &seed);
    adcgs_buffer_init(bytes);
    do {
        adcgs_status status = adcgs_random_stream(stream, &params, 1, 150, 4, &seed, &error);
        stream->slice_log2 = ADCGS_SLICE_LOG2_MIN;
        bytes->size = 0;
        if (status == ADCGS_OK)
            status = adcgs_stream_write(stream, bytes, &error);
        if (status != ADCGS_OK)
            fail_msg("%s", error.text);
    } while (!stream->segments[0].finest && (adcgs_stream_clear(stream, NULL), 1));
}

static void clear(adcgs_stream *stream, adcgs_buffer *bytes)
{
    adcgs_stream_clear(stream, NULL);
    adcgs_buffer_clear(bytes);
}

/** Position of the GEOM of a tier, or of ENDC if there is none. */
static size_t place_of(const adcgs_buffer *bytes, int tier)
{
    size_t at = ADCGS_SIGNATURE_BYTES;
    for (;; at += ADCGS_CHUNK_BYTES + adcgs_load_le32(bytes->data + at + 4)) {
        const uint32_t type = adcgs_load_le32(bytes->data + at);
        if (type == ADCGS_TYPE_ENDC || (type == ADCGS_TYPE_GEOM && ADCGS_CHUNK_TIER(bytes->data[at + 10]) == tier))
            return at;
    }
}

static adcgs_decoder *open_bytes(const void *data, size_t size)
{
    adcgs_decoder *d = NULL;
    adcgs_config config;
    adcgs_config_init(&config, sizeof config);
    config.threads = 1;
    assert_int_equal(adcgs_open_memory(&d, data, size, &config, NULL), ADCGS_OK);
    return d;
}

static void compare_splats(adcgs_decoder *a, adcgs_decoder *b)
{
    for (int i = 0; i < 3; i++) {
        uint8_t digests[2][16];
        adcgs_info info;
        assert_int_equal(adcgs_get_info(a, &info, sizeof info, NULL), ADCGS_OK);
        const double time = info.time_start + 0.5 * i * (info.time_end - info.time_start);
        assert_int_equal(adcgs_get_splat_digest(a, time, digests[0], NULL), ADCGS_OK);
        assert_int_equal(adcgs_get_splat_digest(b, time, digests[1], NULL), ADCGS_OK);
        assert_memory_equal(digests[0], digests[1], 16);
    }
}

/* REQ-STRM-051, REQ-STRM-050, REQ-PRIM-027 */
static void test_wanted(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= SEEDS; seed++) {
        adcgs_stream stream;
        adcgs_buffer bytes;
        adcgs_info info;
        uint8_t before[16], behind[16];
        make(&stream, &bytes, seed);
        adcgs_decoder *all = open_bytes(bytes.data, bytes.size), *whole = open_bytes(bytes.data, bytes.size);
        assert_int_equal(adcgs_get_info(all, &info, sizeof info, NULL), ADCGS_OK);
        assert_int_equal(info.tiers, stream.segments[0].finest + 1);
        assert_int_equal(info.tiers_present, info.tiers);
        assert_int_equal(adcgs_get_model_digest(all, 0, before, NULL), ADCGS_OK);
        for (int tiers = info.tiers; tiers > 0; tiers--) {
            adcgs_decoder *some = open_bytes(bytes.data, place_of(&bytes, tiers));
            adcgs_info of_some;
            assert_int_equal(adcgs_get_info(some, &of_some, sizeof of_some, NULL), ADCGS_OK);
            assert_int_equal(of_some.tiers_present, tiers);
            assert_int_equal(adcgs_set_tiers(all, tiers, NULL), ADCGS_OK);
            compare_splats(some, all);
            adcgs_close(&some);
        }
        assert_int_equal(adcgs_set_tiers(all, 0, NULL), ADCGS_OK);
        compare_splats(all, whole);
        assert_int_equal(adcgs_set_tiers(all, -1, NULL), ADCGS_ERR_USAGE);
        assert_int_equal(adcgs_get_model_digest(all, 0, behind, NULL), ADCGS_OK);
        assert_memory_equal(before, behind, 16);
        adcgs_close(&all);
        adcgs_close(&whole);
        clear(&stream, &bytes);
    }
}

/** Expects a partial model to equal the written one without the absent tiers; layers may be concealed. */
static void check_part(const adcgs_model *whole, const adcgs_model *part)
{
    adcgs_error difference = {ADCGS_OK, ""};
    adcgs_model coarser;
    assert_int_equal(adcgs_model_validate(part, &difference), ADCGS_OK);
    assert_int_equal(adcgs_model_coarser(&coarser, whole, whole->finest + 1 - part->absent, NULL, NULL), ADCGS_OK);
    assert_int_equal(coarser.n, part->n);
    assert_int_equal(coarser.absent, part->absent);
    assert_memory_equal(coarser.pos, part->pos, 3 * sizeof *coarser.pos * coarser.n);
    assert_memory_equal(coarser.fv, part->fv, sizeof *coarser.fv * coarser.n * coarser.params.n_fv);
    if (part->layers == adcgs_params_layers(&whole->params) && !adcgs_model_equal(&coarser, part, &difference))
        fail_msg("%s", difference.text);
    adcgs_model_clear(&coarser, NULL);
}

/** Pushes n bytes to a new decoder. */
static adcgs_decoder *push_bytes(const uint8_t *data, size_t n)
{
    adcgs_decoder *d = NULL;
    adcgs_config config;
    adcgs_arrival arrived;
    adcgs_config_init(&config, sizeof config);
    config.threads = 1;
    assert_int_equal(adcgs_open_push(&d, &config, NULL), ADCGS_OK);
    for (size_t at = 0, used; at < n; at += used)
        assert_int_equal(adcgs_push(d, data + at, n - at, &used, &arrived, NULL), ADCGS_OK);
    return d;
}

/* REQ-STRM-031, REQ-STRM-050 */
static void test_every_prefix(void **state)
{
    adcgs_stream stream, part;
    adcgs_buffer bytes;
    const adcgs_read_options options = {.cpu = ADCGS_CPU_SCALAR};
    int drawn = 0;
    (void)state;
    make(&stream, &bytes, 3);
    for (size_t n = 0; n <= bytes.size; n++) {
        adcgs_span from = {.next = bytes.data, .left = n};
        adcgs_error error = {ADCGS_OK, ""};
        if (adcgs_stream_read(&part, adcgs_span_read, &from, &options, NULL, NULL, &error) != ADCGS_OK) {
            assert_int_equal(error.status, ADCGS_ERR_TRUNCATED);
            assert_false(drawn);
            continue;
        }
        drawn |= 1 << part.segments[0].absent;
        check_part(&stream.segments[0], &part.segments[0]);
        adcgs_stream_clear(&part, NULL);
        if (n % 11)
            continue;
        adcgs_decoder *ends = open_bytes(bytes.data, n), *comes = push_bytes(bytes.data, n);
        assert_int_equal(adcgs_push_end(comes, NULL), ADCGS_OK);
        compare_splats(ends, comes);
        adcgs_close(&ends);
        adcgs_close(&comes);
    }
    assert_int_equal(drawn, (2 << stream.segments[0].finest) - 1);
    clear(&stream, &bytes);
}

/** If the second tier is cut off, a layer that the first tier lacks is still lacking. */
static void test_layers_of_first(void **state)
{
    adcgs_stream stream, part;
    adcgs_buffer bytes, cut;
    const adcgs_read_options options = {.cpu = ADCGS_CPU_SCALAR};
    (void)state;
    make(&stream, &bytes, 4);
    adcgs_buffer_init(&cut);
    const size_t second = place_of(&bytes, 1), end = second + (place_of(&bytes, 2) - second) / 2;
    for (size_t at = ADCGS_SIGNATURE_BYTES, next; at < second; at = next) {
        next = at + ADCGS_CHUNK_BYTES + adcgs_load_le32(bytes.data + at + 4);
        if (adcgs_load_le32(bytes.data + at) == ADCGS_TYPE_FEA(2)) { /* the last of the first tier */
            adcgs_write_bytes(&cut, bytes.data, at);
            adcgs_write_bytes(&cut, bytes.data + next, end - next);
        }
    }
    adcgs_span from = {.next = cut.data, .left = cut.size};
    assert_int_equal(adcgs_stream_read(&part, adcgs_span_read, &from, &options, NULL, NULL, NULL), ADCGS_OK);
    assert_int_equal(part.segments[0].absent, stream.segments[0].finest);
    assert_int_equal(part.segments[0].layers, 2);
    check_part(&stream.segments[0], &part.segments[0]);
    adcgs_stream_clear(&part, NULL);
    adcgs_buffer_clear(&cut);
    clear(&stream, &bytes);
}

/** With any byte behind the first tier changed, the result is a part of the written model. */
static void test_damaged(void **state)
{
    adcgs_stream stream, part;
    adcgs_buffer bytes;
    const adcgs_read_options options = {.cpu = ADCGS_CPU_SCALAR};
    (void)state;
    make(&stream, &bytes, 5);
    for (size_t n = place_of(&bytes, 1); n < bytes.size; n++) {
        adcgs_span from = {.next = bytes.data, .left = bytes.size};
        uint32_t faults;
        bytes.data[n] ^= 0x55;
        assert_int_not_equal(adcgs_stream_read(&part, adcgs_span_read, &from, &options, NULL, NULL, NULL), ADCGS_OK);
        FILE *file = tmpfile();
        assert_non_null(file);
        assert_int_equal(fwrite(bytes.data, 1, bytes.size, file), bytes.size);
        assert_int_equal(adcgs_stream_salvage(&part, adcgs_file_read_at, file, bytes.size, &options, &faults, NULL), ADCGS_OK);
        assert_true(faults > 0);
        check_part(&stream.segments[0], &part.segments[0]);
        adcgs_stream_clear(&part, NULL);
        fclose(file);
        bytes.data[n] ^= 0x55;
    }
    clear(&stream, &bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_wanted), cmocka_unit_test(test_every_prefix),
                                       cmocka_unit_test(test_layers_of_first), cmocka_unit_test(test_damaged)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * State after a failure. Refused pushed bytes leave the splats of every time unchanged. A stream that is read on demand keeps its
 * number of segments, and can be decoded wherever its bytes are right.
 */
#include "stream_fixture.h"

#include "stream/chunk.h"
#include "stream_edit.h"

#include <adcgs/adcgs.h>

enum { SEGMENTS = 4, TIMES = 6 };

/** Splats and information at some times. */
typedef struct shown {
    adcgs_status status[TIMES], info_status;
    uint8_t digest[TIMES][16];
    int segments, tiers_present;
    double drawable;
} shown;

/** A key, two predicted segments, a key: several tiers, layers of several slices, and crossfades. */
static int setup(void **state)
{
    fixture *f = fixture_new(state);
    adcgs_params params;
    uint64_t seed = 14;
    adcgs_random_small_params(&params, 2, &seed);
    for (int tiers = 0; tiers < 2; seed++) {
        adcgs_stream_clear(&f->stream, NULL);
        adcgs_stream_init(&f->stream);
        f->bytes.size = 0;
        if (fixture_turns(f, &params, SEGMENTS, 80, 4, 40, &seed) != 0)
            return -1;
        tiers = f->stream.segments[0].finest + 1;
    }
    return 0;
}

static shown state_of(adcgs_decoder *d)
{
    shown s = {.segments = 0};
    adcgs_info info;
    s.info_status = adcgs_get_info(d, &info, sizeof info, NULL);
    for (int i = 0; i < TIMES; i++)
        s.status[i] = adcgs_get_splat_digest(d, 0.001 * (7 + 30 * i), s.digest[i], NULL);
    if (s.info_status == ADCGS_OK) {
        s.segments = info.segments;
        s.drawable = info.time_available;
        s.tiers_present = info.tiers_present;
    }
    return s;
}

/** The refused chunk may have ended the segment before it. */
static void check_same(const shown *before, const shown *after, const char *name)
{
    if (memcmp(before->digest, after->digest, sizeof before->digest) ||
        memcmp(before->status, after->status, sizeof before->status))
        fail_msg("%s: splats changed by a failure", name);
    assert_in_range(after->segments, before->segments, before->segments + 1);
    if (before->info_status == ADCGS_OK && before->drawable != after->drawable)
        fail_msg("%s: time_available is %g after a failure, %g before", name, after->drawable, before->drawable);
}

static adcgs_decoder *open_push(uint64_t memory)
{
    adcgs_decoder *d = NULL;
    adcgs_config config;
    adcgs_config_init(&config, sizeof config);
    config.threads = 1;
    config.memory_limit = memory;
    assert_int_equal(adcgs_open_push(&d, &config, NULL), ADCGS_OK);
    return d;
}

static adcgs_status push(adcgs_decoder *d, const uint8_t *data, size_t bytes)
{
    adcgs_status status = ADCGS_OK;
    adcgs_arrival arrived = ADCGS_ARRIVED_NOTHING;
    for (size_t used; bytes > 0 && status == ADCGS_OK && arrived != ADCGS_ARRIVED_END; data += used, bytes -= used)
        status = adcgs_push(d, data, bytes, &used, &arrived, NULL);
    return status;
}

/** Pushes chunk by chunk, with a comparison before each. \return true if one was refused. */
static int push_chunks(const uint8_t *data, size_t size)
{
    adcgs_decoder *d = open_push(0);
    adcgs_found_chunk c;
    adcgs_status status = push(d, data, ADCGS_SIGNATURE_BYTES);
    for (size_t at = ADCGS_SIGNATURE_BYTES, next = at; status == ADCGS_OK && adcgs_next_chunk(data, size, &next, &c); at = next) {
        const shown before = state_of(d);
        status = push(d, data + at, next - at);
        if (status != ADCGS_OK) {
            const shown after = state_of(d), again = state_of(d);
            char name[5] = "";
            adcgs_store_le32((uint8_t *)name, c.type);
            check_same(&before, &after, name);
            assert_memory_equal(&after, &again, sizeof after);
            assert_int_equal(push(d, data, 1), status);
        }
    }
    adcgs_close(&d);
    return status != ADCGS_OK;
}

/** Some bytes of each payload are wrong, and all checksums right. */
static void test_refused_chunk(void **state)
{
    const fixture *f = *state;
    const size_t size = f->bytes.size;
    uint8_t *bytes = malloc(size);
    adcgs_found_chunk c;
    int refused = 0;
    assert_non_null(bytes);
    for (size_t next = ADCGS_SIGNATURE_BYTES; adcgs_next_chunk(f->bytes.data, size, &next, &c);)
        for (size_t i = 0; i < c.length; i += 1 + c.length / 7) {
            memcpy(bytes, f->bytes.data, size);
            bytes[c.payload + i] ^= (uint8_t)(0x55 << i % 3);
            adcgs_repair_stream(bytes, size, 0);
            refused += push_chunks(bytes, size);
        }
    assert_in_range(refused, 50, 1000);
    free(bytes);
}

/** Memory ends anywhere: an incomplete model gives no splats. */
static void test_no_memory(void **state)
{
    const fixture *f = *state;
    int refused = 0;
    for (uint64_t limit = 100000; limit < 2000000; limit += limit / 64) {
        adcgs_decoder *d = open_push(limit), *free_one = open_push(0);
        adcgs_status status = ADCGS_OK;
        size_t at = ADCGS_SIGNATURE_BYTES, next = at;
        adcgs_found_chunk c;
        push(d, f->bytes.data, at);
        push(free_one, f->bytes.data, at);
        while (adcgs_next_chunk(f->bytes.data, f->bytes.size, &next, &c) &&
               (status = push(d, f->bytes.data + at, next - at)) == ADCGS_OK) {
            push(free_one, f->bytes.data + at, next - at);
            at = next;
        }
        const shown now = state_of(d), expected = state_of(free_one);
        for (int i = 0; status != ADCGS_OK && i < TIMES; i++)
            if (now.status[i] == ADCGS_OK)
                assert_memory_equal(now.digest[i], expected.digest[i], sizeof now.digest[i]);
            else
                assert_true(now.status[i] == ADCGS_ERR_LIMIT || now.status[i] == expected.status[i]);
        refused += status != ADCGS_OK;
        adcgs_close(&d);
        adcgs_close(&free_one);
    }
    assert_in_range(refused, 10, 1000);
}

/* ---- On demand ---- */

typedef struct source {
    const uint8_t *data;
} source;

static int64_t read_at(void *user, uint64_t offset, void *buffer, size_t bytes)
{
    memcpy(buffer, ((const source *)user)->data + offset, bytes);
    return (int64_t)bytes;
}

static adcgs_decoder *open_at(source *s, size_t size)
{
    adcgs_decoder *d = NULL;
    assert_int_equal(adcgs_open_at(&d, read_at, s, size, NULL, NULL), ADCGS_OK);
    return d;
}

/** A chunk changes for a while: its bytes, or also its header. */
static void test_bytes_that_change(void **state)
{
    const fixture *f = *state;
    const size_t size = f->bytes.size;
    uint8_t *other = malloc(size);
    source s = {f->bytes.data};
    adcgs_decoder *d = open_at(&s, size);
    const shown expected = state_of(d);
    adcgs_found_chunk c;
    int failed = 0;
    assert_non_null(other);
    for (size_t next = ADCGS_SIGNATURE_BYTES; adcgs_next_chunk(f->bytes.data, size, &next, &c);)
        for (int kind = 0; kind < 3; kind++) {
            memcpy(other, f->bytes.data, size);
            other[kind == 2 ? c.at : c.payload + c.length / 3] ^= 1;
            if (kind)
                adcgs_repair_stream(other, size, 0);
            s.data = other;
            const shown then = state_of(d);
            assert_int_equal(then.segments, SEGMENTS);
            failed += memcmp(&then, &expected, sizeof then) != 0;
            s.data = f->bytes.data;
            (void)state_of(d); /* changed bytes with right checksums may still be in memory */
            const shown now = state_of(d);
            assert_memory_equal(now.digest, expected.digest, sizeof now.digest);
        }
    assert_in_range(failed, 10, 1000);
    adcgs_close(&d);
    free(other);
}

/** INDX has other times than the segments: the segments' times count. */
static void test_index_of_other_times(void **state)
{
    const fixture *f = *state;
    const size_t size = f->bytes.size, index = size - 32 - 4 - 37 * SEGMENTS;
    uint8_t *other = malloc(size);
    source s = {f->bytes.data};
    adcgs_decoder *d = open_at(&s, size);
    const shown expected = state_of(d);
    adcgs_close(&d);
    assert_non_null(other);
    for (size_t entry = 0; entry < SEGMENTS; entry++)
        for (size_t field = 0; field <= 16; field += 8) {
            memcpy(other, f->bytes.data, size);
            other[index + 37 * entry + field] ^= 16;
            adcgs_repair_stream(other, size, 0);
            s.data = other;
            d = open_at(&s, size);
            const shown now = state_of(d);
            assert_memory_equal(now.digest, expected.digest, sizeof now.digest);
            assert_memory_equal(now.status, expected.status, sizeof now.status);
            adcgs_close(&d);
        }
    free(other);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_refused_chunk),
        cmocka_unit_test(test_no_memory),
        cmocka_unit_test(test_bytes_that_change),
        cmocka_unit_test(test_index_of_other_times),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}

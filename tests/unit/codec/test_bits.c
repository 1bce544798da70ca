/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Byte fields and the range coder: inverse of each other, terminating, and detecting damage. */
#include "bits/range.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

static uint32_t random32(uint64_t *state)
{
    *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (uint32_t)(*state >> 33) ^ (uint32_t)(*state >> 11);
}

static void test_fields(void **state)
{
    (void)state;
    static const uint32_t values[] = {0, 1, 127, 128, 16383, 16384, 0x0fffffff, 0x10000000, UINT32_MAX};
    adcgs_buffer b;
    adcgs_buffer_init(&b);
    for (size_t i = 0; i < ADCGS_COUNTOF(values); i++) {
        adcgs_write_varint(&b, values[i]);
        adcgs_write_uint(&b, values[i] * UINT64_C(0x100000001), 8);
        adcgs_write_uint(&b, values[i], 3);
    }
    adcgs_reader r;
    adcgs_reader_init(&r, b.data, b.size);
    for (size_t i = 0; i < ADCGS_COUNTOF(values); i++) {
        assert_int_equal(adcgs_read_varint(&r), values[i]);
        assert_true(adcgs_read_uint(&r, 8) == values[i] * UINT64_C(0x100000001));
        assert_int_equal(adcgs_read_uint(&r, 3), values[i] & 0xffffff);
    }
    assert_int_equal(adcgs_reader_left(&r), 0);
    assert_false(r.overrun);
    assert_int_equal(adcgs_read_uint(&r, 1), 0);
    assert_true(r.overrun);
    assert_null(adcgs_read_bytes(&r, 0));
    adcgs_buffer_clear(&b);
}

/* REQ-CONV-006 */
static void test_varint_is_unique(void **state)
{
    (void)state;
    static const uint8_t bad[][6] = {{0x80, 0x00},
                                     {0xff, 0x80, 0x00},
                                     {0xff, 0xff, 0xff, 0xff, 0x10},
                                     {0x80, 0x80, 0x80, 0x80, 0x80, 0x01}};
    for (size_t i = 0; i < ADCGS_COUNTOF(bad); i++) {
        adcgs_reader r;
        adcgs_reader_init(&r, bad[i], sizeof bad[i]);
        adcgs_read_varint(&r);
        assert_true(r.overrun);
    }
}

/* A random mixture of all functions of the coder; decode != 0 checks instead of writing. */
typedef struct mixture {
    uint32_t cdf[40];
    int n;
} mixture;

static void make_cdf(mixture *m, uint64_t *seed)
{
    m->n = 1 + (int)(random32(seed) % 38);
    for (int i = 0; i <= m->n; i++)
        m->cdf[i] = (uint32_t)i;
    /* Spread the remaining probability over some symbols; often nearly all of it on one. */
    uint32_t left = 65536 - (uint32_t)m->n;
    while (left) {
        const int k = (int)(random32(seed) % (uint32_t)m->n);
        const uint32_t add = random32(seed) % 3 ? left : 1 + random32(seed) % left;
        for (int i = k + 1; i <= m->n; i++)
            m->cdf[i] += add;
        left -= add;
    }
}

static void run_mixture(uint64_t seed, int count, adcgs_range_enc *e, adcgs_range_dec *d)
{
    adcgs_adaptive contexts[4];
    adcgs_adaptive_init(contexts, 4);
    for (int i = 0; i < count; i++) {
        const uint32_t kind = random32(&seed) % 4, draw = random32(&seed);
        if (kind == 0) {
            mixture m;
            make_cdf(&m, &seed);
            int symbol = 0;
            while (m.cdf[symbol + 1] <= draw % 65536)
                symbol++;
            symbol = draw >> 31 ? symbol : (int)(draw >> 20) % m.n;
            if (e)
                adcgs_range_enc_symbol(e, m.cdf, m.n, symbol);
            else
                assert_int_equal(adcgs_range_dec_symbol(d, m.cdf, m.n), symbol);
        } else if (kind == 1) {
            const int n = 1 + (int)(draw % 16);
            const uint32_t value = (draw >> 8) & ((1u << n) - 1);
            if (e)
                adcgs_range_enc_bits(e, value, n);
            else
                assert_int_equal(adcgs_range_dec_bits(d, n), value);
        } else if (kind == 2) {
            const uint32_t p1 = draw & 1 ? 1 + (draw >> 1) % 65535 : draw & 2 ? 1 : 65535;
            const int bit = (draw >> 20) & 1;
            if (e)
                adcgs_range_enc_bit(e, p1, bit);
            else
                assert_int_equal(adcgs_range_dec_bit(d, p1), bit);
        } else {
            const int bit = (draw >> 3) % 9 == 0;
            if (e)
                adcgs_adaptive_enc(e, &contexts[draw & 3], bit);
            else
                assert_int_equal(adcgs_adaptive_dec(d, &contexts[draw & 3]), bit);
        }
    }
}

/* REQ-PARS-001, REQ-PARS-003, REQ-PARS-004, REQ-PARS-005, REQ-PARS-007, REQ-PARS-010 */
static void test_round_trip(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 2000; seed++) {
        const int count = seed < 200 ? (int)seed : (int)(seed * 7 % 500);
        adcgs_buffer b;
        adcgs_buffer_init(&b);
        adcgs_write_uint(&b, 0xffffff, 3); /* a carry must stop at the start of the sub-stream */
        adcgs_range_enc e;
        adcgs_range_enc_init(&e, &b);
        run_mixture(seed, count, &e, NULL);
        adcgs_range_enc_finish(&e);
        assert_int_equal(b.data[0] & b.data[1] & b.data[2], 255);
        adcgs_range_dec d;
        adcgs_range_dec_init(&d, b.data + 3, b.size - 3);
        run_mixture(seed, count, NULL, &d);
        assert_int_equal(adcgs_range_dec_finish(&d, NULL), ADCGS_OK);
        adcgs_buffer_clear(&b);
    }
}

/* Low stays at the top of its interval: carries run through many bytes of 0xff. */
/* REQ-PARS-003 */
static void test_long_carry(void **state)
{
    (void)state;
    for (int n = 1; n < 60; n++) {
        adcgs_buffer b;
        adcgs_buffer_init(&b);
        adcgs_range_enc e;
        adcgs_range_enc_init(&e, &b);
        for (int i = 0; i < n; i++)
            adcgs_range_enc_bit(&e, 1, 0);
        for (int i = 0; i < n; i++)
            adcgs_range_enc_bits(&e, 0xffff, 16);
        adcgs_range_enc_finish(&e);
        adcgs_range_dec d;
        adcgs_range_dec_init(&d, b.data, b.size);
        for (int i = 0; i < n; i++)
            assert_int_equal(adcgs_range_dec_bit(&d, 1), 0);
        for (int i = 0; i < n; i++)
            assert_int_equal(adcgs_range_dec_bits(&d, 16), 0xffff);
        assert_int_equal(adcgs_range_dec_finish(&d, NULL), ADCGS_OK);
        adcgs_buffer_clear(&b);
    }
}

static void decode_anything(adcgs_range_dec *d, int count)
{
    static const uint32_t cdf[] = {0, 100, 60000, 65000, 65536};
    adcgs_adaptive context = ADCGS_ADAPTIVE_INIT;
    for (int i = 0; i < count; i++) {
        const int symbol = adcgs_range_dec_symbol(d, cdf, 4);
        assert_in_range(symbol, 0, 3);
        assert_in_range(adcgs_range_dec_bits(d, 5), 0, 31);
        adcgs_adaptive_dec(d, &context);
    }
}

/* REQ-PARS-002, REQ-PARS-008, REQ-PARS-009 */
static void test_damage_is_reported(void **state)
{
    (void)state;
    static const uint8_t top[8] = {255, 255, 255, 255, 255, 255, 255, 255};
    adcgs_range_dec d;
    adcgs_range_dec_init(&d, top, 8);
    assert_int_equal(adcgs_range_dec_finish(&d, NULL), ADCGS_ERR_DATA);
    decode_anything(&d, 100);
    adcgs_range_dec_init(&d, NULL, 0);
    assert_int_equal(adcgs_range_dec_finish(&d, NULL), ADCGS_OK);
    decode_anything(&d, 100);
    assert_int_equal(adcgs_range_dec_finish(&d, NULL), ADCGS_ERR_DATA);
    uint64_t seed = 5;
    for (int trial = 0; trial < 2000; trial++) {
        uint8_t bytes[64];
        for (size_t i = 0; i < sizeof bytes; i++)
            bytes[i] = (uint8_t)(random32(&seed) >> 8);
        adcgs_range_dec_init(&d, bytes, sizeof bytes);
        decode_anything(&d, 20);
        assert_int_equal(adcgs_range_dec_finish(&d, NULL), ADCGS_ERR_DATA); /* left over */
        decode_anything(&d, 100);
        assert_int_equal(adcgs_range_dec_finish(&d, NULL), ADCGS_ERR_DATA); /* too short */
    }
}

/* REQ-PARS-010 */
static void test_adaptive_stays_inside(void **state)
{
    (void)state;
    for (int bit = 0; bit < 2; bit++) {
        adcgs_adaptive c = ADCGS_ADAPTIVE_INIT;
        for (int i = 0; i < 5000; i++)
            adcgs_adaptive_update(&c, bit);
        assert_in_range(c.p1, 1, 65535);
        assert_true(adcgs_bit_cost(c.p1, bit) < 200);
    }
}

static void test_bit_cost(void **state)
{
    (void)state;
    for (uint32_t p = 1; p < 65536; p++) {
        const double exact = -log2(p / 65536.0) * 65536;
        assert_true(fabs(exact - adcgs_bit_cost(p, 1)) < 1.5);
        assert_int_equal(adcgs_bit_cost(p, 1), adcgs_bit_cost(65536 - p, 0));
    }
    assert_int_equal(adcgs_bit_cost(65536, 1), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_fields),
        cmocka_unit_test(test_varint_is_unique),
        cmocka_unit_test(test_round_trip),
        cmocka_unit_test(test_long_carry),
        cmocka_unit_test(test_damage_is_reported),
        cmocka_unit_test(test_adaptive_stays_inside),
        cmocka_unit_test(test_bit_cost),
    };
    return cmocka_run_group_tests_name("bits", tests, NULL, NULL);
}

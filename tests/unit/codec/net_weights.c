/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The weight coder: integer and binary32 tensors return exactly, at about the bits of their entropy. */
#include "net_numbers.h"
#include "second_sources.h"

#include "net/net.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

static size_t encode_tensor(const adcgs_tensor *t, adcgs_buffer *b)
{
    adcgs_buffer_init(b);
    adcgs_range_enc e;
    adcgs_range_enc_init(&e, b);
    adcgs_tensor_encode(&e, t);
    adcgs_range_enc_finish(&e);
    return b->size;
}

static adcgs_status decode_tensor(adcgs_tensor *t, const uint8_t *data, size_t bytes)
{
    adcgs_range_dec d;
    adcgs_range_dec_init(&d, data, bytes);
    const adcgs_status status = adcgs_tensor_decode(&d, t, NULL);
    return status != ADCGS_OK ? status : adcgs_range_dec_finish(&d, NULL);
}

/* Returns bits per number. */
static double check_tensor(const adcgs_tensor *t)
{
    adcgs_buffer b;
    adcgs_tensor back;
    make_tensor(&back, t->rows, t->cols);
    back.mode = t->mode;
    const size_t n = (size_t)t->rows * t->cols, bytes = encode_tensor(t, &b);
    assert_int_equal(decode_tensor(&back, b.data, b.size), ADCGS_OK);
    assert_memory_equal(back.m, t->m, n * sizeof *t->m);
    /* truncated and damaged data end; the checksum has to refuse the decoded result */
    for (size_t cut = 0; cut < ADCGS_MIN(bytes, 300); cut++)
        decode_tensor(&back, b.data, cut);
    for (size_t i = 0; i < ADCGS_MIN(bytes, 300); i++) {
        b.data[i] ^= (uint8_t)(1 << i % 8);
        decode_tensor(&back, b.data, bytes);
        b.data[i] ^= (uint8_t)(1 << i % 8);
    }
    adcgs_free(NULL, back.m);
    adcgs_buffer_clear(&b);
    return 8.0 * (double)bytes / (double)n;
}

static double gauss(uint64_t *seed)
{
    double sum = -6;
    for (int i = 0; i < 12; i++)
        sum += random32(seed) / 4294967296.0;
    return sum;
}

/* REQ-NETW-001, REQ-WGHT-001, REQ-WGHT-002 */
static void test_integer_tensors(void **state)
{
    (void)state;
    static const int32_t extremes[] = {0,    1,     -1,        2,         -2,         3,       4,    -65535,
                                       2047, -2047, INT32_MAX, INT32_MIN, -INT32_MAX, 1 << 30, 65536};
    uint64_t seed = 21;
    adcgs_tensor t;
    make_tensor(&t, 5, 3);
    check_tensor(&t); /* all zero */
    memcpy(t.m, extremes, sizeof extremes);
    check_tensor(&t);
    for (int i = 0; i < 15; i++)
        t.m[i] = extremes[i] & ~0x3fffffff;
    check_tensor(&t); /* 30 common zero bits */
    for (int i = 0; i < 15; i++)
        t.m[i] = i & 1 ? INT32_MIN : 0;
    check_tensor(&t);
    adcgs_free(NULL, t.m);
    for (int spread = 1; spread <= 1000000; spread *= 10) {
        make_tensor(&t, 1 + random32(&seed) % 60, 1 + random32(&seed) % 80);
        for (uint32_t i = 0; i < t.rows * t.cols; i++)
            t.m[i] = (int32_t)lrint(gauss(&seed) * spread) * 256;
        check_tensor(&t);
        adcgs_free(NULL, t.m);
    }
}

static void test_weights_are_cheap(void **state)
{
    (void)state;
    uint64_t seed = 22;
    adcgs_tensor t;
    make_tensor(&t, 64, 64);
    for (uint32_t i = 0; i < 4096; i++)
        t.m[i] = (int32_t)lrint(gauss(&seed) * 8) * 4096;
    const double gaussian = check_tensor(&t); /* entropy 5.05 */
    for (uint32_t i = 0; i < 4096; i++)
        t.m[i] = (int32_t)lrint(1e6 * sin(i % 64 * 0.1 + i / 64 * 0.01)) * 16;
    const double smooth = check_tensor(&t);
    for (uint32_t i = 0; i < 4096; i++)
        t.m[i] = (int32_t)adcgs_float_bits((float)gauss(&seed));
    t.mode = 1;
    const double floats = check_tensor(&t);
    printf("bits per number: Gaussian lattice %.3f, smooth table %.3f, binary32 %.3f\n", gaussian, smooth, floats);
    assert_true(gaussian < 5.35 && smooth < 16 && floats < 28.5);
    adcgs_free(NULL, t.m);
}

/* REQ-NETW-001, REQ-WGHT-003, REQ-WGHT-004 */
static void test_float_tensors(void **state)
{
    (void)state;
    static const uint32_t bits[] = {0,          0x80000000, 1,          0x80000001, 0x007fffff,
                                    0x00800000, 0x7f7fffff, 0xff7fffff, 0x3f800000, 0x3f800001,
                                    0x3f800002, 0x3fc00000, 0x3fe00000, 0xbf000000, 0x40490fdb};
    adcgs_tensor t;
    make_tensor(&t, 3, 5);
    t.mode = 1;
    memcpy(t.m, bits, sizeof bits);
    check_tensor(&t);
    /* infinity is no weight */
    t.m[7] = 0x7f800000;
    adcgs_buffer b;
    encode_tensor(&t, &b);
    assert_int_equal(decode_tensor(&t, b.data, b.size), ADCGS_ERR_DATA);
    adcgs_buffer_clear(&b);
    adcgs_free(NULL, t.m);
}

int adcgs_test_net_weights(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_integer_tensors),
        cmocka_unit_test(test_weights_are_cheap),
        cmocka_unit_test(test_float_tensors),
    };
    return cmocka_run_group_tests_name("net weights", tests, NULL, NULL);
}

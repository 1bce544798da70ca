/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The base: known answers of the digests, memory accounting, statuses, CPU levels, and the pool at 1, 2 and 7 threads. */
#include "base/cpu_detect.h"
#include "base/digest.h"
#include "base/fmath.h"
#include "base/thread_pool.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdlib.h>

#include <cmocka.h>

/* REQ-STRM-002 */
static void test_crc32c(void **state)
{
    (void)state;
    uint8_t bytes[100];
    assert_int_equal(adcgs_crc32c(0, "", 0), 0);
    assert_int_equal(adcgs_crc32c(0, "123456789", 9), 0xe3069283);
    memset(bytes, 0, 32);
    assert_int_equal(adcgs_crc32c(0, bytes, 32), 0x8a9136aa); /* RFC 3720, B.4 */
    memset(bytes, 255, 32);
    assert_int_equal(adcgs_crc32c(0, bytes, 32), 0x62a8ab43);
    for (int i = 0; i < 32; i++)
        bytes[i] = (uint8_t)i;
    assert_int_equal(adcgs_crc32c(0, bytes, 32), 0x46dd794e);
    for (int i = 0; i < 100; i++)
        bytes[i] = (uint8_t)(i * 37);
    for (size_t cut = 0; cut <= 100; cut++)
        assert_int_equal(adcgs_crc32c(adcgs_crc32c(0, bytes, cut), bytes + cut, 100 - cut), adcgs_crc32c(0, bytes, 100));
}

static void test_md5(void **state)
{
    (void)state;
    static const struct {
        const char *text, *digest;
    } answers[] = {
        /* RFC 1321, A.5 */
        {"", "d41d8cd98f00b204e9800998ecf8427e"},
        {"a", "0cc175b9c0f1b6a831c399e269772661"},
        {"abc", "900150983cd24fb0d6963f7d28e17f72"},
        {"message digest", "f96b697d7cb7938d525a2f31aaf161d0"},
        {"abcdefghijklmnopqrstuvwxyz", "c3fcd3d76192e4007dfb496cca67e13b"},
        {"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789", "d174ab98d277d9f5a5611c2c9f419d9f"},
        {"12345678901234567890123456789012345678901234567890123456789012345678901234567890", "57edf4a22be3c955ac49da2e2107b67a"},
    };
    for (size_t i = 0; i < ADCGS_COUNTOF(answers); i++) {
        const size_t length = strlen(answers[i].text);
        for (size_t cut = 0; cut <= length; cut++) {
            adcgs_md5 md5;
            uint8_t digest[16];
            char text[33];
            adcgs_md5_init(&md5);
            adcgs_md5_update(&md5, answers[i].text, cut);
            adcgs_md5_update(&md5, answers[i].text + cut, length - cut);
            adcgs_md5_final(&md5, digest);
            adcgs_md5_hex(digest, text);
            assert_string_equal(text, answers[i].digest);
        }
    }
}

static void test_memory(void **state)
{
    (void)state;
    adcgs_memory memory = {.limit = 10000};
    adcgs_error error = {0};
    uint8_t *a = adcgs_alloc(&memory, 1000, 5, &error), *b = adcgs_alloc(&memory, 0, 8, NULL);
    assert_non_null(a);
    assert_non_null(b);
    assert_int_equal((uintptr_t)a % 64 + (uintptr_t)b % 64, 0);
    for (int i = 0; i < 5000; i++)
        assert_int_equal(a[i], 0);
    assert_true(memory.used >= 5000);
    assert_null(adcgs_alloc(&memory, 5000, 1, &error));
    assert_int_equal(error.status, ADCGS_ERR_LIMIT);
    assert_null(adcgs_alloc(&memory, SIZE_MAX / 2, 3, &error)); /* more than any limit */
    assert_int_equal(error.status, ADCGS_ERR_LIMIT);
    assert_null(adcgs_alloc(NULL, SIZE_MAX / 2, 3, &error));
    assert_int_equal(error.status, ADCGS_ERR_MEMORY);
    assert_null(adcgs_alloc(NULL, SIZE_MAX - 10, 1, NULL));
    adcgs_free(&memory, a);
    adcgs_free(&memory, b);
    adcgs_free(&memory, NULL);
    assert_int_equal(memory.used, 0);
    assert_true(memory.peak >= 5000);
}

static void test_status(void **state)
{
    (void)state;
    for (int i = 0; i < 10; i++) {
        assert_true(strlen(adcgs_status_name((adcgs_status)-i)) > 3);
        for (int j = 0; j < i; j++)
            assert_string_not_equal(adcgs_status_name((adcgs_status)-i), adcgs_status_name((adcgs_status)-j));
    }
    assert_string_equal(adcgs_status_name((adcgs_status)7), adcgs_status_name(ADCGS_ERR_INTERNAL));
    adcgs_error error;
    char longer[400];
    memset(longer, 'x', sizeof longer);
    longer[399] = 0;
    assert_int_equal(adcgs_fail(&error, ADCGS_ERR_DATA, "%s", longer), ADCGS_ERR_DATA);
    assert_int_equal(strlen(error.text), sizeof error.text - 1);
    assert_int_equal(adcgs_fail(NULL, ADCGS_ERR_IO, "nobody listens"), ADCGS_ERR_IO);
    adcgs_fail(&error, ADCGS_ERR_IO, "%s", "a\nb\x1b\x7f\xc3\xa9");
    assert_string_equal(error.text, "a?b??\xc3\xa9");
}

static void test_cpu(void **state)
{
    (void)state;
    adcgs_cpu_level level;
    assert_int_equal(adcgs_cpu_resolve(ADCGS_CPU_AUTO, &level, NULL), ADCGS_OK);
    assert_int_equal(level, adcgs_cpu_best());
    assert_int_equal(adcgs_cpu_resolve(ADCGS_CPU_SCALAR, &level, NULL), ADCGS_OK);
    assert_int_equal(level, ADCGS_CPU_SCALAR);
    assert_int_equal(adcgs_cpu_resolve((adcgs_cpu_level)9, &level, NULL), ADCGS_ERR_USAGE);
    for (int i = 0; i < 4; i++)
        assert_string_equal(adcgs_cpu_name((adcgs_cpu_level)i), adcgs_cpu_names[i]);
    assert_null(adcgs_cpu_names[4]);
    assert_string_equal(adcgs_cpu_name((adcgs_cpu_level)4), "unknown");
}

#define INDICES 1000

typedef struct tally {
    atomic_int calls[INDICES];
    atomic_int bad_thread;
    int threads;
} tally;

static void count_call(void *arg, int index, int thread)
{
    tally *t = arg;
    atomic_fetch_add(&t->calls[index], 1);
    if (thread < 0 || thread >= t->threads)
        atomic_store(&t->bad_thread, 1);
    for (volatile int i = 0; i < index % 50 * 10; i++) {
    }
}

static void run_pool(int threads)
{
    static tally t;
    adcgs_pool *pool = NULL;
    if (threads)
        assert_int_equal(adcgs_pool_create(&pool, threads, NULL), ADCGS_OK);
    t.threads = adcgs_pool_threads(pool);
    assert_int_equal(t.threads, threads ? threads : 1);
    for (int round = 0; round < 3000; round++) {
        const int n = round % 100 == 0 ? INDICES : round % 13;
        for (int i = 0; i < INDICES; i++)
            atomic_store_explicit(&t.calls[i], 0, memory_order_relaxed);
        adcgs_pool_run(pool, count_call, &t, n);
        for (int i = 0; i < INDICES; i++)
            assert_int_equal(atomic_load_explicit(&t.calls[i], memory_order_relaxed), i < n);
    }
    assert_false(t.bad_thread);
    adcgs_pool_free(&pool);
    assert_null(pool);
    adcgs_pool_free(&pool);
}

static void test_pool(void **state)
{
    (void)state;
    static const int counts[] = {0, 1, 2, 7};
    for (size_t i = 0; i < ADCGS_COUNTOF(counts); i++)
        run_pool(counts[i]);
    adcgs_pool *pool;
    assert_int_equal(adcgs_pool_create(&pool, -1, NULL), ADCGS_ERR_USAGE);
    assert_null(pool);
    assert_int_equal(adcgs_pool_create(&pool, 257, NULL), ADCGS_ERR_USAGE);
    assert_int_equal(adcgs_pool_create(&pool, 0, NULL), ADCGS_OK);
    assert_true(adcgs_pool_threads(pool) >= 1);
    adcgs_pool_free(&pool);
}

static void add_number(adcgs_md5 *md5, float x)
{
    uint8_t bytes[4];
    adcgs_store_le32(bytes, adcgs_float_bits(x));
    adcgs_md5_update(md5, bytes, sizeof bytes);
}

/* REQ-PRIM-001, REQ-PRIM-002, REQ-PRIM-003, REQ-PRIM-004: the specification's sweep_example. */
static void test_sweep(void **state)
{
    adcgs_md5 md5;
    uint8_t digest[16];
    char text[33];
    (void)state;
    adcgs_md5_init(&md5);
    for (int n = 0; n < 2048; n++) {
        const float x = (float)(n - 1024) * 0x1.5bf0a8p-5f, turn = (float)n * 0x1.5bf0a8p-3f;
        float sine, cosine;
        adcgs_sincospi(turn, &sine, &cosine);
        add_number(&md5, adcgs_exp(x));
        add_number(&md5, adcgs_sigmoid(x));
        add_number(&md5, adcgs_log2(adcgs_bits_float(0x00800000u + 1036287u * (uint32_t)n)));
        add_number(&md5, sine);
        add_number(&md5, cosine);
    }
    adcgs_md5_final(&md5, digest);
    adcgs_md5_hex(digest, text);
    assert_string_equal(text, "71b64812a7bd722a040ad91dfd910d4d");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_crc32c), cmocka_unit_test(test_md5),  cmocka_unit_test(test_memory), cmocka_unit_test(test_status),
        cmocka_unit_test(test_cpu),    cmocka_unit_test(test_pool), cmocka_unit_test(test_sweep),
    };
    return cmocka_run_group_tests_name("base", tests, NULL, NULL);
}

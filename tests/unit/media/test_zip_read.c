/* SPDX-License-Identifier: BSD-2-Clause */
/** \file ZIP archives in memory: stored and deflated files, faults of each field, and bombs. */
#include "outside_files.h"

#include "media/arrays/zip_read.h"

#ifdef HAVE_SOG

#include <zlib.h>

#define LENGTH 3000 /* bytes of the files */

static uint8_t content[LENGTH];

typedef struct archive {
    uint8_t data[16384];
    size_t bytes, directory; /**< position of the directory, once it is written */
    size_t end;              /**< that of the end record */
} archive;

static void put16(archive *a, unsigned value)
{
    adcgs_store_le16(a->data + a->bytes, (uint16_t)value);
    a->bytes += 2;
}

static void put32(archive *a, uint32_t value)
{
    adcgs_store_le32(a->data + a->bytes, value);
    a->bytes += 4;
}

static void put(archive *a, const void *data, size_t bytes)
{
    memcpy(a->data + a->bytes, data, bytes);
    a->bytes += bytes;
}

/** The fields that a local header and an entry share. */
static void put_common(archive *a, int method, uint32_t packed, const char *name, unsigned extra)
{
    put16(a, 20);
    put16(a, 0);
    put16(a, (unsigned)method);
    put32(a, 0x210000);
    put32(a, (uint32_t)crc32(0, content, LENGTH));
    put32(a, packed);
    put32(a, LENGTH);
    put16(a, (unsigned)strlen(name));
    put16(a, extra);
}

/** An archive with one file, "a/b", and an extra field in its local header, as numpy writes one. */
static void make(archive *a, int method, const char *comment)
{
    static uint8_t packed[2 * LENGTH];
    z_stream z = {.next_in = content, .avail_in = LENGTH, .next_out = packed, .avail_out = sizeof packed};
    assert_int_equal(deflateInit2(&z, 9, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY), Z_OK);
    assert_int_equal(deflate(&z, Z_FINISH), Z_STREAM_END);
    const uint32_t bytes = method ? (uint32_t)z.total_out : LENGTH;
    deflateEnd(&z);
    memset(a, 0, sizeof *a);
    put(a, "PK\3\4", 4);
    put_common(a, method, bytes, "a/b", 20);
    put(a, "a/b", 3);
    put(a, "\1\0\x10\0abcdefghijklmnop", 20);
    put(a, method ? packed : content, bytes);
    a->directory = a->bytes;
    put(a, "PK\1\2\24\0", 6);
    put_common(a, method, bytes, "a/b", 0);
    put(a, "\0\0\0\0\0\0\0\0\0\0\0\0\0\0", 14);
    put(a, "a/b", 3);
    a->end = a->bytes;
    put(a, "PK\5\6\0\0\0\0\1\0\1\0", 12);
    put32(a, (uint32_t)(a->end - a->directory));
    put32(a, (uint32_t)a->directory);
    put16(a, (unsigned)strlen(comment));
    put(a, comment, strlen(comment));
}

static adcgs_status unpack(const archive *a, size_t bytes, const char *name, uint64_t most, uint8_t **out, size_t *size)
{
    adcgs_zip_archive zip;
    *out = NULL;
    ADCGS_TRY(adcgs_zip_open(&zip, a->data, bytes, "a.zip", &error));
    return adcgs_zip_unpack(out, size, &zip, name, most, &error);
}

static void test_good(void **state)
{
    static const char *const comments[] = {"", "some words", "PK\5\6 is no second end"};
    archive a;
    uint8_t *out;
    size_t bytes;
    for (int method = 0; method <= 8; method += 8)
        for (size_t i = 0; i < ADCGS_COUNTOF(comments); i++) {
            make(&a, method, comments[i]);
            assert_true(adcgs_zip_is(a.data, a.bytes));
            assert_int_equal(unpack(&a, a.bytes, "a/b", LENGTH, &out, &bytes), ADCGS_OK);
            assert_true(bytes == LENGTH && !memcmp(out, content, LENGTH) && out[LENGTH] == 0);
            free(out);
        }
    adcgs_zip_archive zip;
    assert_int_equal(adcgs_zip_open(&zip, a.data, a.bytes, "a.zip", &error), ADCGS_OK);
    assert_true(adcgs_zip_has(&zip, "a/b") && !adcgs_zip_has(&zip, "b") && !adcgs_zip_has(&zip, "a/b."));
    expect_error(unpack(&a, a.bytes, "b", LENGTH, &out, &bytes), ADCGS_ERR_DATA, "a.zip: no file b", "");
    expect_error(unpack(&a, a.bytes, "a/b", LENGTH - 1, &out, &bytes), ADCGS_ERR_DATA, "a.zip: a/b: 3000 bytes", "at most 2999");
}

static void test_faults(void **state)
{
    static const struct {
        char part; /* d: directory, e: end record, l: local header, f: the file's bytes */
        int at, bytes;
        uint32_t value;
        adcgs_status status;
        const char *text;
    } cases[] = {
        {'d', 0, 4, 0, ADCGS_ERR_DATA, "its directory ends early"},
        {'d', 8, 2, 1, ADCGS_ERR_UNSUPPORTED, "encrypted"},
        {'d', 10, 2, 12, ADCGS_ERR_UNSUPPORTED, "the method 12"},
        {'d', 16, 4, 0, ADCGS_ERR_DATA, "the checksum of a file does not match"},
        {'d', 20, 4, 0x7fffffff, ADCGS_ERR_DATA, "it ends early"},
        {'d', 20, 4, 0xffffffff, ADCGS_ERR_UNSUPPORTED, "ZIP64"},
        {'d', 24, 4, 0xfffffff0, ADCGS_ERR_DATA, "a file's size differs"},
        {'d', 24, 4, LENGTH - 1, ADCGS_ERR_DATA, "length"},
        {'d', 24, 4, LENGTH + 1, ADCGS_ERR_DATA, "length"},
        {'d', 28, 2, 0xffff, ADCGS_ERR_DATA, "its directory ends early"},
        {'d', 42, 4, 1, ADCGS_ERR_DATA, "not where its directory says"},
        {'d', 42, 4, 0xfffffff0, ADCGS_ERR_DATA, "not where its directory says"},
        {'e', 0, 4, 0, ADCGS_ERR_DATA, "no directory, so the file ends early"},
        {'e', 4, 2, 1, ADCGS_ERR_UNSUPPORTED, "several parts"},
        {'e', 10, 2, 2, ADCGS_ERR_UNSUPPORTED, "several parts"},
        {'e', 10, 2, 0xffff, ADCGS_ERR_UNSUPPORTED, "ZIP64"},
        {'e', 16, 4, 0xffffff, ADCGS_ERR_DATA, "beyond its end"},
        {'l', 0, 4, 0, ADCGS_ERR_DATA, "not where its directory says"},
        {'l', 28, 2, 0xffff, ADCGS_ERR_DATA, "it ends early"},
        {'f', 1, 1, 0xff, ADCGS_ERR_DATA, "deflated data"},
    };
    archive a;
    uint8_t *out;
    size_t size;
    for (size_t i = 0; i < ADCGS_COUNTOF(cases); i++) {
        make(&a, 8, "");
        uint8_t *const at = a.data + cases[i].at +
                            (cases[i].part == 'd'   ? a.directory
                             : cases[i].part == 'e' ? a.end
                             : cases[i].part == 'f' ? 53
                                                    : 0);
        for (int k = 0; k < cases[i].bytes; k++)
            at[k] = (uint8_t)(cases[i].value >> 8 * k);
        expect_error(unpack(&a, a.bytes, "a/b", 1 << 30, &out, &size), cases[i].status, "a.zip: ", cases[i].text);
        assert_null(out);
    }
    make(&a, 0, "");
    a.data[60]++;
    expect_error(unpack(&a, a.bytes, "a/b", 1 << 30, &out, &size), ADCGS_ERR_DATA, "a.zip: ", "checksum");
    for (size_t n = 0; n < a.bytes; n++)
        expect_error(unpack(&a, n, "a/b", 1 << 30, &out, &size), ADCGS_ERR_DATA, "a.zip: damaged ZIP archive", "");
}

static int fill_content(void **state)
{
    for (size_t i = 0; i < LENGTH; i++)
        content[i] = (uint8_t)(i * i >> 6);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_good),
        cmocka_unit_test(test_faults),
    };
    return cmocka_run_group_tests(tests, fill_content, NULL);
}

#else

int main(void)
{
    puts("skipped: this build has no zlib");
    return 77;
}

#endif

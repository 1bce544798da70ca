/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The stream in a page, at any position, longer than the list of stored positions. */
#include "outside_files.h"

#include "media/page_stream.h"
#include "system/base64.h"

#define PART 57000u /* whole lines */
#define LONG_BYTES (900 * (size_t)PART + 4)

static uint8_t byte_at(uint64_t offset)
{
    return (uint8_t)(offset * 2654435761u >> 13);
}

/** Writes a page with a stream of `bytes` bytes; each line ends with `end`. */
static void write_page(const char *name, size_t bytes, int lines)
{
    uint8_t *const part = malloc(PART);
    FILE *const file = fopen(in(name), "wb");
    assert_true(part && file);
    fputs("<html><p id=\"scene\">x<y\n<script id=\"scene\" data-name=\"b/&lt;a&amp;amp;\">\n", file);
    for (size_t at = 0; at < bytes; at += PART) {
        const size_t n = bytes - at < PART ? bytes - at : PART;
        for (size_t i = 0; i < n; i++)
            part[i] = byte_at(at + i);
        adcgs_base64_write(file, part, n, lines);
    }
    fputs(" </script>\n<script id=\"scene\">AAAA</script></html>\n", file);
    assert_int_equal(fclose(file), 0);
    free(part);
}

static void check_bytes(adcgs_page_stream *page, uint64_t offset, size_t n)
{
    uint8_t out[256];
    assert_int_equal(adcgs_page_stream_read_at(page, offset, out, n), (int64_t)n);
    for (size_t i = 0; i < n; i++)
        assert_int_equal(out[i], byte_at(offset + i));
}

static void test_positions(void **state)
{
    adcgs_page_stream *page;
    uint8_t out[8];
    write_page("long.html", LONG_BYTES, 1);
    assert_int_equal(adcgs_page_stream_open(&page, in("long.html"), &error), ADCGS_OK);
    assert_int_equal(adcgs_page_stream_size(page), LONG_BYTES);
    assert_string_equal(adcgs_page_stream_name(page), "<a&amp;");
    check_bytes(page, 0, 256);
    for (uint64_t i = 1; i < 64; i++)
        check_bytes(page, i * 7919 * 7919 % (LONG_BYTES - 256), (size_t)(1 + i * 4));
    check_bytes(page, LONG_BYTES - 5, 5);
    check_bytes(page, LONG_BYTES - 7, 5);
    assert_int_equal(adcgs_page_stream_read_at(page, LONG_BYTES - 2, out, sizeof out), 2);
    assert_int_equal(adcgs_page_stream_read_at(page, LONG_BYTES, out, sizeof out), 0);
    assert_int_equal(adcgs_page_stream_read_at(page, UINT64_MAX, out, sizeof out), 0);
    assert_int_equal(adcgs_page_stream_read(page, out, 3), 3);
    check_bytes(page, 100, 50); /* does not move the reading in order */
    assert_int_equal(adcgs_page_stream_read(page, out, 3), 3);
    assert_int_equal(out[2], byte_at(5));
    adcgs_page_stream_close(&page);
}

static void test_paddings(void **state)
{
    for (size_t bytes = 1; bytes < 130; bytes++) {
        adcgs_page_stream *page;
        write_page("short.html", bytes, (int)(bytes % 2));
        assert_int_equal(adcgs_page_stream_open(&page, in("short.html"), &error), ADCGS_OK);
        assert_int_equal(adcgs_page_stream_size(page), bytes);
        check_bytes(page, 0, bytes);
        adcgs_page_stream_close(&page);
    }
}

/** A page that shrinks after it was opened is an error of reading. */
static void test_change(void **state)
{
    adcgs_page_stream *page;
    uint8_t out[64];
    write_page("change.html", 90000, 1);
    assert_int_equal(adcgs_page_stream_open(&page, in("change.html"), &error), ADCGS_OK);
    assert_int_equal(truncate(in("change.html"), 1000), 0);
    assert_int_equal(adcgs_page_stream_read_at(page, 80000, out, sizeof out), -1);
    adcgs_page_stream_close(&page);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_positions),
        cmocka_unit_test(test_paddings),
        cmocka_unit_test(test_change),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The JSON writer: values, texts, failures. */
#include "config.h" /* for the declarations that it enables in system headers */

#include "second_sources.h"

#include "system/json.h"

#include <setjmp.h>
#include <stdarg.h>
#include <unistd.h>

#include <cmocka.h>

static void write_json(adcgs_json *json, const char *expected)
{
    char text[1024] = {0};
    FILE *file = tmpfile();
    assert_non_null(file);
    assert_int_equal(adcgs_json_write(json, file, "a test", NULL), ADCGS_OK);
    rewind(file);
    assert_true(fread(text, 1, sizeof text - 1, file) > 0);
    fclose(file);
    assert_string_equal(text, expected);
}

static void test_json(void **state)
{
    adcgs_json json;
    adcgs_json_init(&json);
    adcgs_json_open(&json, NULL, '{');
    adcgs_json_string(&json, "s", "a\"\\\n\xc3\xa4");
    adcgs_json_open(&json, "list", '[');
    adcgs_json_int(&json, NULL, -5);
    adcgs_json_real(&json, NULL, 0.5);
    adcgs_json_real(&json, NULL, 30.0);
    adcgs_json_real(&json, NULL, 1.0 / 3.0);
    adcgs_json_real(&json, NULL, -1.0 / 0.0);
    adcgs_json_close(&json);
    adcgs_json_open(&json, "empty", '{');
    adcgs_json_close(&json);
    adcgs_json_bool(&json, "yes", 1);
    adcgs_json_close(&json);
    write_json(&json, "{\n  \"s\": \"a\\\"\\\\\\n\\u00E4\",\n  \"list\": [\n    -5,\n    0.5,\n    30,\n    0.3333333333,\n"
                      "    null\n  ],\n  \"empty\": {},\n  \"yes\": true\n}\n");
}

/* Strings of any bytes give valid JSON without control characters for a terminal. Valid characters survive. */
static void test_json_texts(void **state)
{
    adcgs_json json;
    adcgs_json_init(&json);
    json.is_line = 1;
    adcgs_json_open(&json, NULL, '{');
    adcgs_json_string(&json, "\xff", "\xff\xc0\x80\xed\xa0\x80");
    adcgs_json_string(&json, "\033", "\xc2\x9b\xe2\x80\xae\xf0\x9f\x8e\xa5\t");
    adcgs_json_close(&json);
    write_json(&json, "{\"\\uFFFD\":\"\\uFFFD\\uFFFD\\uFFFD\\uFFFD\\uFFFD\\uFFFD\","
                      "\"\\u001B\":\"\\u009B\\u202E\\uD83C\\uDFA5\\t\"}\n");
}

/* A full disk is an error. Nesting too deep fails, and nothing is written. */
static void test_json_failures(void **state)
{
    adcgs_json json;
    adcgs_error error;
    FILE *full = fopen("/dev/full", "w"), *file = tmpfile();
    assert_non_null(file);
    if (full) {
        adcgs_json_init(&json);
        adcgs_json_open(&json, NULL, '[');
        adcgs_json_close(&json);
        assert_int_equal(adcgs_json_write(&json, full, "full", &error), ADCGS_ERR_IO);
        assert_string_equal(error.text, "full: cannot write: No space left on device");
        fclose(full);
    }
    adcgs_json_init(&json);
    for (int i = 0; i < ADCGS_JSON_DEPTH + 1; i++)
        adcgs_json_open(&json, NULL, '[');
    for (int i = 0; i < ADCGS_JSON_DEPTH + 1; i++)
        adcgs_json_close(&json);
    assert_int_equal(adcgs_json_write(&json, file, "deep", &error), ADCGS_ERR_MEMORY);
    assert_int_equal(ftell(file), 0);
    fclose(file);
}

int adcgs_test_cli_json(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_json),
        cmocka_unit_test(test_json_texts),
        cmocka_unit_test(test_json_failures),
    };
    return cmocka_run_group_tests_name("cli json", tests, NULL, NULL);
}

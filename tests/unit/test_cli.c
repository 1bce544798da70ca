/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Parsing of numbers and options, and the JSON writer. */
#include "cli/cli.h"

#include <getopt.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <unistd.h>

#include <cmocka.h>

static void test_numbers(void **state)
{
    int i = -7, pair[2];
    uint64_t size;
    double real, end;
    assert_true(!adcgs_parse_int("12", 0, 12, &i) && i == 12);
    assert_true(!adcgs_parse_int("-3", -3, 12, &i) && i == -3);
    const char *bad_ints[] = {"", "x", "1x", "13", "-4", "1.0", "99999999999999999999", "0x1"};
    for (size_t n = 0; n < ADCGS_COUNTOF(bad_ints); n++)
        assert_int_equal(adcgs_parse_int(bad_ints[n], -3, 12, &i), -1);
    assert_true(!adcgs_parse_size("200000", 0, UINT64_MAX, &size) && size == 200000);
    assert_true(!adcgs_parse_size("200k", 0, UINT64_MAX, &size) && size == 200000);
    assert_true(!adcgs_parse_size("200KiB", 0, UINT64_MAX, &size) && size == 204800);
    assert_true(!adcgs_parse_size("3m", 0, UINT64_MAX, &size) && size == 3000000);
    assert_true(!adcgs_parse_size("3MiB", 0, UINT64_MAX, &size) && size == 3u << 20);
    assert_true(!adcgs_parse_size("1.5MB", 0, UINT64_MAX, &size) && size == 1500000);
    assert_true(!adcgs_parse_size("1.0625Ki", 0, UINT64_MAX, &size) && size == 1088);
    assert_true(!adcgs_parse_size("1g", 0, UINT64_MAX, &size) && size == 1000000000);
    assert_true(!adcgs_parse_size("1GiB", 0, UINT64_MAX, &size) && size == 1u << 30);
    const char *bad_sizes[] = {"",    "K",    "-1", "+1",  "1KK",    "1T", "18446744074G",  "99999999999999999999", " 1",
                               "1.5", "1.k", ".5k", "1i", "1kiBB", "1B", "1.5.5k", "1 k", "17179869184GiB", "1e5"};
    for (size_t n = 0; n < ADCGS_COUNTOF(bad_sizes); n++)
        assert_int_equal(adcgs_parse_size(bad_sizes[n], 0, UINT64_MAX, &size), -1);
    assert_true(!adcgs_parse_real("1e-3", 0, 1, &real) && real == 1e-3);
    const char *bad_reals[] = {"", "nan", "inf", "1e999", "2", "0.5s"};
    for (size_t n = 0; n < ADCGS_COUNTOF(bad_reals); n++)
        assert_int_equal(adcgs_parse_real(bad_reals[n], 0, 1, &real), -1);
    assert_true(!adcgs_parse_pair("640x480", 1, 1000, pair) && pair[0] == 640 && pair[1] == 480);
    const char *bad_pairs[] = {"", "640", "x", "640x", "x480", "640x480x1", "640x1001", "0x1", "11111111111111111111x1"};
    for (size_t n = 0; n < ADCGS_COUNTOF(bad_pairs); n++)
        assert_int_equal(adcgs_parse_pair(bad_pairs[n], 1, 1000, pair), -1);
    assert_true(!adcgs_parse_times("1.5", &real, &end) && real == 1.5 && end == 1.5);
    assert_true(!adcgs_parse_times("-1:2", &real, &end) && real == -1.0 && end == 2.0);
    const char *bad_times[] = {"", ":", "1:", ":1", "2:1", "1:2:3", "1;2", "nan", "1:inf"};
    for (size_t n = 0; n < ADCGS_COUNTOF(bad_times); n++)
        assert_int_equal(adcgs_parse_times(bad_times[n], &real, &end), -1);
}

typedef struct values {
    const char *text;
    int flag, number, choice, given;
    uint64_t size;
} values;

/** Parse the words after the program's name; standard error goes nowhere. */
static int parse(values *v, const char *const *words, int *first)
{
    static const char *const choices[] = {"red", "green", NULL};
    const adcgs_option options[] = {
        {"flag", 'f', ADCGS_OPTION_FLAG, &v->flag, 0, 0, NULL, "a flag", NULL, NULL},
        {"text", 't', ADCGS_OPTION_STRING, &v->text, 0, 0, "TEXT", "a text", NULL, NULL},
        {"number", 0, ADCGS_OPTION_INT, &v->number, 1, 9, "N", "a number", NULL, &v->given},
        {"size", 's', ADCGS_OPTION_SIZE, &v->size, 1, 1e6, "BYTES", "a size", NULL, NULL},
        {"colour", 0, ADCGS_OPTION_CHOICE, &v->choice, 0, 0, "NAME", "a name", choices, NULL},
    };
    const adcgs_cli cli = {"prog", "FILE", "Does it.", NULL, options, ADCGS_COUNTOF(options), 1, 2};
    static char copies[12][64];
    char *argv[13] = {copies[0]};
    int argc = 1;
    strcpy(copies[0], "prog");
    for (; *words; words++, argc++) {
        snprintf(copies[argc], sizeof copies[0], "%s", *words);
        argv[argc] = copies[argc];
    }
    argv[argc] = NULL;
    optind = 0; /* starts a new scan with GNU and musl, and is harmless elsewhere */
    const int result = adcgs_cli_parse(&cli, argc, argv, first);
    if (result < 0 && strcmp(argv[*first], "file"))
        fail_msg("operand %s", argv[*first]);
    return result;
}

#define PARSE(v, first, ...) parse(v, (const char *const[]){__VA_ARGS__, NULL}, first)

static void test_options(void **state)
{
    values v = {.number = 5, .size = 7};
    int first;
    assert_int_equal(PARSE(&v, &first, "file"), -1);
    assert_true(v.number == 5 && v.size == 7 && !v.flag && !v.given);
    assert_int_equal(PARSE(&v, &first, "file", "-f", "--text=x y", "--number", "9", "-s2K", "--colour", "green"), -1);
    assert_true(v.flag == 1 && v.number == 9 && v.given && v.size == 2000 && v.choice == 1);
    assert_string_equal(v.text, "x y");
    assert_int_equal(PARSE(&v, &first, "-t", "-", "file", "--", "-f"), -1);
    assert_string_equal(v.text, "-");
}

static void test_mistakes(void **state)
{
    values v = {0};
    int first;
    assert_int_equal(PARSE(&v, &first, "--number", "10", "file"), 2);
    assert_int_equal(PARSE(&v, &first, "--number", "file"), 2);
    assert_int_equal(PARSE(&v, &first, "file", "--number"), 2);
    assert_int_equal(PARSE(&v, &first, "file", "--nonsense"), 2);
    assert_int_equal(PARSE(&v, &first, "file", "-x"), 2);
    assert_int_equal(PARSE(&v, &first, "file", "--flag=1"), 2);
    assert_int_equal(PARSE(&v, &first, "file", "--colour", "blue"), 2);
    assert_int_equal(PARSE(&v, &first, "file", "file", "file"), 2);
    assert_int_equal(PARSE(&v, &first, "--flag"), 2);
    assert_int_equal(PARSE(&v, &first, "--help"), 0);
    assert_int_equal(PARSE(&v, &first, "-V"), 0);
}

static void test_json(void **state)
{
    char text[512] = {0};
    adcgs_json json;
    FILE *file = tmpfile();
    assert_non_null(file);
    adcgs_json_init(&json, file);
    adcgs_json_open(&json, NULL, '{');
    adcgs_json_string(&json, "s", "a\"\\\n\xc3\xa4");
    adcgs_json_open(&json, "list", '[');
    adcgs_json_int(&json, NULL, -5);
    adcgs_json_real(&json, NULL, 0.5);
    adcgs_json_real(&json, NULL, -1.0 / 0.0);
    adcgs_json_close(&json, ']');
    adcgs_json_open(&json, "empty", '{');
    adcgs_json_close(&json, '}');
    adcgs_json_bool(&json, "yes", 1);
    adcgs_json_close(&json, '}');
    assert_int_equal(adcgs_json_finish(&json, NULL), ADCGS_OK);
    rewind(file);
    assert_true(fread(text, 1, sizeof text - 1, file) > 0);
    fclose(file);
    assert_string_equal(text, "{\n  \"s\": \"a\\\"\\\\\\u000a\xc3\xa4\",\n  \"list\": [\n    -5,\n    0.5,\n    null\n  ],\n"
                              "  \"empty\": {},\n  \"yes\": true\n}\n");
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_numbers), cmocka_unit_test(test_options),
                                       cmocka_unit_test(test_mistakes), cmocka_unit_test(test_json)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

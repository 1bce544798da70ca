/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Parsing of numbers and options, progress, escaping of text. */
#include "config.h" /* for the declarations that it enables in system headers */

#include "second_sources.h"

#include "cli/cli.h"

#include "system/numbers.h"
#include "system/text.h"

#include <getopt.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

static void test_exit_codes(void **state)
{
    static const int exits[] = {0, 2, 3, 3, 4, 4, 5, 4, 5, 1};
    for (size_t i = 0; i < ADCGS_COUNTOF(exits); i++)
        assert_int_equal(adcgs_exit_code((adcgs_status) - (int)i), exits[i]);
    assert_int_equal(adcgs_exit_code((adcgs_status)7), 1);
}

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
    assert_true(!adcgs_parse_count("20k", 10, 100000, &i) && i == 20000);
    assert_true(!adcgs_parse_count("1.5K", 10, 100000, &i) && i == 1500);
    assert_true(!adcgs_parse_count("1.001k", 10, 100000, &i) && i == 1001);
    assert_true(!adcgs_parse_count("2M", 10, 5000000, &i) && i == 2000000);
    assert_true(!adcgs_parse_count("-3", -3, 12, &i) && i == -3);
    static const char *const bad_counts[] = {"",    "k",    "1.5",  "1.0001k", "20kk", "20 k",
                                             "20m", "0x2k", "200k", "nank",    "--1k", "1e9k"};
    for (size_t n = 0; n < ADCGS_COUNTOF(bad_counts); n++)
        assert_int_equal(adcgs_parse_count(bad_counts[n], -100000, 100000, &i), -1);
    static const struct {
        const char *text;
        double seconds;
    } times[] = {{"2", 2}, {"2s", 2}, {"10m", 600}, {"10min", 600}, {"1.5h", 5400}, {"500ms", 0.5}, {".5s", 0.5}, {"-1s", -1}};
    for (size_t n = 0; n < ADCGS_COUNTOF(times); n++) {
        double got;
        assert_int_equal(adcgs_parse_seconds(times[n].text, -10, 1e4, &got), 0);
        assert_float_equal(got, times[n].seconds, 1e-12);
    }
    static const char *const bad_seconds[] = {"", "s", "2 s", "2d", "2sm", "infs", "nanm", "3h ", "0x1m"};
    for (size_t n = 0; n < ADCGS_COUNTOF(bad_seconds); n++)
        assert_int_equal(adcgs_parse_seconds(bad_seconds[n], 0, 1e4, &(double){0}), -1);
    assert_true(!adcgs_parse_size("200000", 0, UINT64_MAX, &size) && size == 200000);
    assert_true(!adcgs_parse_size("200k", 0, UINT64_MAX, &size) && size == 200000);
    assert_true(!adcgs_parse_size("200KiB", 0, UINT64_MAX, &size) && size == 204800);
    assert_true(!adcgs_parse_size("3m", 0, UINT64_MAX, &size) && size == 3000000);
    assert_true(!adcgs_parse_size("3MiB", 0, UINT64_MAX, &size) && size == 3u << 20);
    assert_true(!adcgs_parse_size("1.5MB", 0, UINT64_MAX, &size) && size == 1500000);
    assert_true(!adcgs_parse_size("1.0625Ki", 0, UINT64_MAX, &size) && size == 1088);
    assert_true(!adcgs_parse_size("1g", 0, UINT64_MAX, &size) && size == 1000000000);
    assert_true(!adcgs_parse_size("1GiB", 0, UINT64_MAX, &size) && size == 1u << 30);
    const char *bad_sizes[] = {"",    "K",   "-1", "+1",    "1KK", "1T",     "18446744074G", "99999999999999999999", " 1", "1.5",
                               "1.k", ".5k", "1i", "1kiBB", "1B",  "1.5.5k", "1 k",          "17179869184GiB",       "1e5"};
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
    assert_true(!adcgs_parse_times("500ms:1m", &real, &end) && real == 0.5 && end == 60.0);
    assert_true(!adcgs_parse_times("-1:2", &real, &end) && real == -1.0 && end == 2.0);
    const char *bad_times[] = {"", ":", "1:", ":1", "2:1", "1:2:3", "1;2", "nan", "1:inf"};
    for (size_t n = 0; n < ADCGS_COUNTOF(bad_times); n++)
        assert_int_equal(adcgs_parse_times(bad_times[n], &real, &end), -1);
}

typedef struct values {
    const char *text;
    int flag, number, choice, given, *quiet;
    uint64_t size;
} values;

/** Parses the words after the program's name; discards standard error. */
static int parse(values *v, const char *const *words, int *first)
{
    static const char *const choices[] = {"red", "green", NULL};
    const adcgs_option options[] = {
        {"flag", 'f', ADCGS_OPTION_FLAG, &v->flag, 0, 0, NULL, "a flag", NULL, NULL},
        {"text", 't', ADCGS_OPTION_STRING, &v->text, 0, 0, "TEXT", "a text", NULL, NULL},
        {"number", 0, ADCGS_OPTION_INT, &v->number, 1, 9, "N", "a number", NULL, &v->given},
        {"size", 's', ADCGS_OPTION_SIZE, &v->size, 1, 1e6, "BYTES", "a size", NULL, NULL},
        {"colour", 0, ADCGS_OPTION_CHOICE, &v->choice, 0, 0, "NAME", "a name", choices, NULL},
        {.letter = 'n', .kind = ADCGS_OPTION_FORMER, .value = "number"},
        {.letter = 'g', .kind = ADCGS_OPTION_FORMER, .value = "flag"},
        {.name = "amount", .letter = 'a', .kind = ADCGS_OPTION_FORMER, .value = "number"},
    };
    const adcgs_cli cli = {.program = "prog",
                           .operands = "FILE",
                           .summary = "Does it.",
                           .options = options,
                           .n_options = ADCGS_COUNTOF(options),
                           .min_operands = 1,
                           .max_operands = 2,
                           .quiet = v->quiet};
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
    v = (values){0};
    assert_int_equal(PARSE(&v, &first, "-gn", "4", "file"), -1); /* former letters */
    assert_true(v.flag == 1 && v.number == 4 && v.given);
    assert_int_equal(PARSE(&v, &first, "--amount=6", "file"), -1);
    assert_int_equal(v.number, 6);
    assert_int_equal(PARSE(&v, &first, "file", "-a7"), -1);
    assert_int_equal(v.number, 7);
    assert_int_equal(PARSE(&v, &first, "-n", "10", "file"), 2);
    int quiet = 0;
    assert_int_equal(PARSE(&v, &first, "-q", "file"), 2); /* only programs with this option accept it */
    v.quiet = &quiet;
    assert_int_equal(PARSE(&v, &first, "file"), -1);
    assert_false(quiet);
    assert_int_equal(PARSE(&v, &first, "file", "-q"), -1);
    assert_true(quiet);
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

/** Captures the function's output on standard error, which then is no terminal. */
static void catch_stderr(char text[512], void (*print)(const adcgs_cli *cli), const adcgs_cli *cli)
{
    FILE *file = tmpfile();
    const int saved = dup(STDERR_FILENO);
    assert_true(file && saved >= 0);
    fflush(stderr);
    assert_true(dup2(fileno(file), STDERR_FILENO) >= 0);
    print(cli);
    fflush(stderr);
    assert_true(dup2(saved, STDERR_FILENO) >= 0);
    close(saved);
    rewind(file);
    text[fread(text, 1, 511, file)] = 0;
    fclose(file);
}

static void show_progress(const adcgs_cli *cli)
{
    adcgs_progress progress;
    adcgs_progress_init(&progress, cli);
    adcgs_progress_show(&progress, "too early");
    assert_true(progress.every >= 5.0 && progress.every <= 10.0);
    progress.last -= progress.every;
    adcgs_progress_show(&progress, "step %d\033", 1);
    adcgs_progress_show(&progress, "too early");
    progress.last -= progress.every;
    adcgs_progress_show(&progress, "step %d", 2);
    for (int i = 0; i < 10; i++) {
        progress.last -= progress.every;
        adcgs_progress_show(&progress, "more");
    }
    assert_true(*cli->quiet || progress.every + progress.grace == 30.0); /* the interval grows, but only up to a limit */
    adcgs_progress_clear(&progress);
    adcgs_cli_note(cli, "done");
}

static void rest(double seconds)
{
    const struct timespec time = {.tv_sec = (time_t)seconds, .tv_nsec = (long)(1e9 * (seconds - floor(seconds)))};
    nanosleep(&time, NULL);
}

/** Kept progress prints its age if no new one comes in time, and nothing after the progress is cleared. */
static void keep_progress(const adcgs_cli *cli)
{
    adcgs_progress progress;
    adcgs_progress_init(&progress, cli);
    progress.last = adcgs_seconds();
    progress.every = 0.05;
    progress.grace = 0.05;
    adcgs_progress_keep(&progress);
    rest(0.15);
    adcgs_progress_show(&progress, "step %d", 1);
    rest(1.0);
    adcgs_progress_clear(&progress);
    rest(0.3);
    adcgs_progress_end(&progress);
    adcgs_progress_end(&progress);
    adcgs_cli_note(cli, "done");
}

/** Long work without a count. */
static void keep_working(const adcgs_cli *cli)
{
    adcgs_progress progress;
    adcgs_progress_init(&progress, cli);
    progress.last = adcgs_seconds();
    progress.every = 0.05;
    progress.grace = 0.05;
    adcgs_progress_keep(&progress);
    adcgs_progress_show(&progress, "finding where things are ...");
    rest(1.0);
    adcgs_progress_end(&progress);
}

/* Without a terminal, a plain line appears now and then; with --quiet, only errors. */
static void test_progress(void **state)
{
    int quiet = 0;
    char text[512];
    const adcgs_cli cli = {.program = "prog", .quiet = &quiet};
    catch_stderr(text, show_progress, &cli);
    assert_string_equal(text, "prog: step 1\\x1b\nprog: step 2\n"
                              "prog: more\nprog: more\nprog: more\nprog: more\nprog: more\nprog: more\nprog: more\nprog: more\n"
                              "prog: more\nprog: more\nprog: done\n");
    quiet = 1;
    catch_stderr(text, show_progress, &cli);
    assert_string_equal(text, "");
    catch_stderr(text, keep_progress, &cli);
    assert_string_equal(text, "");
    quiet = 0;
    catch_stderr(text, keep_progress, &cli);
    const char *const at = strstr(text, "prog: step 1 (0 s ago)\n");
    assert_true(at && (at == text || !strncmp(text, "prog: step 1\n", 13)));
    assert_non_null(strstr(text, "ago)\nprog: done\n"));
    catch_stderr(text, keep_working, &cli);
    assert_non_null(strstr(text, "prog: finding where things are, 0 s\n"));
    assert_null(strstr(text, "ago"));
}

/* Invalid UTF-8 by Unicode's table 3-7: lone and missing continuations, overlong forms, surrogates, beyond the end. */
static void test_utf8(void **state)
{
    static const char *const bad[] = {"\x80",
                                      "\xbf",
                                      "\xc3",
                                      "\xc3(",
                                      "\xc0\x80",
                                      "\xc1\xbf",
                                      "\xe0\x9f\xbf",
                                      "\xe2\x82",
                                      "\xe2(\x82",
                                      "\xed\xa0\x80",
                                      "\xed\xbf\xbf",
                                      "\xf0\x8f\xbf\xbf",
                                      "\xf4\x90\x80\x80",
                                      "\xf5\x80\x80\x80",
                                      "\xf8\x88\x80\x80\x80",
                                      "\xfe",
                                      "\xff",
                                      ""};
    static const struct {
        const char *text;
        int bytes;
        uint32_t code;
    } good[] = {{"A", 1, 'A'},
                {"\x7f", 1, 0x7f},
                {"\xc2\x80", 2, 0x80},
                {"\xdf\xbf", 2, 0x7ff},
                {"\xe0\xa0\x80", 3, 0x800},
                {"\xed\x9f\xbf", 3, 0xd7ff},
                {"\xee\x80\x80", 3, 0xe000},
                {"\xef\xbf\xbf", 3, 0xffff},
                {"\xf0\x90\x80\x80", 4, 0x10000},
                {"\xf4\x8f\xbf\xbf", 4, 0x10ffff}};
    uint32_t code = 0;
    for (size_t i = 0; i < ADCGS_COUNTOF(bad); i++)
        assert_int_equal(adcgs_utf8_next(bad[i], &code), 0);
    for (size_t i = 0; i < ADCGS_COUNTOF(good); i++) {
        assert_int_equal(adcgs_utf8_next(good[i].text, &code), good[i].bytes);
        assert_int_equal(code, good[i].code);
    }
    char *mended = adcgs_text_utf8("a\xff\xc3\xa4\xed\xa0\x80z");
    assert_string_equal(mended, "a\xef\xbf\xbd\xc3\xa4\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbdz");
    free(mended);
}

/* No control character of any text reaches a terminal; all other characters are unchanged. */
static void test_shown(void **state)
{
    static const struct {
        const char *text, *shown, *cell;
        int columns;
    } cases[] = {{"plain \xc3\xa4\xe6\xbc\xa2", "plain \xc3\xa4\xe6\xbc\xa2", "plain \xc3\xa4\xe6\xbc\xa2", 8},
                 {"\033[2J\a", "\\x1b[2J\\x07", "\\x1b[2J\\x07", 11},
                 {"a\r\nb\tc", "a\\x0d\\x0ab\\x09c", "a\\x0d\\x0ab\\x09c", 15},
                 {"\xc2\x9b"
                  "2J\x7f",
                  "\\u{9b}2J\\x7f", "\\u{9b}2J\\x7f", 12},
                 {"gnp.\xe2\x80\xae"
                  "exe",
                  "gnp.\\u{202e}exe", "gnp.\\u{202e}exe", 15},
                 {"\xe2\x81\xa6\xe2\x80\xa8\xf3\xa0\x81\x81", "\\u{2066}\\u{2028}\\u{e0041}", "\\u{2066}\\u{2028}\\u{e0041}", 25},
                 {"\x9b"
                  "2J\xff",
                  "\\x9b2J\\xff", "\\x9b2J\\xff", 10},
                 {"=1+2", "=1+2", "'=1+2", 4},
                 {"@x", "@x", "'@x", 2},
                 {"+1,2", "+1,2", "\"'+1,2\"", 4},
                 {"-a\"b", "-a\"b", "\"'-a\"\"b\"", 4},
                 {"\t=1", "\\x09=1", "\\x09=1", 6},
                 {"", "", "", 0}};
    for (size_t i = 0; i < ADCGS_COUNTOF(cases); i++) {
        char text[100] = {0};
        FILE *file = tmpfile();
        assert_non_null(file);
        assert_int_equal(adcgs_text_show(file, cases[i].text), cases[i].columns);
        fputc('|', file);
        adcgs_text_cell(file, cases[i].text);
        rewind(file);
        assert_true(fread(text, 1, sizeof text - 1, file) > 0);
        fclose(file);
        const char *cell = strrchr(text, '|');
        assert_memory_equal(text, cases[i].shown, strlen(cases[i].shown));
        assert_int_equal(cell - text, strlen(cases[i].shown));
        assert_string_equal(cell + 1, cases[i].cell);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_exit_codes), cmocka_unit_test(test_numbers),  cmocka_unit_test(test_options),
        cmocka_unit_test(test_mistakes),   cmocka_unit_test(test_progress), cmocka_unit_test(test_utf8),
        cmocka_unit_test(test_shown),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    failed += adcgs_test_cli_json();
    return failed;
}

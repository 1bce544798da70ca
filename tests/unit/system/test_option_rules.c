/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Rules for options that go together: each relation, its message, and the order of the checks. */
#include "config.h" /* for open_memstream() */

#include "cli/cli.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

static const adcgs_option_rule rules[] = {
    {"alone", ADCGS_OPTION_GOES_WITH, NULL},
    {"one,two,three", ADCGS_OPTION_APART, NULL},
    {"one,four", ADCGS_OPTION_EXCLUDES, "five,six,seven"},
    {"five", ADCGS_OPTION_NEEDS, "six,seven"},
    {"two", ADCGS_OPTION_GOES_WITH, "six,seven"},
};

/** Parses a command line of words between blanks, with a table of rules. Returns as adcgs_cli_parse(); text: its message. */
static int parse(const char *line, const adcgs_option_rule *table, size_t n, char text[256])
{
    int flag, number;
    const adcgs_option options[] = {
        {"alone", 'a', ADCGS_OPTION_FLAG, &flag, 0, 0, NULL, "a", NULL, NULL},
        {"one", '1', ADCGS_OPTION_FLAG, &flag, 0, 0, NULL, "a", NULL, NULL},
        {"two", 0, ADCGS_OPTION_FLAG, &flag, 0, 0, NULL, "a", NULL, NULL},
        {"three", 0, ADCGS_OPTION_INT, &number, 0, 9, "N", "a", NULL, NULL},
        {"four", 0, ADCGS_OPTION_FLAG, &flag, 0, 0, NULL, "a", NULL, NULL},
        {"five", 0, ADCGS_OPTION_FLAG, &flag, 0, 0, NULL, "a", NULL, NULL},
        {"six", 0, ADCGS_OPTION_FLAG, &flag, 0, 0, NULL, "a", NULL, NULL},
        {"seven", 0, ADCGS_OPTION_FLAG, &flag, 0, 0, NULL, "a", NULL, NULL},
        {.name = "first", .kind = ADCGS_OPTION_FORMER, .value = "one"},
    };
    int quiet = 1, first;
    const adcgs_cli cli = {.program = "prog",
                           .operands = "FILE",
                           .options = options,
                           .n_options = ADCGS_COUNTOF(options),
                           .rules = table,
                           .n_rules = n,
                           .max_operands = 1,
                           .quiet = &quiet};
    char words[128], *argv[12] = {"prog"};
    int argc = 1, pipes[2];
    strcpy(words, line);
    for (char *word = strtok(words, " "); word; word = strtok(NULL, " "))
        argv[argc++] = word;
    fflush(stderr);
    const int kept = dup(STDERR_FILENO);
    assert_true(kept >= 0 && !pipe(pipes) && dup2(pipes[1], STDERR_FILENO) >= 0);
    close(pipes[1]);
    const int code = adcgs_cli_parse(&cli, argc, argv, &first);
    fflush(stderr);
    assert_true(dup2(kept, STDERR_FILENO) >= 0);
    close(kept);
    const ssize_t bytes = read(pipes[0], text, 255);
    text[bytes > 0 ? bytes : 0] = '\0';
    close(pipes[0]);
    return code;
}

static void expect(const char *line, const char *message)
{
    char text[256];
    const int code = parse(line, rules, ADCGS_COUNTOF(rules), text);
    if (code != (*message ? 2 : -1) || !strstr(text, message) || (!*message && *text))
        fail_msg("'%s': %d, '%s', expected '%s'", line, code, text, message);
}

static void each_relation_is_checked(void **state)
{
    expect("", "");
    expect("--alone", "");
    expect("file --alone", "");
    expect("--alone --six", "prog: --alone excludes other options\n");
    expect("--one --two", "prog: --one, --two and --three exclude each other\n");
    expect("--three 0 --two", "--one, --two and --three exclude each other");
    expect("--one --one", "");
    expect("--four --five --six", "prog: --one and --four exclude --five, --six and --seven\n");
    expect("--one --four", "");
    expect("--five", "prog: --five needs --six or --seven\n");
    expect("--five --seven", "");
    expect("--two --six --seven", "");
    expect("--two --four", "prog: --two goes with --six and --seven only\n");
}

/** Letters and former names count as their options, and of several broken rules the first is reported. */
static void all_names_count(void **state)
{
    expect("-1 --two", "exclude each other");
    expect("--first --two", "exclude each other");
    expect("--first", "");
    expect("-a --one --two", "--alone excludes other options");
    expect("--four --five", "--one and --four exclude");
    expect("--two --five file other", "--five needs"); /* before the operands */
}

/** Leaves a child at once: a sanitizer's search for leaks at exit does not end in a child of fork(). */
static void leave(void)
{
    _exit(1);
}

/** A rule for an option that does not exist ends the program, with any command line. */
static void unknown_names_are_defects(void **state)
{
    static const adcgs_option_rule wrong[] = {{"one,two", ADCGS_OPTION_APART, NULL}, {"one", ADCGS_OPTION_NEEDS, "si"}};
    char text[256];
    int status;
    const pid_t child = fork();
    assert_true(child >= 0);
    if (!child) {
        if (!freopen("/dev/null", "w", stderr) || atexit(leave))
            _exit(9);
        parse("", wrong, ADCGS_COUNTOF(wrong), text);
        _exit(0);
    }
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_relation_is_checked),
        cmocka_unit_test(all_names_count),
        cmocka_unit_test(unknown_names_are_defects),
    };
    return cmocka_run_group_tests_name("option rules", tests, NULL, NULL);
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Options: parsing, help and messages. */
#include "config.h"

#include "cli/cli.h"

#include "cli/completion.h"
#include "cli/option_rules.h"
#include "system/flush.h"
#include "system/numbers.h"
#include "system/text.h"

#include <adcgs/version.h>

#include <errno.h>
#include <getopt.h>
#include <limits.h>
#include <math.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define HELP_COLUMN 28   /* column of the options' descriptions */
#define MESSAGE_MAX 8192 /* bytes of a message */

static void message(const adcgs_cli *cli, const char *format, va_list arguments) ADCGS_PRINTF(2, 0);
static void message(const adcgs_cli *cli, const char *format, va_list arguments)
{
    char text[MESSAGE_MAX], *line = NULL;
    size_t bytes = 0;
    vsnprintf(text, sizeof text, format, arguments);
    FILE *memory = open_memstream(&line, &bytes); /* written at once, since lines of several processes may interleave */
    FILE *file = memory ? memory : stderr;
    fprintf(file, "%s: ", cli->program);
    adcgs_text_show(file, text);
    fputc('\n', file);
    if (memory && !fclose(memory))
        fwrite(line, 1, bytes, stderr);
    free(line);
}

int adcgs_cli_error(const adcgs_cli *cli, adcgs_status status, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    message(cli, format, arguments);
    va_end(arguments);
    return adcgs_exit_code(status);
}

void adcgs_cli_note(const adcgs_cli *cli, const char *format, ...)
{
    va_list arguments;
    if (cli->quiet && *cli->quiet)
        return;
    va_start(arguments, format);
    message(cli, format, arguments);
    va_end(arguments);
}

int adcgs_cli_fail(const adcgs_cli *cli, const adcgs_error *error)
{
    return adcgs_cli_error(cli, error->status, "%s", error->text[0] ? error->text : adcgs_status_name(error->status));
}

adcgs_status adcgs_cli_flush(adcgs_error *error)
{
    int reason = adcgs_file_flush(stdout);
    const int copy = reason ? -1 : dup(STDOUT_FILENO);
    if (copy >= 0 && close(copy)) /* some file systems report errors only then */
        reason = errno;
    return reason ? adcgs_fail(error, ADCGS_ERR_IO, "standard output: cannot write: %s", strerror(reason)) : ADCGS_OK;
}

int adcgs_cli_leave(const adcgs_cli *cli, int code)
{
    adcgs_error error;
    return adcgs_cli_flush(&error) == ADCGS_OK || code > 1 ? code : adcgs_cli_fail(cli, &error);
}

static int parse_choice(const adcgs_option *option, const char *text)
{
    for (int i = 0; option->choices[i]; i++)
        if (!strcmp(option->choices[i], text)) {
            *(int *)option->target = i;
            return 0;
        }
    return -1;
}

static int option_set(const adcgs_option *option, const char *text)
{
    if (option->given)
        *option->given = 1;
    switch (option->kind) {
    case ADCGS_OPTION_FLAG:
        *(int *)option->target = 1;
        return 0;
    case ADCGS_OPTION_STRING:
    case ADCGS_OPTION_FILE:
        *(const char **)option->target = text;
        return 0;
    case ADCGS_OPTION_INT:
        return adcgs_parse_count(text, (int)option->min, (int)option->max, option->target);
    case ADCGS_OPTION_SIZE:
        return adcgs_parse_size(text, (uint64_t)option->min, (uint64_t)option->max, option->target);
    case ADCGS_OPTION_REAL:
        return adcgs_parse_real(text, option->min, option->max, option->target);
    case ADCGS_OPTION_SECONDS:
        return adcgs_parse_seconds(text, option->min, option->max, option->target);
    case ADCGS_OPTION_PAIR:
        return adcgs_parse_pair(text, (int)option->min, (int)option->max, option->target);
    case ADCGS_OPTION_CHOICE:
        return parse_choice(option, text);
    case ADCGS_OPTION_FORMER: /* never passed here */
        break;
    }
    return -1;
}

/** Describe the valid values, for the message about a wrong one. */
static void describe(const adcgs_option *option, char *text, size_t size)
{
    switch (option->kind) {
    case ADCGS_OPTION_INT:
        snprintf(text, size, "a whole number from %.0f to %.0f%s", option->min, option->max,
                 option->max >= 1000 ? ", suffix k or M allowed" : "");
        break;
    case ADCGS_OPTION_SIZE:
        snprintf(text, size, "a whole number from %.0f to %.0f, suffix k, M, G, KiB, MiB or GiB allowed", option->min,
                 option->max);
        break;
    case ADCGS_OPTION_REAL:
        snprintf(text, size, "a number from %g to %g", option->min, option->max);
        break;
    case ADCGS_OPTION_SECONDS:
        snprintf(text, size, "seconds from %g to %g, suffix ms, s, m or h allowed", option->min, option->max);
        break;
    case ADCGS_OPTION_PAIR:
        snprintf(text, size, "WIDTHxHEIGHT, each from %.0f to %.0f", option->min, option->max);
        break;
    case ADCGS_OPTION_CHOICE: {
        size_t used = (size_t)snprintf(text, size, "one of");
        for (int i = 0; option->choices[i] && used < size; i++)
            used += (size_t)snprintf(text + used, size - used, "%s %s", i ? "," : "", option->choices[i]);
        break;
    }
    default:
        snprintf(text, size, "a value");
    }
}

/** The option itself; for a former name, the option of the present name, which must exist. */
static const adcgs_option *present_option(const adcgs_cli *cli, const adcgs_option *option)
{
    const adcgs_option *now = cli->options;
    if (option->kind != ADCGS_OPTION_FORMER)
        return option;
    while (!now->name || strcmp(now->name, option->value) != 0)
        now++;
    return now;
}

/** Report a former name or letter. */
static void note_former(const adcgs_cli *cli, const adcgs_option *given, const adcgs_option *now)
{
    const char letter[] = {'-', now->letter, ',', ' ', 0};
    if (given->name)
        adcgs_cli_note(cli, "--%s is now called --%s; the next release drops the former name", given->name, now->name);
    else
        adcgs_cli_note(cli, "-%c is now %s--%s; the next release drops the former letter", given->letter,
                       now->letter ? letter : "", now->name);
}

static int option_wrong(const adcgs_cli *cli, const adcgs_option *option, const char *text)
{
    char expected[200];
    describe(option, expected, sizeof expected);
    return adcgs_cli_error(cli, ADCGS_ERR_USAGE, "--%s %s: expected %s", option->name, text, expected);
}

static void print_option(char letter, const char *name, const char *value, const char *help)
{
    int width = letter ? printf("  -%c, --%s", letter, name) : printf("      --%s", name);
    if (value)
        width += printf(" %s", value);
    if (width > HELP_COLUMN - 2) {
        putchar('\n');
        width = 0;
    }
    for (const char *line = help; line;) {
        const char *end = strchr(line, '\n');
        const int length = end ? (int)(end - line) : (int)strlen(line);
        printf("%*s%.*s\n", HELP_COLUMN - width, "", length, line);
        width = 0;
        line = end ? end + 1 : NULL;
    }
}

static int print_help(const adcgs_cli *cli)
{
    printf("Usage: %s [options] %s\n%s\n\nOptions:\n", cli->program, cli->operands, cli->summary);
    for (size_t i = 0; i < cli->n_options; i++) {
        const adcgs_option *option = &cli->options[i];
        if (option->kind != ADCGS_OPTION_FORMER)
            print_option(option->letter, option->name, option->value, option->help);
    }
    if (cli->quiet)
        print_option('q', "quiet", NULL, "print neither progress nor remarks");
    print_option('h', "help", NULL, "print this text and exit");
    print_option('V', "version", NULL, "print versions and exit");
    if (cli->details)
        printf("\n%s\n", cli->details);
    return adcgs_cli_leave(cli, 0);
}

static int print_version(const adcgs_cli *cli)
{
    printf("%s %s (library %s, bitstream %d.%d)\n", cli->program, PACKAGE_VERSION, adcgs_version_string(), ADCGS_BITSTREAM_MAJOR,
           ADCGS_BITSTREAM_MINOR);
    return adcgs_cli_leave(cli, 0);
}

void adcgs_options_add(adcgs_option_table *table, const adcgs_option *group, size_t n)
{
    if (n > ADCGS_OPTIONS_MAX - table->n) {
        fprintf(stderr, "option --%s: more than %d options: raise ADCGS_OPTIONS_MAX\n", group->name, ADCGS_OPTIONS_MAX);
        exit(1);
    }
    memcpy(table->rows + table->n, group, n * sizeof *group);
    table->n += n;
}

/** Make getopt_long()'s two tables from ours. Codes above UCHAR_MAX are options without a letter. */
static void getopt_tables(const adcgs_cli *cli, struct option *longs, char *letters)
{
    size_t n = 0;
    *letters++ = ':'; /* reports a missing value as ':' */
    for (size_t i = 0; i < ADCGS_MIN(cli->n_options, (size_t)ADCGS_OPTIONS_MAX); i++) {
        const adcgs_option *option = &cli->options[i];
        const int takes = present_option(cli, option)->kind != ADCGS_OPTION_FLAG;
        if (option->name)
            longs[n++] = (struct option){option->name, takes ? required_argument : no_argument, NULL, UCHAR_MAX + 1 + (int)i};
        if (option->letter) {
            *letters++ = option->letter;
            if (takes)
                *letters++ = ':';
        }
    }
    longs[n] = (struct option){"help", no_argument, NULL, 'h'};
    longs[n + 1] = (struct option){"version", no_argument, NULL, 'V'};
    longs[n + 2] = (struct option){cli->quiet ? "quiet" : NULL, no_argument, NULL, 'q'};
    longs[n + 3] = (struct option){NULL, 0, NULL, 0};
    memcpy(letters, cli->quiet ? "hVq" : "hV", cli->quiet ? 4 : 3);
}

static const adcgs_option *find_option(const adcgs_cli *cli, int code)
{
    if (code > UCHAR_MAX)
        return &cli->options[code - UCHAR_MAX - 1];
    for (size_t i = 0; i < cli->n_options; i++)
        if (cli->options[i].letter == code)
            return &cli->options[i];
    return NULL;
}

/** Report a '?' of getopt_long(). optopt is an unknown letter, a code of our table, or 0. */
static int wrong_option(const adcgs_cli *cli, const char *word)
{
    if (optopt > UCHAR_MAX || (optopt && !strncmp(word, "--", 2)))
        return adcgs_cli_error(cli, ADCGS_ERR_USAGE, "%s: the option takes no value", word);
    if (optopt)
        return adcgs_cli_error(cli, ADCGS_ERR_USAGE, "-%c: unknown option; try '%s --help'", optopt, cli->program);
    return adcgs_cli_error(cli, ADCGS_ERR_USAGE, "%s: unknown option; try '%s --help'", word, cli->program);
}

static int check_operands(const adcgs_cli *cli, int n, const char *surplus)
{
    if (n < cli->min_operands)
        return adcgs_cli_error(cli, ADCGS_ERR_USAGE, "expected %s; try '%s --help'", cli->operands, cli->program);
    if (n > cli->max_operands)
        return adcgs_cli_error(cli, ADCGS_ERR_USAGE, "%s: one operand too many; try '%s --help'", surplus, cli->program);
    return -1;
}

int adcgs_cli_parse(const adcgs_cli *cli, int argc, char **argv, int *first)
{
    struct option longs[ADCGS_OPTIONS_MAX + 4];
    char letters[2 * ADCGS_OPTIONS_MAX + 5], broken[ADCGS_RULE_TEXT];
    uint8_t is_given[ADCGS_OPTIONS_MAX] = {0};
    getopt_tables(cli, longs, letters);
    opterr = 0;
    optind = 0; /* restarts the scan, with GNU and musl: a program may parse two command lines */
    if (argc == 2 && !strcmp(argv[1], "--completion")) {
        adcgs_cli_print_completion(cli);
        return adcgs_cli_leave(cli, 0);
    }
    signal(SIGXFSZ, SIG_IGN); /* exceeding the file size limit is an error like a full disk, not the end of the program */
    for (int code; (code = getopt_long(argc, argv, letters, longs, NULL)) != -1;) {
        if (code == 'h')
            return print_help(cli);
        if (code == 'V')
            return print_version(cli);
        if (code == 'q' && cli->quiet) {
            *cli->quiet = 1;
            continue;
        }
        const char *word = argv[ADCGS_MAX(optind - 1, 1)];
        if (code == ':')
            return adcgs_cli_error(cli, ADCGS_ERR_USAGE, "%s: a value must follow", word);
        if (code == '?')
            return wrong_option(cli, word);
        const adcgs_option *const given = find_option(cli, code), *const option = present_option(cli, given);
        if (given != option)
            note_former(cli, given, option);
        if (option_set(option, optarg))
            return option_wrong(cli, option, optarg);
        is_given[option - cli->options] = 1;
    }
    *first = optind;
    if (adcgs_option_rules_check(cli, is_given, broken))
        return adcgs_cli_error(cli, ADCGS_ERR_USAGE, "%s", broken);
    return check_operands(cli, argc - optind, argc - optind > cli->max_operands ? argv[optind + cli->max_operands] : "");
}

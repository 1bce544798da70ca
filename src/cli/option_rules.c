/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Checks of the rules for options that go together. */
#include "cli/option_rules.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LIST_MAX 400 /* bytes of a list of options in a message; chosen by hand, not measured */

/** Returns the next name of a list and its length, and moves *list behind it; NULL at the end. */
static const char *next_name(const char **list, size_t *length)
{
    const char *const name = *list;
    if (!name || !*name)
        return NULL;
    *length = strcspn(name, ",");
    *list += *length + (name[*length] == ',');
    return name;
}

/** Index of the option of a name. A table that lacks it is a defect of the program, which then ends with exit status 1. */
static size_t index_of(const adcgs_cli *cli, const char *name, size_t length)
{
    for (size_t i = 0; i < cli->n_options; i++) {
        const adcgs_option *const o = &cli->options[i];
        if (o->kind != ADCGS_OPTION_FORMER && strlen(o->name) == length && !memcmp(o->name, name, length))
            return i;
    }
    fprintf(stderr, "a rule for options names --%.*s, which is no option\n", (int)length, name);
    exit(1);
}

/** Number of given options in a list. */
static int count_given(const adcgs_cli *cli, const char *list, const uint8_t *given)
{
    size_t length;
    int n = 0;
    for (const char *name; (name = next_name(&list, &length));)
        n += given[index_of(cli, name, length)];
    return n;
}

/** Number of given options of all. */
static int count_all(const adcgs_cli *cli, const uint8_t *given)
{
    int n = 0;
    for (size_t i = 0; i < cli->n_options; i++)
        n += given[i];
    return n;
}

/** Prints "--a, --b and --c", with "or" for "and" if asked to. Returns text. */
static const char *print_list(char text[LIST_MAX], const char *list, const char *word)
{
    size_t length, n = 0;
    text[0] = '\0';
    for (const char *name, *first = list; (name = next_name(&list, &length)) && n < LIST_MAX;) {
        const char *const before = name == first ? "" : *list ? ", " : word;
        n += (size_t)snprintf(text + n, LIST_MAX - n, "%s--%.*s", before, (int)length, name);
    }
    return text;
}

static int is_broken(const adcgs_cli *cli, const adcgs_option_rule *rule, const uint8_t *given)
{
    const int options = count_given(cli, rule->options, given), others = count_given(cli, rule->others, given);
    switch (rule->relation) {
    case ADCGS_OPTION_EXCLUDES:
        return options && others;
    case ADCGS_OPTION_APART:
        return options > 1;
    case ADCGS_OPTION_NEEDS:
        return options && !others;
    case ADCGS_OPTION_GOES_WITH:
        return options && count_all(cli, given) > options + others;
    }
    return 0;
}

static void format(const adcgs_option_rule *rule, char text[ADCGS_RULE_TEXT])
{
    const char *const s = strchr(rule->options, ',') ? "" : "s";
    char options[LIST_MAX], others[LIST_MAX];
    print_list(options, rule->options, " and ");
    print_list(others, rule->others, rule->relation == ADCGS_OPTION_NEEDS ? " or " : " and ");
    switch (rule->relation) {
    case ADCGS_OPTION_EXCLUDES:
        snprintf(text, ADCGS_RULE_TEXT, "%s exclude%s %s", options, s, others);
        break;
    case ADCGS_OPTION_APART:
        snprintf(text, ADCGS_RULE_TEXT, "%s exclude each other", options);
        break;
    case ADCGS_OPTION_NEEDS:
        snprintf(text, ADCGS_RULE_TEXT, "%s need%s %s", options, s, others);
        break;
    case ADCGS_OPTION_GOES_WITH:
        if (rule->others)
            snprintf(text, ADCGS_RULE_TEXT, "%s %s with %s only", options, *s ? "goes" : "go", others);
        else
            snprintf(text, ADCGS_RULE_TEXT, "%s exclude%s other options", options, s);
    }
}

int adcgs_option_rules_check(const adcgs_cli *cli, const uint8_t *given, char text[ADCGS_RULE_TEXT])
{
    const adcgs_option_rule *broken = NULL;
    for (size_t i = 0; i < cli->n_rules; i++) /* also behind a broken rule: each names options that exist */
        if (is_broken(cli, &cli->rules[i], given) && !broken)
            broken = &cli->rules[i];
    if (broken)
        format(broken, text);
    return broken != NULL;
}

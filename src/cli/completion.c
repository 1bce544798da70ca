/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The table of options for the shell's completion. */
#include "cli/completion.h"

#include <string.h>

static void print_row(const char *name, char letter, const char *kind, const char *value, const char *const *words,
                      const char *help)
{
    const char letters[3] = {'-', letter, 0};
    printf("%s%s\t%s\t%s\t%s\t", name ? "--" : "-", name ? name : "", letters, kind, value ? value : "-");
    if (!words || !words[0])
        putchar('-');
    for (int i = 0; words && words[i]; i++)
        printf("%s%s", i ? " " : "", words[i]);
    const size_t line = strcspn(help, "\n");
    printf("\t%.*s%s\n", (int)line, help, help[line] ? " ..." : "");
}

void adcgs_cli_print_completion(const adcgs_cli *cli)
{
    for (size_t i = 0; i < cli->n_options; i++) {
        const adcgs_option *option = &cli->options[i];
        if (option->kind == ADCGS_OPTION_FORMER)
            continue;
        const char *kind = option->kind == ADCGS_OPTION_FLAG ? "flag" : option->kind == ADCGS_OPTION_FILE ? "file" : "value";
        print_row(option->name, option->letter, kind, option->value, option->choices, option->help);
    }
    if (cli->quiet)
        print_row("quiet", 'q', "flag", NULL, NULL, "print neither progress nor remarks");
    print_row("help", 'h', "flag", NULL, NULL, "print this text and exit");
    print_row("version", 'V', "flag", NULL, NULL, "print versions and exit");
    print_row(NULL, 0, cli->max_operands && !cli->operand_words ? "file" : "value", NULL, cli->operand_words, cli->operands);
}

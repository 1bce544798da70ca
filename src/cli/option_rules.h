/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The check of the rules for options that go together, for the parser of command lines. */
#ifndef ADCGS_CLI_OPTION_RULES_H
#define ADCGS_CLI_OPTION_RULES_H

#include "cli/cli.h"

/* Bytes of a broken rule in words: two lists of 400 (LIST_MAX in option_rules.c) and a few words between; arithmetic. */
enum { ADCGS_RULE_TEXT = 900 };

/** Returns 1 and a message if a rule is broken, the first one. given: 1 for each option that the command line has. */
int adcgs_option_rules_check(const adcgs_cli *cli, const uint8_t *given, char text[ADCGS_RULE_TEXT]);

#endif

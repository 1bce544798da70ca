/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Recipes: text files, one per vector, of one command per line (README.md
 * describes the language). A recipe that begins with "from" takes over the
 * commands of its base recipe, except title, covers, violates and expect.
 */
#ifndef ADCGS_CONFORMANCE_RECIPE_H
#define ADCGS_CONFORMANCE_RECIPE_H

#include "base/base.h"

#define ADCGS_WORDS 80

typedef struct adcgs_command {
    char *text; /**< the line, cut into words */
    int n;      /**< words; word[0] is the verb */
    char *word[ADCGS_WORDS];
    int inherited; /**< the line is in the base recipe */
    int line;
    int used; /**< a part of the program has handled the command */
} adcgs_command;

typedef struct adcgs_recipe {
    char id[80];
    int n, capacity;
    adcgs_command *command;
} adcgs_recipe;

/** Read DIRECTORY/ID.txt. */
adcgs_status adcgs_recipe_read(adcgs_recipe *out, const char *directory, const char *id, adcgs_error *error);
/** Append a line. */
adcgs_status adcgs_recipe_add(adcgs_recipe *recipe, const char *line, adcgs_error *error);
void adcgs_recipe_clear(adcgs_recipe *recipe);

/** True if the command's verb is this one. */
int adcgs_command_is(const adcgs_command *command, const char *verb);
/** True for title, covers, violates and expect, which a recipe does not take over from its base recipe. */
int adcgs_recipe_is_about(const adcgs_command *command);
/** ADCGS_ERR_USAGE unless lo to hi words follow the verb. */
adcgs_status adcgs_command_words(const adcgs_command *command, int lo, int hi, adcgs_error *error);
/** Put recipe and line in front of a message about a command. */
adcgs_status adcgs_command_locate(const adcgs_recipe *recipe, const adcgs_command *command, adcgs_status status,
                                  adcgs_error *error);

/* Words as numbers: whole words, decimal or hexadecimal, within a range. */
adcgs_status adcgs_word_int(const char *word, int64_t lo, int64_t hi, int64_t *value, adcgs_error *error);
adcgs_status adcgs_word_real(const char *word, double *value, adcgs_error *error);
/** Index of the word among names, which end with NULL. */
adcgs_status adcgs_word_choice(const char *word, const char *const *names, int *value, adcgs_error *error);
/** NAME=VALUE: the value if the name is this one, else NULL. */
const char *adcgs_word_value(const char *word, const char *name);

#endif

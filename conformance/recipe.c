/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Reading recipes. */
#include "config.h"

#include "recipe.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>

#define DEPTH_MAX 4 /* most levels of recipes that begin with another recipe ("from") */

int adcgs_command_is(const adcgs_command *command, const char *verb)
{
    return strcmp(command->word[0], verb) == 0;
}

adcgs_status adcgs_command_words(const adcgs_command *command, int lo, int hi, adcgs_error *error)
{
    if (command->n - 1 >= lo && command->n - 1 <= hi)
        return ADCGS_OK;
    return adcgs_fail(error, ADCGS_ERR_USAGE, "%s takes %d to %d words, not %d", command->word[0], lo, hi, command->n - 1);
}

adcgs_status adcgs_command_locate(const adcgs_recipe *recipe, const adcgs_command *command, adcgs_status status,
                                  adcgs_error *error)
{
    if (status == ADCGS_OK || !error)
        return status;
    const adcgs_error why = *error;
    return adcgs_fail(error, status, "%s, line %d%s: %.160s", recipe->id, command->line,
                      command->inherited ? " of its base recipe" : "", why.text);
}

adcgs_status adcgs_word_int(const char *word, int64_t lo, int64_t hi, int64_t *value, adcgs_error *error)
{
    char *end;
    errno = 0;
    *value = strtoll(word, &end, 0);
    if (end == word || *end || errno || *value < lo || *value > hi)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "\"%s\": expected %lld..%lld", word, (long long)lo, (long long)hi);
    return ADCGS_OK;
}

adcgs_status adcgs_word_real(const char *word, double *value, adcgs_error *error)
{
    char *end;
    *value = strtod(word, &end);
    if (end == word || *end)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "\"%s\": expected a number", word);
    return ADCGS_OK;
}

adcgs_status adcgs_word_choice(const char *word, const char *const *names, int *value, adcgs_error *error)
{
    for (*value = 0; names[*value]; ++*value)
        if (strcmp(word, names[*value]) == 0)
            return ADCGS_OK;
    return adcgs_fail(error, ADCGS_ERR_USAGE, "\"%s\": unknown word", word);
}

const char *adcgs_word_value(const char *word, const char *name)
{
    const size_t n = strlen(name);
    return strncmp(word, name, n) == 0 && word[n] == '=' ? word + n + 1 : NULL;
}

/* Cut a line into words; "..." is one word, # begins a remark. */
static adcgs_status cut_words(adcgs_command *c, adcgs_error *error)
{
    for (char *p = c->text; *p;) {
        if (*p == ' ' || *p == '\n') {
            *p++ = 0;
            continue;
        }
        if (*p == '#')
            break;
        if (c->n == ADCGS_WORDS)
            return adcgs_fail(error, ADCGS_ERR_USAGE, "more than %d words", ADCGS_WORDS);
        const int quoted = *p == '"';
        c->word[c->n++] = p += quoted;
        while (*p && *p != '\n' && (quoted ? *p != '"' : *p != ' '))
            p++;
        if (quoted && *p != '"')
            return adcgs_fail(error, ADCGS_ERR_USAGE, "a word has no closing quote");
        if (*p)
            *p++ = 0;
    }
    return ADCGS_OK;
}

static adcgs_status add_command(adcgs_recipe *r, const char *line, int number, int inherited, adcgs_command **out,
                                adcgs_error *error)
{
    if (r->n == r->capacity) {
        r->capacity = r->capacity ? 2 * r->capacity : 32;
        adcgs_command *const grown = realloc(r->command, (size_t)r->capacity * sizeof *grown);
        if (!grown)
            return adcgs_fail(error, ADCGS_ERR_MEMORY, "no memory for a recipe");
        r->command = grown;
    }
    adcgs_command *const c = *out = &r->command[r->n];
    *c = (adcgs_command){.text = strdup(line), .line = number, .inherited = inherited};
    if (!c->text)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "no memory for a recipe");
    r->n++;
    return cut_words(c, error);
}

int adcgs_recipe_is_about(const adcgs_command *c)
{
    return adcgs_command_is(c, "title") || adcgs_command_is(c, "covers") || adcgs_command_is(c, "violates") ||
           adcgs_command_is(c, "expect");
}

static adcgs_status read_lines(adcgs_recipe *r, const char *directory, const char *id, int depth, adcgs_error *error);

static adcgs_status use_line(adcgs_recipe *r, const char *directory, const char *line, int number, int depth, adcgs_error *error)
{
    adcgs_command *c = NULL;
    ADCGS_TRY(add_command(r, line, number, depth > 0, &c, error));
    if (c->n == 0 || (depth > 0 && adcgs_recipe_is_about(c))) {
        free(c->text);
        r->n--;
        return ADCGS_OK;
    }
    if (!adcgs_command_is(c, "from"))
        return ADCGS_OK;
    char base[sizeof r->id];
    const int known = c->n == 2 && snprintf(base, sizeof base, "%s", c->word[1]) < (int)sizeof base && depth < DEPTH_MAX;
    free(c->text);
    r->n--;
    if (!known)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s, line %d: from takes the name of a recipe", r->id, number);
    return read_lines(r, directory, base, depth + 1, error);
}

static adcgs_status read_lines(adcgs_recipe *r, const char *directory, const char *id, int depth, adcgs_error *error)
{
    char path[4096], line[2048];
    adcgs_status status = ADCGS_OK;
    snprintf(path, sizeof path, "%s/%s.txt", directory, id);
    FILE *const file = fopen(path, "r");
    if (!file)
        return adcgs_fail(error, ADCGS_ERR_IO, "%.160s: cannot open", path);
    for (int number = 1; status == ADCGS_OK && fgets(line, sizeof line, file); number++)
        status = use_line(r, directory, line, number, depth, error);
    fclose(file);
    return status;
}

adcgs_status adcgs_recipe_read(adcgs_recipe *out, const char *directory, const char *id, adcgs_error *error)
{
    *out = (adcgs_recipe){.n = 0};
    if (snprintf(out->id, sizeof out->id, "%s", id) >= (int)sizeof out->id)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%.80s: the name is too long", id);
    return read_lines(out, directory, id, 0, error);
}

adcgs_status adcgs_recipe_add(adcgs_recipe *recipe, const char *line, adcgs_error *error)
{
    adcgs_command *c;
    return add_command(recipe, line, recipe->n + 1, 0, &c, error);
}

void adcgs_recipe_clear(adcgs_recipe *recipe)
{
    while (recipe->n > 0)
        free(recipe->command[--recipe->n].text);
    free(recipe->command);
    *recipe = (adcgs_recipe){.n = 0};
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The axes of a sweep. */
#include "apps/sweep/grid.h"

#include "cli/cli.h"
#include "system/numbers.h"
#include "train/settings.h"

#include <string.h>

#define BLANKS " ;"
#define SECONDS_MAX 1e6 /* seconds of an option, at most; chosen by hand, not measured */

/* ---- Options of the encoder ---- */

static const char *const cpu_names[] = {"auto", "scalar", "avx2", "avx512", NULL};

/** Numbers have a range, names a list. */
static const struct {
    const char *name;
    const char *const *names;
    double min, max;
    int cannot_share; /* runs with it have no common beginning */
} options[] = {
    {"preset", adcgs_train_presets, 0, 0, 0},
    {"time-limit", NULL, 1, SECONDS_MAX, 1},
    {"segment", NULL, 1e-3, SECONDS_MAX, 1},
    {"key", NULL, 0, SECONDS_MAX, 1},
    {"threads", NULL, 1, 256, 0},
    {"cpu", cpu_names, 0, 0, 0},
};

/** Returns the index of an option; -1 if there is no such name. */
static int find_option(const char *name)
{
    for (size_t i = 0; i < ADCGS_COUNTOF(options); i++)
        if (!strcmp(options[i].name, name))
            return (int)i;
    return -1;
}

int adcgs_sweep_axis_is_option(const char *name)
{
    return find_option(name) >= 0;
}

static adcgs_status check_option(int option, const char *value, adcgs_error *error)
{
    const char *const *name = options[option].names;
    const double min = options[option].min, max = options[option].max;
    double number;
    while (name && *name && strcmp(*name, value) != 0)
        name++;
    if (name ? *name != NULL
             : !adcgs_parse_real(value, min, max, &number) ||
                   (max == SECONDS_MAX && !adcgs_parse_seconds(value, min, max, &number)))
        return ADCGS_OK;
    if (name)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s=%s: expected a value that adcgs-enc --help names", options[option].name,
                          value);
    return adcgs_fail(error, ADCGS_ERR_USAGE, "%s=%s: expected a number from %g to %g", options[option].name, value, min, max);
}

/* ---- Parsing ---- */

/** Copies the text; returns 0 if it is empty or too long, or has characters that are unsuitable for file names. */
static int copy_name(char out[ADCGS_SWEEP_NAME], const char *text, size_t length)
{
    static const char fine[] = "abcdefghijklmnopqrstuvwxyz0123456789_.-+E";
    if (!length || length >= ADCGS_SWEEP_NAME || strspn(text, fine) < length)
        return 0;
    memcpy(out, text, length);
    out[length] = '\0';
    return 1;
}

static adcgs_status parse_axis(adcgs_sweep_grid *grid, const char *text, size_t length, adcgs_error *error)
{
    const char *const end = text + length, *const equals = memchr(text, '=', length);
    adcgs_sweep_axis axis = {.n = 0};
    int fine = grid->n < ADCGS_SWEEP_AXES && equals && copy_name(axis.name, text, (size_t)(equals - text));
    for (const char *at = equals; fine && at < end;) {
        const size_t n = strcspn(++at, "," BLANKS);
        fine = axis.n < ADCGS_SWEEP_LIST && copy_name(axis.value[axis.n++], at, n);
        at += n;
    }
    if (!fine)
        return adcgs_fail(error, ADCGS_ERR_USAGE,
                          "--grid: \"%.*s\": expected at most %d of NAME=A,B,C, with at most %d values "
                          "each",
                          (int)length, text, ADCGS_SWEEP_AXES, ADCGS_SWEEP_LIST);
    for (int i = 0; i < grid->n; i++)
        if (!strcmp(grid->axis[i].name, axis.name))
            return adcgs_fail(error, ADCGS_ERR_USAGE, "--grid: %s is given twice", axis.name);
    grid->axis[grid->n++] = axis;
    if (adcgs_sweep_grid_count(grid) > ADCGS_SWEEP_LIST)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "--grid: more than %d choices", ADCGS_SWEEP_LIST);
    return ADCGS_OK;
}

adcgs_status adcgs_sweep_grid_parse(adcgs_sweep_grid *grid, const char *text, adcgs_error *error)
{
    for (text += strspn(text, BLANKS); *text; text += strspn(text, BLANKS)) {
        const size_t length = strcspn(text, BLANKS);
        ADCGS_TRY(parse_axis(grid, text, length, error));
        text += length;
    }
    return ADCGS_OK;
}

/* ---- Choices ---- */

int adcgs_sweep_grid_count(const adcgs_sweep_grid *grid)
{
    int n = 1;
    for (int i = 0; i < grid->n; i++)
        n *= grid->axis[i].n;
    return n;
}

static void append(char choice[ADCGS_SWEEP_CHOICE], const char *name, const char *value)
{
    const size_t at = strlen(choice);
    snprintf(choice + at, ADCGS_SWEEP_CHOICE - at, "%s%s=%s", at ? " " : "", name, value);
}

void adcgs_sweep_grid_choice(char choice[ADCGS_SWEEP_CHOICE], const adcgs_sweep_grid *grid, int index)
{
    int faster = adcgs_sweep_grid_count(grid); /* choices per value of the previous axis */
    choice[0] = '\0';
    for (int i = 0; i < grid->n; i++) {
        faster /= grid->axis[i].n;
        append(choice, grid->axis[i].name, grid->axis[i].value[index / faster % grid->axis[i].n]);
    }
}

const char *adcgs_sweep_choice_next(const char *choice, char name[ADCGS_SWEEP_NAME], char value[ADCGS_SWEEP_NAME])
{
    const size_t n = strcspn(choice, "="), m = strcspn(choice + n, " ");
    if (!choice[n])
        return NULL;
    snprintf(name, ADCGS_SWEEP_NAME, "%.*s", (int)n, choice);
    snprintf(value, ADCGS_SWEEP_NAME, "%.*s", (int)m - 1, choice + n + 1);
    return choice + n + m + strspn(choice + n + m, " ");
}

int adcgs_sweep_choice_find(const char *choice, const char *name, char value[ADCGS_SWEEP_NAME])
{
    char other[ADCGS_SWEEP_NAME];
    while ((choice = adcgs_sweep_choice_next(choice, other, value)))
        if (!strcmp(other, name))
            return 1;
    return 0;
}

void adcgs_sweep_choice_change(char choice[ADCGS_SWEEP_CHOICE], const char *name, const char *value)
{
    char old[ADCGS_SWEEP_CHOICE], other[ADCGS_SWEEP_NAME], kept[ADCGS_SWEEP_NAME];
    memcpy(old, choice, sizeof old);
    choice[0] = '\0';
    for (const char *at = old; (at = adcgs_sweep_choice_next(at, other, kept));)
        if (strcmp(other, name) != 0)
            append(choice, other, kept);
    append(choice, name, value);
}

int adcgs_sweep_choice_shares(const char *choice)
{
    char value[ADCGS_SWEEP_NAME];
    for (size_t i = 0; i < ADCGS_COUNTOF(options); i++)
        if (options[i].cannot_share && adcgs_sweep_choice_find(choice, options[i].name, value))
            return 0;
    return 1;
}

/* ---- Checking ---- */

static adcgs_status check_choice(const char *choice, const char *preset, const char *set, adcgs_error *error)
{
    char name[ADCGS_SWEEP_NAME], value[ADCGS_SWEEP_NAME], own[ADCGS_SWEEP_NAME], text[2 * ADCGS_SWEEP_NAME];
    adcgs_train_config config;
    for (const char *at = choice; (at = adcgs_sweep_choice_next(at, name, value));)
        if (find_option(name) >= 0)
            ADCGS_TRY(check_option(find_option(name), value, error));
    if (adcgs_sweep_choice_find(choice, "preset", own))
        preset = own;
    ADCGS_TRY(adcgs_train_preset(&config, preset ? preset : "fast", error));
    if (set)
        ADCGS_TRY(adcgs_train_set(&config, set, error));
    for (const char *at = choice; (at = adcgs_sweep_choice_next(at, name, value));) {
        snprintf(text, sizeof text, "%s=%s", name, value);
        if (find_option(name) < 0)
            ADCGS_TRY(adcgs_train_set(&config, text, error));
    }
    return adcgs_train_check(&config, error);
}

adcgs_status adcgs_sweep_grid_check(const adcgs_sweep_grid *grid, const char *preset, const char *set, adcgs_error *error)
{
    static const char *const others[] = {"lambda", "seed"};
    for (int i = 0; i < grid->n; i++)
        for (size_t j = 0; j < ADCGS_COUNTOF(others); j++)
            if (!strcmp(grid->axis[i].name, others[j]))
                return adcgs_fail(error, ADCGS_ERR_USAGE, "--grid: give %s by its own option", others[j]);
    for (int i = 0; i < adcgs_sweep_grid_count(grid); i++) {
        char choice[ADCGS_SWEEP_CHOICE];
        adcgs_sweep_grid_choice(choice, grid, i);
        ADCGS_TRY(check_choice(choice, preset, set, error));
    }
    return ADCGS_OK;
}

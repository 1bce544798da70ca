/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Curves of other methods, measured elsewhere on the same scene, from tables. The first line names the columns, in any order;
 * each other line is a point. Unknown columns are ignored. No cell may hold a comma or a quote.
 */
#include "config.h"

#include "apps/sweep/sweep.h"

#include "cli/cli.h"
#include "system/numbers.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>

/* Bytes of a line; columns of a table. Chosen by hand, not measured. */
enum { LINE = 1024, COLUMNS = 32 };

typedef enum column { BYTES, PSNR, SSIM, MOVING, SECONDS, SPEED, SOURCE, OTHER } column;

static const struct {
    const char *name;
    double min, max;
} known[OTHER] = {[BYTES] = {"bytes", 1, 1e15},
                  [PSNR] = {"psnr", -1000, 1000},
                  [SSIM] = {"ssim", -1, 1},
                  [MOVING] = {"dynamic_psnr", -1000, 1000},
                  [SECONDS] = {"cpu_seconds", 0, 1e12},
                  [SPEED] = {"frames_per_second", 0, 1e12},
                  [SOURCE] = {"source", 0, 0}};

typedef struct table {
    const char *path;
    FILE *file;
    int line, n; /* lines read; columns */
    column column[COLUMNS];
    char text[LINE];
} table;

static adcgs_status bad(const table *t, adcgs_error *error, const char *expected)
{
    return adcgs_fail(error, ADCGS_ERR_DATA, "%s: line %d: expected %s", t->path, t->line, expected);
}

/** Reads the next line that is not empty, without its end. *more: 0 if there is none. */
static adcgs_status next_line(table *t, int *more, adcgs_error *error)
{
    while ((*more = fgets(t->text, sizeof t->text, t->file) != NULL)) {
        size_t n = strlen(t->text);
        t->line++;
        if (n + 1 == sizeof t->text && t->text[n - 1] != '\n')
            return bad(t, error, "at most 1000 bytes");
        while (n && isspace((unsigned char)t->text[n - 1]))
            t->text[--n] = '\0';
        if (strchr(t->text, '"'))
            return bad(t, error, "cells without quotes");
        if (n)
            return ADCGS_OK;
    }
    return ferror(t->file) ? adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot be read: %s", t->path, strerror(errno)) : ADCGS_OK;
}

/** Cuts off the line's next cell; NULL after the last. */
static char *next_cell(char **at)
{
    char *const cell = *at;
    if (!cell)
        return NULL;
    char *const comma = strchr(cell, ',');
    *at = comma ? comma + 1 : NULL;
    if (comma)
        *comma = '\0';
    return cell;
}

static adcgs_status read_heading(table *t, adcgs_error *error)
{
    unsigned found = 0;
    int more;
    ADCGS_TRY(next_line(t, &more, error));
    if (!more)
        return bad(t, error, "a line of column names");
    for (char *at = t->text, *cell; (cell = next_cell(&at));) {
        int c = 0;
        while (c < OTHER && strcmp(known[c].name, cell) != 0)
            c++;
        if (t->n == COLUMNS || (c < OTHER && found & 1U << c))
            return bad(t, error, "at most 32 columns, each once");
        found |= 1U << c;
        t->column[t->n++] = (column)c;
    }
    return found & 1U << BYTES && found & 1U << PSNR ? ADCGS_OK : bad(t, error, "columns bytes and psnr");
}

/** Makes a point of the last line; its source goes to the curve's note. */
static adcgs_status read_point(table *t, adcgs_sweep_curve *curve, adcgs_error *error)
{
    double value[OTHER];
    char *at = t->text;
    for (int c = 0; c < OTHER; c++)
        value[c] = (double)NAN;
    for (int i = 0; i < t->n; i++) {
        const char *const cell = next_cell(&at);
        const column c = t->column[i];
        if (!cell)
            return bad(t, error, "as many cells as columns");
        if (c == SOURCE && curve->n == 0)
            snprintf(curve->note + strlen(curve->note), sizeof curve->note - strlen(curve->note), "; %s", cell);
        else if (c < SOURCE && *cell && adcgs_parse_real(cell, known[c].min, known[c].max, &value[c]) != 0)
            return adcgs_fail(error, ADCGS_ERR_DATA, "%s: line %d: %s: expected a number from %g to %g", t->path, t->line,
                              known[c].name, known[c].min, known[c].max);
    }
    if (at)
        return bad(t, error, "at most as many cells as columns");
    if (isnan(value[BYTES]) || isnan(value[PSNR]))
        return bad(t, error, "bytes and psnr");
    if (curve->n == ADCGS_SWEEP_LIST)
        return bad(t, error, "at most 16 points");
    curve->point[curve->n++] = (adcgs_sweep_row){.name = curve->name,
                                                 .lambda = -1,
                                                 .is_stream = 1,
                                                 .bytes = adcgs_spread_one(value[BYTES]),
                                                 .psnr = adcgs_spread_one(value[PSNR]),
                                                 .moving = adcgs_spread_one(value[MOVING]),
                                                 .ssim = adcgs_spread_one(value[SSIM]),
                                                 .seconds = adcgs_spread_one(value[SECONDS]),
                                                 .speed = adcgs_spread_one(value[SPEED]),
                                                 .objective = adcgs_spread_one((double)NAN),
                                                 .networks = (double)NAN};
    return ADCGS_OK;
}

static adcgs_status read_table(table *t, adcgs_sweep_curve *curve, adcgs_error *error)
{
    int more;
    ADCGS_TRY(read_heading(t, error));
    for (;;) {
        ADCGS_TRY(next_line(t, &more, error));
        if (!more)
            return curve->n ? ADCGS_OK : bad(t, error, "a point");
        ADCGS_TRY(read_point(t, curve, error));
    }
}

/** Adds "NAME=FILE". The name goes into gnuplot's quotes and to terminals. */
static adcgs_status add_one(adcgs_sweep_plan *plan, const char *text, size_t length, adcgs_error *error)
{
    char name[sizeof plan->curve->name], note[sizeof plan->curve->note], path[ADCGS_SWEEP_PATH];
    const char *const equals = memchr(text, '=', length);
    const size_t n = equals ? (size_t)(equals - text) : 0;
    if (!n || n >= sizeof name || length - n - 1 >= sizeof path || length == n + 1)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "--add: expected NAME=FILE, with commas between two of them");
    adcgs_sweep_write_name(name, sizeof name, text, n);
    snprintf(path, sizeof path, "%.*s", (int)(length - n - 1), equals + 1);
    snprintf(note, sizeof note, "another method, from %.150s", path);
    if (adcgs_sweep_has_curve(plan, name))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "--add %s: another curve has this name", name);
    table t = {.path = path, .file = fopen(path, "r")};
    if (!t.file)
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot be opened: %s", path, strerror(errno));
    adcgs_sweep_curve *const curve = adcgs_sweep_add_curve(plan, name, note, ADCGS_FIGURE_BYTES, 0);
    curve->earlier = 1;
    const adcgs_status status = read_table(&t, curve, error);
    fclose(t.file);
    return status;
}

adcgs_status adcgs_sweep_add_tables(adcgs_sweep_plan *plan, const char *tables, adcgs_error *error)
{
    const char *at = tables;
    for (int n = 1; at; n++) {
        const size_t length = strcspn(at, ",");
        if (n > ADCGS_SWEEP_AGAINST)
            return adcgs_fail(error, ADCGS_ERR_USAGE, "--add: more than %d tables", ADCGS_SWEEP_AGAINST);
        ADCGS_TRY(add_one(plan, at, length, error));
        at = at[length] ? at + length + 1 : NULL;
    }
    return ADCGS_OK;
}

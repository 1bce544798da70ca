/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The command line of adcgs-sweep, parsed, and as words again. */
#ifndef ADCGS_APPS_SWEEP_SWEEP_OPTIONS_H
#define ADCGS_APPS_SWEEP_SWEEP_OPTIONS_H

#include "apps/sweep/sweep.h"
#include "cli/cli.h"

#define ADCGS_SWEEP_OPTIONS 32 /* options that define a sweep; definition */

/** The options that define a sweep, with their values, without those for its execution. */
typedef struct adcgs_sweep_words {
    int n, n_text;
    struct {
        const char *name, *value; /**< value: NULL for a flag */
    } option[ADCGS_SWEEP_OPTIONS];
    char text[8][16]; /**< numbers */
} adcgs_sweep_words;

typedef struct adcgs_sweep_request {
    adcgs_sweep sweep;
    int jobs, list, quiet;
    const char *run, *collect; /**< tag of the only run; the folder; NULL: neither */
    adcgs_sweep_words words;
} adcgs_sweep_request;

/**
 * Returns -1 to continue, else the exit code. cli belongs to the caller and is filled in. request is zeroed by the caller and
 * must not move.
 */
int adcgs_sweep_parse(adcgs_cli *cli, adcgs_sweep_request *request, int argc, char **argv);
/** Prints the sweep as a line for a shell, without a newline. run: the only run of that line, or NULL. */
void adcgs_sweep_print_line(FILE *file, const char *program, const adcgs_sweep_request *request, const char *run);

#endif

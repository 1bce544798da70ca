/* SPDX-License-Identifier: BSD-2-Clause */
/** \file What adcgs-sweep is asked for: its command line, and the same once more as words. */
#ifndef ADCGS_TOOLS_SWEEP_OPTIONS_H
#define ADCGS_TOOLS_SWEEP_OPTIONS_H

#include "cli/cli.h"
#include "sweep/sweep.h"

#define ADCGS_SWEEP_OPTIONS 32

/** What a sweep consists of, as options and their values: without what says how it is gone through. */
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
    const char *run, *collect; /**< the tag of the only run; the folder; NULL: neither */
    adcgs_sweep_words words;
} adcgs_sweep_request;

/** -1 to go on, else the exit code to leave with. cli: the caller's, to be filled in; request: zeroed, it stays where it is. */
int adcgs_sweep_parse(adcgs_cli *cli, adcgs_sweep_request *request, int argc, char **argv);
/** The sweep as a line for a shell, without its end; run: of which that is the only one, or NULL. */
void adcgs_sweep_print_line(FILE *file, const char *program, const adcgs_sweep_request *request, const char *run);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A command line under construction, for a run of a sweep. */
#ifndef ADCGS_SWEEP_COMMAND_H
#define ADCGS_SWEEP_COMMAND_H

#include "sweep/sweep.h"

/** Numbers and what a choice says live in it, other strings where they come from: it does not move. Zero-initialise. */
typedef struct adcgs_command {
    char *argv[48];
    int n, n_text, n_chosen;
    char text[8][40], set[ADCGS_SWEEP_PATH];
    char name[ADCGS_SWEEP_AXES][ADCGS_SWEEP_NAME + 2], value[ADCGS_SWEEP_AXES][ADCGS_SWEEP_NAME]; /* of the choice */
} adcgs_command;

/** A word as it is. */
void adcgs_command_word(adcgs_command *c, const char *text);
/** An option with its value; nothing without one. */
void adcgs_command_option(adcgs_command *c, const char *name, const char *value);
/** An option with a number, if it is at least `from`. */
void adcgs_command_number(adcgs_command *c, const char *name, double value, double from);
/** An option of the choice, if it is of those in `only`; NULL: of all. */
void adcgs_command_choice(adcgs_command *c, const adcgs_sweep_run *run, const char *const *only);
/** Settings of all runs, and those of the choice behind them. */
void adcgs_command_settings(adcgs_command *c, const adcgs_sweep *sweep, const adcgs_sweep_run *run);
/** The threads of all runs, unless each choice has its own. */
void adcgs_command_threads(adcgs_command *c, const adcgs_sweep *sweep, const adcgs_sweep_run *run);

#endif

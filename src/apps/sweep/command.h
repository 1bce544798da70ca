/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A command line under construction, for a run of a sweep. */
#ifndef ADCGS_APPS_SWEEP_COMMAND_H
#define ADCGS_APPS_SWEEP_COMMAND_H

#include "apps/sweep/sweep.h"

/** It holds numbers and the words of a choice, and refers to other strings, so it must not move. Zero-initialise. */
typedef struct adcgs_command {
    char *argv[48];
    int n, n_text, n_chosen;
    char text[8][40], set[ADCGS_SWEEP_PATH];
    char name[ADCGS_SWEEP_AXES][ADCGS_SWEEP_NAME + 2], value[ADCGS_SWEEP_AXES][ADCGS_SWEEP_NAME]; /* of the choice */
} adcgs_command;

/** Appends a word unchanged. */
void adcgs_command_word(adcgs_command *c, const char *text);
/** Appends an option with its value; nothing without a value. */
void adcgs_command_option(adcgs_command *c, const char *name, const char *value);
/** Appends an option with a number, if it is at least `from`. */
void adcgs_command_number(adcgs_command *c, const char *name, double value, double from);
/** Appends the options of the choice that are in `only`; NULL: all. */
void adcgs_command_choice(adcgs_command *c, const adcgs_sweep_run *run, const char *const *only);
/** Appends the settings of all runs, followed by those of the choice. */
void adcgs_command_settings(adcgs_command *c, const adcgs_sweep *sweep, const adcgs_sweep_run *run);
/** Appends the threads of all runs, unless the choice sets them. */
void adcgs_command_threads(adcgs_command *c, const adcgs_sweep *sweep, const adcgs_sweep_run *run);

#endif

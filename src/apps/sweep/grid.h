/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The axes that a sweep varies in addition to lambda and the seed: settings of the encoder, and some of its options, each with
 * its values. Every combination of one value for each axis is a curve of its own.
 */
#ifndef ADCGS_APPS_SWEEP_GRID_H
#define ADCGS_APPS_SWEEP_GRID_H

#include "base/base.h"

/* Origin, unless a line states one: chosen by hand, not measured. */
#define ADCGS_SWEEP_LIST 16 /**< values of an axis, of lambda and of seeds; choices of a grid */
#define ADCGS_SWEEP_AXES 4  /**< axes of a grid */
#define ADCGS_SWEEP_NAME 24 /**< bytes of an axis or value name, with its zero */
#define ADCGS_SWEEP_CHOICE (ADCGS_SWEEP_AXES * 2 * ADCGS_SWEEP_NAME) /**< bytes of names and values of all axes; arithmetic */

typedef struct adcgs_sweep_axis {
    char name[ADCGS_SWEEP_NAME];
    int n;
    char value[ADCGS_SWEEP_LIST][ADCGS_SWEEP_NAME];
} adcgs_sweep_axis;

typedef struct adcgs_sweep_grid {
    int n;
    adcgs_sweep_axis axis[ADCGS_SWEEP_AXES];
} adcgs_sweep_grid;

/** Adds axes: "k=4,6 iterations=1000,3000". ADCGS_ERR_USAGE for other texts, a repeated axis, or too many choices. */
adcgs_status adcgs_sweep_grid_parse(adcgs_sweep_grid *grid, const char *text, adcgs_error *error);

/** Returns the number of choices: 1 without axes. */
int adcgs_sweep_grid_count(const adcgs_sweep_grid *grid);

/** Writes a choice as text, "k=4 iterations=1000"; the last axis varies fastest. "" without axes. */
void adcgs_sweep_grid_choice(char choice[ADCGS_SWEEP_CHOICE], const adcgs_sweep_grid *grid, int index);

/** Changes the value of one axis in a choice; the axis need not be in the grid. */
void adcgs_sweep_choice_change(char choice[ADCGS_SWEEP_CHOICE], const char *name, const char *value);

/** Reads the next "name=value" of a choice into name and value. Returns the position after it, NULL after the last. */
const char *adcgs_sweep_choice_next(const char *choice, char name[ADCGS_SWEEP_NAME], char value[ADCGS_SWEEP_NAME]);

/** True if the choice has that axis; value receives its value. */
int adcgs_sweep_choice_find(const char *choice, const char *name, char value[ADCGS_SWEEP_NAME]);

/** True if an axis is an option of the encoder; else it is one of its settings. */
int adcgs_sweep_axis_is_option(const char *name);

/** True if runs that differ only in lambda can share their beginning. Runs with a time limit, or of several segments, cannot. */
int adcgs_sweep_choice_shares(const char *choice);

/**
 * Refuses the values that the encoder would refuse: ADCGS_ERR_USAGE. preset, set: those of all runs, NULL for none. The caller
 * checks settings with an option of the sweep's own, such as iterations.
 */
adcgs_status adcgs_sweep_grid_check(const adcgs_sweep_grid *grid, const char *preset, const char *set, adcgs_error *error);

#endif

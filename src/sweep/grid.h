/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * What a sweep varies besides lambda and the seed: settings of the encoder, and some of its options, each with the values that it
 * takes. Every choice of one value for each is a curve of its own.
 */
#ifndef ADCGS_SWEEP_GRID_H
#define ADCGS_SWEEP_GRID_H

#include "base/base.h"

#define ADCGS_SWEEP_LIST 16   /**< values of one axis, and of lambda and seeds; choices of a grid */
#define ADCGS_SWEEP_AXES 4
#define ADCGS_SWEEP_NAME 24   /**< of an axis or a value, with its end */
#define ADCGS_SWEEP_CHOICE (ADCGS_SWEEP_AXES * 2 * ADCGS_SWEEP_NAME)

typedef struct adcgs_sweep_axis {
    char name[ADCGS_SWEEP_NAME];
    int n;
    char value[ADCGS_SWEEP_LIST][ADCGS_SWEEP_NAME];
} adcgs_sweep_axis;

typedef struct adcgs_sweep_grid {
    int n;
    adcgs_sweep_axis axis[ADCGS_SWEEP_AXES];
} adcgs_sweep_grid;

/** Add axes: "k=4,6 iterations=1000,3000". ADCGS_ERR_USAGE for what is no such list, an axis twice, or more choices than fit. */
adcgs_status adcgs_sweep_grid_parse(adcgs_sweep_grid *grid, const char *text, adcgs_error *error);

/** How many choices there are: 1 without axes. */
int adcgs_sweep_grid_count(const adcgs_sweep_grid *grid);

/** One of them as text, "k=4 iterations=1000": the last axis takes turns fastest. "" without axes. */
void adcgs_sweep_grid_choice(char choice[ADCGS_SWEEP_CHOICE], const adcgs_sweep_grid *grid, int index);

/** The same with another value for one axis, which may be none of the grid's. */
void adcgs_sweep_choice_change(char choice[ADCGS_SWEEP_CHOICE], const char *name, const char *value);

/** The next "name=value" of a choice into name and value; returns where to go on, NULL behind the last. */
const char *adcgs_sweep_choice_next(const char *choice, char name[ADCGS_SWEEP_NAME], char value[ADCGS_SWEEP_NAME]);

/** Whether the choice has that axis; its value goes to value. */
int adcgs_sweep_choice_find(const char *choice, const char *name, char value[ADCGS_SWEEP_NAME]);

/** Whether an axis is an option of the encoder; else it is one of its settings. */
int adcgs_sweep_axis_is_option(const char *name);

/**
 * Whether runs that differ in lambda alone can begin together. Those that must be done at some time, and those of several
 * segments, cannot.
 */
int adcgs_sweep_choice_shares(const char *choice);

/**
 * What the encoder would refuse is refused: ADCGS_ERR_USAGE. preset, set: those of all runs, NULL for none; of what has an option
 * of the sweep's own, iterations and so on, the caller knows.
 */
adcgs_status adcgs_sweep_grid_check(const adcgs_sweep_grid *grid, const char *preset, const char *set, adcgs_error *error);

#endif

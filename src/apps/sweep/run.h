/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The files of a run, and the programs that train and evaluate its stream. */
#ifndef ADCGS_APPS_SWEEP_RUN_H
#define ADCGS_APPS_SWEEP_RUN_H

#include "apps/sweep/command.h"

#include <jansson.h>

/** Writes the path of a run's file with this suffix. */
void adcgs_sweep_path(char path[ADCGS_SWEEP_PATH], const adcgs_sweep *sweep, const adcgs_sweep_run *run, const char *suffix);
/** Returns the settings that determine its result. The caller calls json_decref(). */
json_t *adcgs_sweep_settings(const adcgs_sweep *sweep, const adcgs_sweep_run *run);
/** True if a file of the run, root as JSON, has the run's present settings. */
int adcgs_sweep_same_settings(const adcgs_sweep *sweep, const adcgs_sweep_run *run, const json_t *root);
/** Writes a value to a file, and takes over the value. */
adcgs_status adcgs_sweep_save(json_t *root, const char *path, adcgs_error *error);
/** Returns a number of a report, or of an object in it; NaN if it is missing. */
double adcgs_sweep_number(const json_t *report, const char *name);

/** Executes a command line, with its output to the file out and messages appended to the run's log. */
adcgs_status adcgs_sweep_call(const adcgs_sweep *sweep, const adcgs_sweep_run *run, const adcgs_command *command, const char *out,
                              adcgs_error *error);
/**
 * Measures a stream of the run on the test views; the report goes to the file out. option: another option of adcgs-eval with the
 * number count, or NULL. ADCGS_ERR_DATA if nothing can be decoded.
 */
adcgs_status adcgs_sweep_evaluate(const adcgs_sweep *sweep, const adcgs_sweep_run *run, const char *file, const char *option,
                                  int count, const char *out, adcgs_error *error);
/** Renders all test views of a run to a folder as images, next to the ground truth. */
adcgs_status adcgs_sweep_draw_views(const adcgs_sweep *sweep, const adcgs_sweep_run *run, const char *folder, adcgs_error *error);

#endif

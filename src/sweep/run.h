/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The files of a run, and the programs that are asked about its stream: what training and evaluating it is made of. */
#ifndef ADCGS_SWEEP_RUN_H
#define ADCGS_SWEEP_RUN_H

#include "sweep/command.h"

#include <jansson.h>

/** The file of a run with this suffix. */
void adcgs_sweep_path(char path[ADCGS_SWEEP_PATH], const adcgs_sweep *sweep, const adcgs_sweep_run *run, const char *suffix);
/** What its result depends on; json_decref() it. */
json_t *adcgs_sweep_settings(const adcgs_sweep *sweep, const adcgs_sweep_run *run);
/** Whether a file of the run, root as JSON, begins with the settings it has now. */
int adcgs_sweep_same_settings(const adcgs_sweep *sweep, const adcgs_sweep_run *run, const json_t *root);
/** Write a value, which this takes, to a file. */
adcgs_status adcgs_sweep_save(json_t *root, const char *path, adcgs_error *error);
/** A number of a report, or of an object in it; NaN if it is not there. */
double adcgs_sweep_number(const json_t *report, const char *name);

/** Obey a command line, its output to the file out, messages added to the run's log. */
adcgs_status adcgs_sweep_call(const adcgs_sweep *sweep, const adcgs_sweep_run *run, const adcgs_command *command, const char *out,
                              adcgs_error *error);
/**
 * Measure a stream of the run's on the test views: the report to the file out. option: one more of adcgs-eval's with the number
 * count, or NULL. ADCGS_ERR_DATA if nothing can be decoded.
 */
adcgs_status adcgs_sweep_evaluate(const adcgs_sweep *sweep, const adcgs_sweep_run *run, const char *file, const char *option,
                                  int count, const char *out, adcgs_error *error);
/** Have all test views of a run written to a folder as pictures, beside the truth. */
adcgs_status adcgs_sweep_draw_views(const adcgs_sweep *sweep, const adcgs_sweep_run *run, const char *folder, adcgs_error *error);

#endif

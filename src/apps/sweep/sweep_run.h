/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Executes the plan of adcgs-sweep. */
#ifndef ADCGS_APPS_SWEEP_SWEEP_RUN_H
#define ADCGS_APPS_SWEEP_SWEEP_RUN_H

#include "apps/sweep/sweep.h"
#include "cli/cli.h"

/** Takes the results of an earlier sweep and prints them; returns their number. */
int adcgs_sweep_take_finished(const adcgs_cli *cli, const adcgs_sweep *sweep, adcgs_sweep_plan *plan);
/** Executes all runs that are not done, several at a time. Returns the worst exit code. */
int adcgs_sweep_run_all(const adcgs_cli *cli, const adcgs_sweep *sweep, adcgs_sweep_plan *plan, int jobs);
/** Measures parts of the shown run's stream, if they are unknown, and writes everything. Returns an exit code. */
int adcgs_sweep_finish(const adcgs_cli *cli, const adcgs_sweep *sweep, adcgs_sweep_plan *plan);

#endif

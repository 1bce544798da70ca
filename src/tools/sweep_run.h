/* SPDX-License-Identifier: BSD-2-Clause */
/** \file How adcgs-sweep gets through its plan. */
#ifndef ADCGS_TOOLS_SWEEP_RUN_H
#define ADCGS_TOOLS_SWEEP_RUN_H

#include "cli/cli.h"
#include "sweep/sweep.h"

/** Take the results that an earlier sweep left, and say so; returns how many. */
int adcgs_sweep_take_finished(const adcgs_cli *cli, const adcgs_sweep *sweep, adcgs_sweep_plan *plan);
/** Run all that is not yet done, some at a time. Returns the worst exit code. */
int adcgs_sweep_run_all(const adcgs_cli *cli, const adcgs_sweep *sweep, adcgs_sweep_plan *plan, int jobs);
/** Measure parts of the stream of the run that stands for all, unless they are known; write everything. Returns an exit code. */
int adcgs_sweep_finish(const adcgs_cli *cli, const adcgs_sweep *sweep, adcgs_sweep_plan *plan);

#endif

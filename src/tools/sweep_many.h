/* SPDX-License-Identifier: BSD-2-Clause */
/**
 * \file
 * A sweep on many machines, which share its folder and nothing else: a command for each run, one of these runs, and what is there
 * put together. Who is at a run, or at the folder, says so by a file (io/claim.h), and others refuse.
 */
#ifndef ADCGS_TOOLS_SWEEP_MANY_H
#define ADCGS_TOOLS_SWEEP_MANY_H

#include "io/claim.h"
#include "tools/sweep_options.h"

/** Of a sweep by one process: that it runs, and that it writes the tables. */
typedef struct adcgs_sweep_claims {
    adcgs_claim *runs, *tables;
} adcgs_sweep_claims;

/** The folder, if it is not there. */
adcgs_status adcgs_sweep_make_folder(const adcgs_sweep *sweep, adcgs_error *error);
/** Say that all of the folder is ours; refused while anybody else is at it. adcgs_sweep_unclaim() either way. */
adcgs_status adcgs_sweep_claim_all(adcgs_sweep_claims *claims, const adcgs_sweep *sweep, const adcgs_sweep_plan *plan,
                                   adcgs_error *error);
void adcgs_sweep_unclaim(adcgs_sweep_claims *claims);

/** Leave in the folder what it is a sweep of, for --collect. */
adcgs_status adcgs_sweep_keep_words(const adcgs_sweep_request *request, adcgs_error *error);
/** A command line as it was left there. */
typedef struct adcgs_sweep_past {
    int argc;
    char *argv[2 * ADCGS_SWEEP_OPTIONS + 6];
    uint8_t *text; /**< that they are parts of */
} adcgs_sweep_past;
adcgs_status adcgs_sweep_recall(adcgs_sweep_past *past, const char *folder, adcgs_error *error);
void adcgs_sweep_forget(adcgs_sweep_past *past);

/** Print the command of each run, by the name that this program was called. Returns an exit code, as do those that follow. */
int adcgs_sweep_list(const adcgs_cli *cli, const adcgs_sweep_request *request, adcgs_sweep_plan *plan, const char *called);
/** Run one, from where it is. The plan is good for nothing else then. */
int adcgs_sweep_run_one(const adcgs_cli *cli, const adcgs_sweep_request *request, adcgs_sweep_plan *plan);
/** Tables, charts and page of the runs that are finished; 1 if some are not. */
int adcgs_sweep_collect(const adcgs_cli *cli, const adcgs_sweep *sweep, adcgs_sweep_plan *plan);

#endif

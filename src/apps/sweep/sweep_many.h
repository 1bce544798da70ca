/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A sweep on many machines that share only its folder: prints a command for each run, executes one of these runs, and collects
 * the results. Each process claims its run, or the folder, by a file (system/claim.h); others then refuse.
 */
#ifndef ADCGS_APPS_SWEEP_SWEEP_MANY_H
#define ADCGS_APPS_SWEEP_SWEEP_MANY_H

#include "apps/sweep/sweep_options.h"
#include "system/claim.h"

/** Claims of a sweep by one process: on all runs, and on the tables. */
typedef struct adcgs_sweep_claims {
    adcgs_claim *runs, *tables;
} adcgs_sweep_claims;

/** Creates the folder if it is missing. */
adcgs_status adcgs_sweep_make_folder(const adcgs_sweep *sweep, adcgs_error *error);
/** Claims the whole folder; refused while another process uses it. Call adcgs_sweep_unclaim() in either case. */
adcgs_status adcgs_sweep_claim_all(adcgs_sweep_claims *claims, const adcgs_sweep *sweep, const adcgs_sweep_plan *plan,
                                   adcgs_error *error);
void adcgs_sweep_unclaim(adcgs_sweep_claims *claims);

/** Stores the sweep's command line in the folder, for --collect. */
adcgs_status adcgs_sweep_keep_words(const adcgs_sweep_request *request, adcgs_error *error);
/** A command line stored in a folder. */
typedef struct adcgs_sweep_past {
    int argc;
    char *argv[2 * ADCGS_SWEEP_OPTIONS + 6];
    uint8_t *text; /**< memory of the words */
} adcgs_sweep_past;
adcgs_status adcgs_sweep_recall(adcgs_sweep_past *past, const char *folder, adcgs_error *error);
void adcgs_sweep_forget(adcgs_sweep_past *past);

/**
 * Prints the command of each run, under the name that this program was called by. Returns an exit code, like the next two
 * functions.
 */
int adcgs_sweep_list(const adcgs_cli *cli, const adcgs_sweep_request *request, adcgs_sweep_plan *plan, const char *called);
/** Executes one run, from its current state. The plan cannot be used afterwards. */
int adcgs_sweep_run_one(const adcgs_cli *cli, const adcgs_sweep_request *request, adcgs_sweep_plan *plan);
/** Writes tables, charts and the page of the finished runs; returns 1 if some are not finished. */
int adcgs_sweep_collect(const adcgs_cli *cli, const adcgs_sweep *sweep, adcgs_sweep_plan *plan);

#endif

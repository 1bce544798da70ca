/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The phases of an import on the progress line: name, finished parts, time left. */
#ifndef ADCGS_APPS_IMPORT_PHASE_H
#define ADCGS_APPS_IMPORT_PHASE_H

#include "cli/cli.h"

/** All zero before the first phase. */
typedef struct adcgs_import_phase {
    const char *name; /**< of the current phase */
    double began;     /**< time of its first line */
} adcgs_import_phase;

/**
 * Shows that `done` of `all` parts of a phase are finished; all is 0 for a phase without known parts. growth: the time of a phase
 * of n parts is proportional to n to this power. The time left appears when enough of the phase is over to estimate it.
 */
void adcgs_import_show(adcgs_import_phase *phase, adcgs_progress *progress, const char *name, uint32_t done, uint32_t all,
                       double growth);
/** Seconds left after `spent` seconds; NaN if it is too early to tell. */
double adcgs_import_time_left(double spent, uint32_t done, uint32_t all, double growth);

#endif

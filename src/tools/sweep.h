/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A grid of encodings: what its points are, how one is run, how they are written out. */
#ifndef ADCGS_TOOLS_SWEEP_H
#define ADCGS_TOOLS_SWEEP_H

#include "base/base.h"

#define ADCGS_SWEEP_LIST 16

typedef struct adcgs_sweep {
    const char *scene, *directory;
    const char *programs; /**< folder of adcgs-enc and adcgs-eval */
    const char *preset;
    int iterations;       /**< 0: the preset's */
    int threads;          /**< of each encoder; 0: one per CPU */
    int resume;
} adcgs_sweep;

typedef struct adcgs_sweep_point {
    double lambda;
    int k;         /**< 0: the preset's */
    char tag[48];  /**< names its files */
    int done;
    double bytes, psnr, ssim; /**< of the decoded file on the test views; NaN where not reported */
    double training_seconds, frames_per_second;
} adcgs_sweep_point;

void adcgs_sweep_point_init(adcgs_sweep_point *point, double lambda, int k);

/** Encode and evaluate a point in child processes, then write its result file. Output of the programs goes to a log. */
adcgs_status adcgs_sweep_run(const adcgs_sweep *sweep, const adcgs_sweep_point *point, adcgs_error *error);
/** Fill point from its result file; ADCGS_ERR_DATA if there is none or it belongs to other settings. */
adcgs_status adcgs_sweep_load(const adcgs_sweep *sweep, adcgs_sweep_point *point, adcgs_error *error);

/** sweep.csv, sweep.json and, with gnuplot, sweep.svg in the folder. *chart: whether there is a chart. */
adcgs_status adcgs_sweep_write(const adcgs_sweep *sweep, const adcgs_sweep_point *points, int n, int *chart, adcgs_error *error);

/** Run argv[0], stdout to the file out, stderr added to the file log (NULL: as they are). *exit_code: 127 if it did not start. */
adcgs_status adcgs_sweep_spawn(char *const argv[], const char *out, const char *log, int *exit_code, adcgs_error *error);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A sweep: which trainings it takes, how one is run, what they add up to, and
 * how that is written out.
 *
 * A run is one training, in child processes. Runs that differ in lambda alone
 * share their beginning, itself a run. A cell is the runs that differ in their seed alone. Curves are lists of cells with the
 * size to put on the axis, or points of an earlier sweep; the first is the codec's own, the others are compared with it. Stages
 * are the rows of the ablation.
 */
#ifndef ADCGS_SWEEP_SWEEP_H
#define ADCGS_SWEEP_SWEEP_H

#include "base/base.h"

#include <stdio.h>
#include <sys/types.h>

#define ADCGS_SWEEP_LIST 16    /**< values of one option */
#define ADCGS_SWEEP_CELLS 320  /**< 16 x 16 of the grid, yardsticks, ablation */
#define ADCGS_SWEEP_CURVES 32  /**< 16 of the grid, 7 yardsticks, earlier ones */
#define ADCGS_SWEEP_STAGES 12
#define ADCGS_SWEEP_AGAINST 8  /**< earlier sweeps to compare with */
#define ADCGS_SWEEP_PATH 4096

/** Yardsticks to measure against. */
enum { ADCGS_YARD_NETWORKS = 1, ADCGS_YARD_UNCOMPRESSED = 2, ADCGS_YARD_GAUSSIANS = 4, ADCGS_YARD_ALL = 7 };

/** What was asked for. */
typedef struct adcgs_sweep {
    const char *scene, *directory;
    const char *programs;    /**< folder of adcgs-enc and adcgs-eval */
    const char *preset, *set; /**< NULL: the encoder's; nothing changed */
    const char *dataset, *frames; /**< for both programs; NULL: told by files; all */
    const char *against;     /**< folders of earlier sweeps, with commas between; NULL: none */
    int iterations;          /**< 0: the preset's */
    int threads;             /**< of each encoder; 0: one per CPU */
    int resume, ablation, yardsticks;
    double lambda[ADCGS_SWEEP_LIST], k[ADCGS_SWEEP_LIST], seed[ADCGS_SWEEP_LIST];
    int n_lambda, n_k, n_seed;
} adcgs_sweep;

/** What is known of a finished run; NaN where it is not. */
typedef enum adcgs_figure {
    ADCGS_FIGURE_BYTES,      /**< the stream on disk */
    ADCGS_FIGURE_NETWORKS32, /**< the same if each weight of its networks took 4 bytes (the paper's accounting) */
    ADCGS_FIGURE_RAW,        /**< the uncompressed model on disk */
    ADCGS_FIGURE_ZSTD,       /**< that file by zstd -19 */
    ADCGS_FIGURE_XZ,         /**< that file by xz -9e */
    ADCGS_FIGURE_NETWORKS,   /**< bytes of the networks in the stream */
    ADCGS_FIGURE_PSNR,       /**< dB; like all below of the decoded stream on the test views */
    ADCGS_FIGURE_SSIM,
    ADCGS_FIGURE_MOVING,     /**< PSNR of what moves; NaN where nothing does */
    ADCGS_FIGURE_SECONDS,    /**< of training, a shared beginning included */
    ADCGS_FIGURE_SPEED,      /**< frames per second */
    ADCGS_FIGURE_COUNT
} adcgs_figure;

typedef enum adcgs_run_state { ADCGS_RUN_WAITS, ADCGS_RUN_RUNS, ADCGS_RUN_DONE, ADCGS_RUN_FAILED } adcgs_run_state;

typedef struct adcgs_sweep_run {
    char tag[128];          /**< names its files; runs of the same tag are one */
    int beginning;          /**< nothing but a state for others to go on from */
    int uncompressed;       /**< stored as plain numbers too */
    double lambda, seed;    /**< < 0: not given to the encoder */
    int k;                  /**< 0: not given */
    const char *without;    /**< parts left out; "" for none */
    int from;               /**< the run that is its beginning; -1: none */
    adcgs_run_state state;
    pid_t child;
    double figure[ADCGS_FIGURE_COUNT];
} adcgs_sweep_run;

typedef struct adcgs_sweep_cell {
    int n, run[ADCGS_SWEEP_LIST]; /**< one for each seed */
} adcgs_sweep_cell;

/** A figure over the seeds of a cell. */
typedef struct adcgs_spread {
    int n;                 /**< runs that have it; 0: the rest is NaN */
    double mean, min, max;
} adcgs_spread;

/** A line of a table: a cell with one of its sizes. */
typedef struct adcgs_sweep_row {
    const char *name;
    double lambda; /**< < 0: the preset's, or of no influence */
    int k;         /**< 0: the preset's */
    adcgs_spread bytes, psnr;
    double moving, ssim, networks, seconds, speed; /**< means; networks: share of the stream, NaN if bytes are not its bytes */
} adcgs_sweep_row;

typedef struct adcgs_sweep_curve {
    char name[48];
    char note[256];    /**< how it comes about */
    adcgs_figure size; /**< what counts as its bytes */
    int yardstick, earlier;
    int n, cell[ADCGS_SWEEP_LIST];
    adcgs_sweep_row point[ADCGS_SWEEP_LIST]; /**< of an earlier sweep, instead of cells */
} adcgs_sweep_curve;

typedef struct adcgs_sweep_stage {
    const char *name;
    adcgs_figure size;
    int cell;
} adcgs_sweep_stage;

typedef struct adcgs_sweep_plan {
    adcgs_sweep_run *run;
    int n_runs, capacity;
    adcgs_sweep_cell cell[ADCGS_SWEEP_CELLS];
    adcgs_sweep_curve curve[ADCGS_SWEEP_CURVES];
    adcgs_sweep_stage stage[ADCGS_SWEEP_STAGES];
    int n_cells, n_curves, n_stages;
} adcgs_sweep_plan;

/** List the runs, cells, curves and stages of a sweep. The plan is the caller's, zeroed; clear it also after a failure. */
adcgs_status adcgs_sweep_plan_make(adcgs_sweep_plan *plan, const adcgs_sweep *sweep, adcgs_error *error);
void adcgs_sweep_plan_clear(adcgs_sweep_plan *plan);
/** One more curve, without points; there is room for what an adcgs_sweep can ask for. */
adcgs_sweep_curve *adcgs_sweep_add_curve(adcgs_sweep_plan *plan, const char *name, const char *note, adcgs_figure size,
                                         int yardstick);
/** The curves of the earlier sweeps that this one is compared with, behind those of the plan (sweep_against.c). */
adcgs_status adcgs_sweep_add_against(adcgs_sweep_plan *plan, const adcgs_sweep *sweep, adcgs_error *error);

/* ---- One run (sweep_run.c) ---- */

/**
 * Train and evaluate a run in child processes, then write its result file. Output of the programs goes to a log. from: the run it
 * goes on from, or NULL.
 */
adcgs_status adcgs_sweep_execute(const adcgs_sweep *sweep, const adcgs_sweep_run *run, const adcgs_sweep_run *from,
                                 adcgs_error *error);
/** Fill run from its result file; ADCGS_ERR_DATA if there is none or it belongs to other settings. */
adcgs_status adcgs_sweep_load(const adcgs_sweep *sweep, adcgs_sweep_run *run, adcgs_error *error);
/** Run argv[0], stdout to the file out, stderr added to the file log (NULL: as they are). *exit_code: 127 if it did not start. */
adcgs_status adcgs_sweep_spawn(char *const argv[], const char *out, const char *log, int *exit_code, adcgs_error *error);

/* ---- Sums (sweep_sum.c) ---- */

/** 1 if the cell has results. */
int adcgs_sweep_row_make(adcgs_sweep_row *row, const adcgs_sweep_plan *plan, const char *name, int cell, adcgs_figure size);
/** The same for a point of a curve. */
int adcgs_sweep_point(adcgs_sweep_row *row, const adcgs_sweep_plan *plan, const adcgs_sweep_curve *curve, int index);

/** Facts about the codec's own curve. */
typedef struct adcgs_curve_facts {
    int n, monotone; /**< points; each larger one is better */
    double span;     /**< largest over smallest size */
} adcgs_curve_facts;

/** The codec's own curve against another. */
typedef struct adcgs_comparison {
    double bd_rate;  /**< percent of bytes at equal PSNR, < 0: the codec needs fewer; NaN if it cannot be told */
    double bd_rate_moving; /**< the same at equal PSNR of what moves */
    int compared;    /**< points of the other that are larger than the codec's smallest, and so have something to compare with */
    int beyond;      /**< the others */
    double margin;   /**< least PSNR that the codec has above such a point at fewer bytes, dB; NaN if compared is 0 */
    int above;       /**< compared > 0 and margin >= 0 */
    double smaller;  /**< bytes of the other's best point over those of the codec's smallest point within 0.1 dB of it, or NaN */
} adcgs_comparison;

adcgs_curve_facts adcgs_sweep_facts(const adcgs_sweep_plan *plan);
adcgs_comparison adcgs_sweep_compare(const adcgs_sweep_plan *plan, const adcgs_sweep_curve *other);

/* ---- Output ---- */

/** sweep.csv, ablation.csv and sweep.json in the folder (sweep_write.c). */
adcgs_status adcgs_sweep_write_tables(const adcgs_sweep *sweep, const adcgs_sweep_plan *plan, adcgs_error *error);
/** sweep.gp and, with gnuplot, sweep.svg in the folder (sweep_chart.c). *chart: whether there is a chart. */
adcgs_status adcgs_sweep_draw(const adcgs_sweep *sweep, const adcgs_sweep_plan *plan, int *chart, adcgs_error *error);
/** The tables and checks as text (sweep_page.c). */
void adcgs_sweep_print(FILE *file, const adcgs_sweep_plan *plan);
/** index.html in the folder: chart, tables and checks in one file (sweep_page.c). */
adcgs_status adcgs_sweep_write_page(const adcgs_sweep *sweep, const adcgs_sweep_plan *plan, int chart, adcgs_error *error);

#endif

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

#include "sweep/grid.h"

#include <adcgs/types.h>

#include <stdio.h>
#include <sys/types.h>

#define ADCGS_SWEEP_CELLS 320  /**< 16 x 16 of the grid, yardsticks, ablation */
#define ADCGS_SWEEP_CURVES 40  /**< 16 of the grid, 7 yardsticks, earlier ones, other methods */
#define ADCGS_SWEEP_STAGES 12
#define ADCGS_SWEEP_AGAINST 8  /**< earlier sweeps to compare with, and other methods */
#define ADCGS_SWEEP_PORTIONS 24 /**< 5 layers, 8 tiers, ten tenths of the bytes */
#define ADCGS_SWEEP_PATH 4096
#define ADCGS_SWEEP_TAG (ADCGS_SWEEP_CHOICE + 96)

/** Yardsticks to measure against. */
enum { ADCGS_YARD_NETWORKS = 1, ADCGS_YARD_UNCOMPRESSED = 2, ADCGS_YARD_GAUSSIANS = 4, ADCGS_YARD_ALL = 7 };

/** What was asked for. */
typedef struct adcgs_sweep {
    const char *scene, *directory;
    const char *programs;    /**< folder of adcgs-enc and adcgs-eval */
    const char *command;     /**< the line that began it */
    const char *preset, *set; /**< NULL: the encoder's; nothing changed */
    const char *dataset, *frames; /**< for both programs; NULL: told by files; all */
    const char *against;     /**< folders of earlier sweeps, with commas between; NULL: none */
    const char *tables;      /**< NAME=FILE of other methods' tables, with commas between; NULL: none */
    int iterations;          /**< 0: the preset's */
    int threads;             /**< of each encoder; 0: one per CPU */
    int resume, ablation, yardsticks;
    int fixed;               /**< sizes do not follow from the scene */
    double lambda[ADCGS_SWEEP_LIST], seed[ADCGS_SWEEP_LIST];
    int n_lambda, n_seed;
    adcgs_sweep_grid grid;
} adcgs_sweep;

/** What is known of a finished run; NaN where it is not. */
typedef enum adcgs_figure {
    ADCGS_FIGURE_BYTES,      /**< the stream on disk */
    ADCGS_FIGURE_NETWORKS32, /**< the same if each weight of its networks took 4 bytes (the paper's accounting) */
    ADCGS_FIGURE_RAW,        /**< the uncompressed model on disk */
    ADCGS_FIGURE_ZSTD,       /**< that file by zstd -19 */
    ADCGS_FIGURE_XZ,         /**< that file by xz -9e */
    ADCGS_FIGURE_NETWORKS,   /**< bytes of the networks in the stream */
    ADCGS_FIGURE_GEOMETRY,   /**< of the anchors' positions */
    ADCGS_FIGURE_BASE,       /**< of the features without which nothing is drawn */
    ADCGS_FIGURE_DETAIL,     /**< of the features that refine */
    ADCGS_FIGURE_REST,       /**< of all else */
    ADCGS_FIGURE_PSNR,       /**< dB; like all below of the decoded stream on the test views */
    ADCGS_FIGURE_SSIM,
    ADCGS_FIGURE_MOVING,     /**< PSNR of what moves; NaN where nothing does */
    ADCGS_FIGURE_SECONDS,    /**< of processors, of training, a shared beginning included */
    ADCGS_FIGURE_SPEED,      /**< frames per second */
    ADCGS_FIGURE_OBJECTIVE,  /**< what training makes small: loss of the training views, and lambda times all bytes */
    ADCGS_FIGURE_COUNT
} adcgs_figure;

typedef enum adcgs_run_state { ADCGS_RUN_WAITS, ADCGS_RUN_RUNS, ADCGS_RUN_DONE, ADCGS_RUN_FAILED } adcgs_run_state;

typedef struct adcgs_sweep_run {
    char tag[ADCGS_SWEEP_TAG]; /**< names its files; runs of the same tag are one */
    int beginning;          /**< nothing but a state for others to go on from */
    int uncompressed;       /**< stored as plain numbers too */
    double lambda, seed;    /**< < 0: not given to the encoder */
    char choice[ADCGS_SWEEP_CHOICE]; /**< of the grid; "" where nothing is varied */
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

/** Of a figure of which no more than the mean is known. */
static inline adcgs_spread adcgs_spread_one(double mean)
{
    return (adcgs_spread){mean == mean, mean, mean, mean};
}

/** A line of a table: a cell with one of its sizes. */
typedef struct adcgs_sweep_row {
    const char *name;
    double lambda; /**< < 0: the preset's, or of no influence */
    char choice[ADCGS_SWEEP_CHOICE]; /**< of the grid */
    int is_stream; /**< bytes are those of a stream, which takes so many seconds of processors to train and plays so fast */
    adcgs_spread bytes, psnr, moving, ssim, seconds, speed, objective;
    double networks; /**< share of the stream, in the mean; NaN if it is none */
} adcgs_sweep_row;

typedef struct adcgs_sweep_curve {
    char name[ADCGS_SWEEP_CHOICE + 16];
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

/** A test view. */
typedef struct adcgs_sweep_view {
    char name[ADCGS_CAMERA_NAME_MAX + 1];
    int camera; /**< views of one come one after the other, in the order of their times */
    double time, psnr, moving; /**< seconds, dB; NaN where they are not known */
} adcgs_sweep_view;

/** What a stream can be cut to: its first layers, its first tiers, or its first bytes. */
typedef enum adcgs_portion_kind {
    ADCGS_PORTION_LAYERS, ADCGS_PORTION_TIERS, ADCGS_PORTION_PERCENT, ADCGS_PORTION_COUNT
} adcgs_portion_kind;

/** A part of a stream, and how good the test views are that are decoded from it. */
typedef struct adcgs_sweep_portion {
    adcgs_portion_kind kind;
    int count;           /**< layers, tiers, or percent of the bytes */
    double bytes;        /**< that it comprises */
    int is_known;        /**< measured */
    double psnr, moving; /**< NaN where nothing can be decoded from it */
} adcgs_sweep_portion;

/** The run that stands for all, looked at more closely. */
typedef struct adcgs_sweep_shown {
    const adcgs_sweep_run *run; /**< NULL: none, and nothing below */
    adcgs_sweep_view *view;
    int n_views, n_portions;
    adcgs_sweep_portion portion[ADCGS_SWEEP_PORTIONS];
} adcgs_sweep_shown;

typedef struct adcgs_sweep_plan {
    adcgs_sweep_run *run;
    int n_runs, capacity;
    adcgs_sweep_cell cell[ADCGS_SWEEP_CELLS];
    adcgs_sweep_curve curve[ADCGS_SWEEP_CURVES];
    adcgs_sweep_stage stage[ADCGS_SWEEP_STAGES];
    int n_cells, n_curves, n_stages;
    adcgs_sweep_shown shown;
} adcgs_sweep_plan;

/** List the runs, cells, curves and stages of a sweep. The plan is the caller's, zeroed; clear it also after a failure. */
adcgs_status adcgs_sweep_plan_make(adcgs_sweep_plan *plan, const adcgs_sweep *sweep, adcgs_error *error);
void adcgs_sweep_plan_clear(adcgs_sweep_plan *plan);
/** One more curve, without points; there is room for what an adcgs_sweep can ask for. */
adcgs_sweep_curve *adcgs_sweep_add_curve(adcgs_sweep_plan *plan, const char *name, const char *note, adcgs_figure size,
                                         int yardstick);
/** The curves of the earlier sweeps that this one is compared with, behind those of the plan (against.c). */
adcgs_status adcgs_sweep_add_against(adcgs_sweep_plan *plan, const adcgs_sweep *sweep, adcgs_error *error);

/** Whether a curve is called that (against.c). */
int adcgs_sweep_has_curve(const adcgs_sweep_plan *plan, const char *name);
/** A curve's name goes to terminals and into gnuplot's quotes: what either might obey is replaced (against.c). */
void adcgs_sweep_write_name(char *name, size_t size, const char *text, size_t length);
/** The curves of other methods, from tables, behind those of the plan (add.c). */
adcgs_status adcgs_sweep_add_tables(adcgs_sweep_plan *plan, const char *tables, adcgs_error *error);

/* ---- One run (run.c) ---- */

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

/* ---- The run that stands for all ---- */

/** Choose it, when all have run, and take the views of its result (shown.c). */
adcgs_status adcgs_sweep_show(const adcgs_sweep *sweep, adcgs_sweep_plan *plan, adcgs_error *error);
/** What a kind of portion is called, in files and in charts (shown.c). */
const char *adcgs_portion_name(adcgs_portion_kind kind);
/** List what its stream can be cut to; what was measured before is known (portions.c). */
adcgs_status adcgs_sweep_list_portions(const adcgs_sweep *sweep, adcgs_sweep_plan *plan, adcgs_error *error);
/** Measure one of these, unless it is known, and keep that in a file (portions.c). */
adcgs_status adcgs_sweep_measure_portion(const adcgs_sweep *sweep, adcgs_sweep_plan *plan, int index, adcgs_error *error);

/* ---- Sums (sum.c) ---- */

/** A figure over the seeds of a cell. */
adcgs_spread adcgs_sweep_spread(const adcgs_sweep_plan *plan, int cell, adcgs_figure figure);
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

/** sweep.csv, ablation.csv, portions.csv, views.csv and sweep.json in the folder (write.c). */
adcgs_status adcgs_sweep_write_tables(const adcgs_sweep *sweep, const adcgs_sweep_plan *plan, adcgs_error *error);
/** A test view that the page shows: truth, decoded, and their difference. */
enum { ADCGS_SWEEP_PICTURES = 2 };
typedef struct adcgs_sweep_picture {
    const char *name, *run; /**< "worst"; the run's tag */
    char path[ADCGS_SWEEP_PATH];
    int is_there;
    unsigned index; /**< among the test views */
    double psnr, time; /**< dB; seconds, NaN where it has none */
} adcgs_sweep_picture;
/** The worst and the middle test view of the run that stands for all, drawn anew (views_chart.c). */
adcgs_status adcgs_sweep_pictures(const adcgs_sweep *sweep, const adcgs_sweep_plan *plan,
                                  adcgs_sweep_picture picture[ADCGS_SWEEP_PICTURES], adcgs_error *error);

/** The charts (charts.h) in the folder. *charts: a bit for each that is there. */
adcgs_status adcgs_sweep_draw(const adcgs_sweep *sweep, const adcgs_sweep_plan *plan, unsigned *charts, adcgs_error *error);
/** The tables and checks as text (page.c). */
void adcgs_sweep_print(FILE *file, const adcgs_sweep_plan *plan);
/** index.html in the folder: those charts, pictures, tables and checks in one file (page.c). */
adcgs_status adcgs_sweep_write_page(const adcgs_sweep *sweep, const adcgs_sweep_plan *plan, unsigned charts, adcgs_error *error);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A sweep: the trainings that it needs, running them, summaries, and output.
 *
 * A run is one training, in child processes. Runs that differ only in lambda share their beginning, itself a run. A cell is the
 * runs that differ only in their seed. A curve is a list of cells with the size for the axis, or points of an earlier sweep. The
 * first curve is the codec's own; the others are compared with it. Stages are the rows of the ablation.
 */
#ifndef ADCGS_APPS_SWEEP_SWEEP_H
#define ADCGS_APPS_SWEEP_SWEEP_H

#include "apps/sweep/grid.h"

#include <adcgs/types.h>

#include <stdio.h>
#include <sys/types.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define ADCGS_SWEEP_CELLS 320                     /**< 16 x 16 of the grid, yardsticks, ablation */
#define ADCGS_SWEEP_CURVES 40                     /**< 16 of the grid, 7 yardsticks, earlier sweeps, other methods */
#define ADCGS_SWEEP_STAGES 12                     /**< stages of the ablation */
#define ADCGS_SWEEP_AGAINST 8                     /**< earlier sweeps to compare with, and other methods */
#define ADCGS_SWEEP_PORTIONS 24                   /**< 5 layers, 8 tiers, ten tenths of the bytes */
#define ADCGS_SWEEP_PATH 4096                     /**< bytes of a path */
#define ADCGS_SWEEP_TAG (ADCGS_SWEEP_CHOICE + 96) /**< bytes of a run's tag */

/** Yardsticks to measure against, as bits; definition. */
enum { ADCGS_YARD_NETWORKS = 1, ADCGS_YARD_UNCOMPRESSED = 2, ADCGS_YARD_GAUSSIANS = 4, ADCGS_YARD_ALL = 7 };

/** The request. */
typedef struct adcgs_sweep {
    const char *scene, *directory;
    const char *programs;         /**< folder of adcgs-enc and adcgs-eval */
    const char *command;          /**< the command line of the sweep */
    const char *preset, *set;     /**< NULL: the encoder's; no changes */
    const char *dataset, *frames; /**< for both programs; NULL: detected from files; all */
    const char *against;          /**< folders of earlier sweeps, with commas between; NULL: none */
    const char *tables;           /**< NAME=FILE of other methods' tables, with commas between; NULL: none */
    int iterations;               /**< 0: the preset's */
    int threads;                  /**< of each encoder; 0: one per CPU */
    int resume, ablation, yardsticks;
    int fixed; /**< model sizes do not depend on the scene */
    double lambda[ADCGS_SWEEP_LIST], seed[ADCGS_SWEEP_LIST];
    int n_lambda, n_seed;
    adcgs_sweep_grid grid;
} adcgs_sweep;

/** Figures of a finished run; NaN if unknown. */
typedef enum adcgs_figure {
    ADCGS_FIGURE_BYTES,      /**< the stream on disk */
    ADCGS_FIGURE_NETWORKS32, /**< the same if each weight of its networks took 4 bytes (the paper's accounting) */
    ADCGS_FIGURE_RAW,        /**< the uncompressed model on disk */
    ADCGS_FIGURE_ZSTD,       /**< that file by zstd -19 */
    ADCGS_FIGURE_XZ,         /**< that file by xz -9e */
    ADCGS_FIGURE_NETWORKS,   /**< bytes of the networks in the stream */
    ADCGS_FIGURE_GEOMETRY,   /**< of the anchors' positions */
    ADCGS_FIGURE_BASE,       /**< of the features that rendering requires */
    ADCGS_FIGURE_DETAIL,     /**< of the refining features */
    ADCGS_FIGURE_REST,       /**< of everything else */
    ADCGS_FIGURE_PSNR,       /**< dB; this and all below: of the decoded stream on the test views */
    ADCGS_FIGURE_SSIM,
    ADCGS_FIGURE_MOVING,    /**< PSNR of moving regions; NaN if there are none */
    ADCGS_FIGURE_SECONDS,   /**< CPU seconds of training, including a shared beginning */
    ADCGS_FIGURE_SPEED,     /**< frames per second */
    ADCGS_FIGURE_OBJECTIVE, /**< the training objective: loss of the training views plus lambda times all bytes */
    ADCGS_FIGURE_COUNT
} adcgs_figure;

typedef enum adcgs_run_state { ADCGS_RUN_WAITS, ADCGS_RUN_RUNS, ADCGS_RUN_DONE, ADCGS_RUN_FAILED } adcgs_run_state;

typedef struct adcgs_sweep_run {
    char tag[ADCGS_SWEEP_TAG];       /**< names its files; runs of the same tag are one */
    int beginning;                   /**< only a state that other runs continue from */
    int uncompressed;                /**< also stored as plain numbers */
    double lambda, seed;             /**< < 0: not given to the encoder */
    char choice[ADCGS_SWEEP_CHOICE]; /**< of the grid; "" if nothing is varied */
    const char *without;             /**< parts left out; "" for none */
    int from;                        /**< the run that is its beginning; -1: none */
    adcgs_run_state state;
    pid_t child;
    double figure[ADCGS_FIGURE_COUNT];
} adcgs_sweep_run;

typedef struct adcgs_sweep_cell {
    int n, run[ADCGS_SWEEP_LIST]; /**< one for each seed */
} adcgs_sweep_cell;

/** A figure over the seeds of a cell. */
typedef struct adcgs_spread {
    int n; /**< runs that have it; 0: the rest is NaN */
    double mean, min, max;
} adcgs_spread;

/** A figure of which only the mean is known. */
static inline adcgs_spread adcgs_spread_one(double mean)
{
    return (adcgs_spread){mean == mean, mean, mean, mean};
}

/** A line of a table: a cell with one of its sizes. */
typedef struct adcgs_sweep_row {
    const char *name;
    double lambda;                   /**< < 0: the preset's, or without effect */
    char choice[ADCGS_SWEEP_CHOICE]; /**< of the grid */
    int is_stream;                   /**< bytes are those of a stream, with training seconds and a rendering speed */
    adcgs_spread bytes, psnr, moving, ssim, seconds, speed, objective;
    double networks; /**< mean share of the stream; NaN if it is not a stream */
} adcgs_sweep_row;

typedef struct adcgs_sweep_curve {
    char name[ADCGS_SWEEP_CHOICE + 16];
    char note[256];    /**< its origin */
    adcgs_figure size; /**< the figure that counts as its bytes */
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
    int camera;                /**< views of a camera are consecutive, in the order of their times */
    double time, psnr, moving; /**< seconds, dB; NaN if unknown */
} adcgs_sweep_view;

/** Kinds of parts of a stream: its first layers, its first tiers, or its first bytes. */
typedef enum adcgs_portion_kind {
    ADCGS_PORTION_LAYERS,
    ADCGS_PORTION_TIERS,
    ADCGS_PORTION_PERCENT,
    ADCGS_PORTION_COUNT
} adcgs_portion_kind;

/** A part of a stream, and the quality of the test views decoded from it. */
typedef struct adcgs_sweep_portion {
    adcgs_portion_kind kind;
    int count;           /**< layers, tiers, or percent of the bytes */
    double bytes;        /**< size of the part */
    int is_known;        /**< measured */
    double psnr, moving; /**< NaN if nothing can be decoded from it */
} adcgs_sweep_portion;

/** The representative run, which is measured in more detail. */
typedef struct adcgs_sweep_shown {
    const adcgs_sweep_run *run; /**< NULL: none, and the rest is empty */
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

/** Lists the runs, cells, curves and stages of a sweep. The plan is the caller's, zeroed. Clear it after a failure, too. */
adcgs_status adcgs_sweep_plan_make(adcgs_sweep_plan *plan, const adcgs_sweep *sweep, adcgs_error *error);
void adcgs_sweep_plan_clear(adcgs_sweep_plan *plan);
/** Adds a curve without points; there is room for every curve that an adcgs_sweep can request. */
adcgs_sweep_curve *adcgs_sweep_add_curve(adcgs_sweep_plan *plan, const char *name, const char *note, adcgs_figure size,
                                         int yardstick);
/** Adds the curves of the earlier sweeps to compare with, after those of the plan (against.c). */
adcgs_status adcgs_sweep_add_against(adcgs_sweep_plan *plan, const adcgs_sweep *sweep, adcgs_error *error);

/** True if a curve has this name (against.c). */
int adcgs_sweep_has_curve(const adcgs_sweep_plan *plan, const char *name);
/** Writes a curve's name for terminals and gnuplot's quotes: characters that either would interpret are replaced (against.c). */
void adcgs_sweep_write_name(char *name, size_t size, const char *text, size_t length);
/** Adds the curves of other methods, from tables, after those of the plan (add.c). */
adcgs_status adcgs_sweep_add_tables(adcgs_sweep_plan *plan, const char *tables, adcgs_error *error);

/* ---- One run (run.c) ---- */

/**
 * Trains and evaluates a run in child processes, then writes its result file. Output of the programs goes to a log. from: the run
 * that it continues, or NULL.
 */
adcgs_status adcgs_sweep_execute(const adcgs_sweep *sweep, const adcgs_sweep_run *run, const adcgs_sweep_run *from,
                                 adcgs_error *error);
/** Fills run from its result file. ADCGS_ERR_DATA if there is none or it belongs to other settings. */
adcgs_status adcgs_sweep_load(const adcgs_sweep *sweep, adcgs_sweep_run *run, adcgs_error *error);
/**
 * Runs argv[0] with stdout to the file out and stderr appended to the file log (NULL: unchanged). *exit_code: 127 if it did not
 * start.
 */
adcgs_status adcgs_sweep_spawn(char *const argv[], const char *out, const char *log, int *exit_code, adcgs_error *error);

/* ---- The representative run ---- */

/** Chooses the run, when all have finished, and takes the views of its result (shown.c). */
adcgs_status adcgs_sweep_show(const adcgs_sweep *sweep, adcgs_sweep_plan *plan, adcgs_error *error);
/** The name of a kind of part, in files and charts (shown.c). */
const char *adcgs_portion_name(adcgs_portion_kind kind);
/** Lists the parts of its stream; earlier measurements are known (portions.c). */
adcgs_status adcgs_sweep_list_portions(const adcgs_sweep *sweep, adcgs_sweep_plan *plan, adcgs_error *error);
/** Measures one of these parts, unless it is known, and stores the result in a file (portions.c). */
adcgs_status adcgs_sweep_measure_portion(const adcgs_sweep *sweep, adcgs_sweep_plan *plan, int index, adcgs_error *error);

/* ---- Sums (sum.c) ---- */

/** A figure over the seeds of a cell. */
adcgs_spread adcgs_sweep_spread(const adcgs_sweep_plan *plan, int cell, adcgs_figure figure);
/** Returns 1 if the cell has results. */
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
    double bd_rate;        /**< percent of bytes at equal PSNR, < 0: the codec needs fewer; NaN if undefined */
    double bd_rate_moving; /**< the same at equal PSNR of moving regions */
    int compared;          /**< points of the other curve that are larger than the codec's smallest, and so can be compared */
    int beyond;            /**< the other points */
    double margin;         /**< least PSNR advantage of the codec over such a point with fewer bytes, dB; NaN if compared is 0 */
    int above;             /**< compared > 0 and margin >= 0 */
    double smaller; /**< bytes of the other's best point over those of the codec's smallest point within 0.1 dB of it, or NaN */
} adcgs_comparison;

adcgs_curve_facts adcgs_sweep_facts(const adcgs_sweep_plan *plan);
adcgs_comparison adcgs_sweep_compare(const adcgs_sweep_plan *plan, const adcgs_sweep_curve *other);

/* ---- Output ---- */

/** Writes sweep.csv, ablation.csv, portions.csv, views.csv and sweep.json to the folder (sweep_write.c). */
adcgs_status adcgs_sweep_write_tables(const adcgs_sweep *sweep, const adcgs_sweep_plan *plan, adcgs_error *error);
/** A test view on the page: ground truth, decoded, and their difference. Definition: the worst and the middle view. */
enum { ADCGS_SWEEP_PICTURES = 2 };
typedef struct adcgs_sweep_picture {
    const char *name, *run; /**< "worst"; the run's tag */
    char path[ADCGS_SWEEP_PATH];
    int is_there;
    unsigned index;    /**< among the test views */
    double psnr, time; /**< dB; seconds, NaN if it has none */
} adcgs_sweep_picture;
/** Renders the worst and the middle test view of the representative run again (views_chart.c). */
adcgs_status adcgs_sweep_pictures(const adcgs_sweep *sweep, const adcgs_sweep_plan *plan,
                                  adcgs_sweep_picture picture[ADCGS_SWEEP_PICTURES], adcgs_error *error);

/** Makes the charts (charts.h) in the folder. *charts: a bit for each chart that was made. */
adcgs_status adcgs_sweep_draw(const adcgs_sweep *sweep, const adcgs_sweep_plan *plan, unsigned *charts, adcgs_error *error);
/** Prints the tables and checks as text (page.c). */
void adcgs_sweep_print(FILE *file, const adcgs_sweep_plan *plan);
/** Writes index.html in the folder: the charts, images, tables and checks in one file (page.c). */
adcgs_status adcgs_sweep_write_page(const adcgs_sweep *sweep, const adcgs_sweep_plan *plan, unsigned charts, adcgs_error *error);

#endif

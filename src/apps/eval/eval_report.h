/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The report of adcgs-eval on the views: text or JSON on standard output, and CSV. One table of columns drives all of them.
 */
#ifndef ADCGS_APPS_EVAL_EVAL_REPORT_H
#define ADCGS_APPS_EVAL_EVAL_REPORT_H

#include "cli/cli.h"
#include "metric/crop.h"
#include "system/atomic.h"
#include "system/json.h"

/** Values of a row; NaN if there is none. */
typedef enum adcgs_eval_column {
    ADCGS_EVAL_PSNR,
    ADCGS_EVAL_SSIM,
    ADCGS_EVAL_FITTED_PSNR,
    ADCGS_EVAL_MS_SSIM,
    ADCGS_EVAL_MS_SSIM_SCALES,
    ADCGS_EVAL_DYNAMIC_PSNR,
    ADCGS_EVAL_FITTED_DYNAMIC_PSNR,
    ADCGS_EVAL_FLICKER,
    ADCGS_EVAL_DYNAMIC_SHARE,
    ADCGS_EVAL_STATIC_VARIANCE,
    ADCGS_EVAL_TRUTH_VARIANCE,
    ADCGS_EVAL_CROP_PSNR,
    ADCGS_EVAL_CROP_SSIM,
    ADCGS_EVAL_MILLISECONDS,
    ADCGS_EVAL_COLUMNS
} adcgs_eval_column;

/** Sums of a column over the rows that have a value. */
typedef struct adcgs_eval_sum {
    double sum;
    uint32_t n;
} adcgs_eval_sum;

/** A static camera. */
typedef struct adcgs_eval_camera {
    uint32_t camera, views;
    double value[ADCGS_EVAL_COLUMNS]; /**< means over its views, and values that only all its views together give */
} adcgs_eval_camera;

typedef struct adcgs_eval_report {
    /* Set by the caller. Strings must outlive the report. */
    const char *file, *scene, *split, *csv; /**< csv: a file, "-" or NULL for none */
    int measure, as_json;                   /**< flags of metric/evaluate.h */
    const adcgs_box *box;                   /**< NULL: no crops */
    uint64_t bytes;                         /**< of the stream */
    int layers;
    double decode_seconds;
    /* Private. */
    int as_text;
    adcgs_json json;
    adcgs_atomic atomic;
    FILE *table; /**< CSV output; NULL: none */
    adcgs_eval_sum of_camera[ADCGS_EVAL_COLUMNS], of_all[ADCGS_EVAL_COLUMNS];
    uint32_t camera; /**< the camera of of_camera */
    adcgs_eval_camera *cameras;
    uint32_t n_cameras;
} adcgs_eval_report;

/**
 * Parses the value of --metrics: all, or names with commas between. Returns 0, or -1 if text is neither. *measure: flags of
 * metric/evaluate.h.
 */
int adcgs_eval_parse_metrics(const char *text, int *measure);
/** For messages: "all, or some of psnr, ...". */
#define ADCGS_EVAL_METRICS \
    "all, or a list of psnr, ssim, fitted-psnr, ms-ssim, dynamic-psnr, fitted-dynamic-psnr, static-variance and flicker"

/** Opens the CSV before anything long begins. Set csv and as_json before. A CSV on standard output replaces the text. */
adcgs_status adcgs_eval_report_open(adcgs_eval_report *report, adcgs_error *error);
/** Writes headings. */
void adcgs_eval_report_begin(adcgs_eval_report *report);
/** Reports a view; crop may be out of sight. After the last view of a fixed camera, reports the camera, too. */
adcgs_status adcgs_eval_report_view(adcgs_eval_report *report, const adcgs_view_score *score, const adcgs_crop *crop,
                                    adcgs_error *error);
/** Writes the means and completes the output. */
adcgs_status adcgs_eval_report_end(adcgs_eval_report *report, const adcgs_evaluation *evaluation, adcgs_error *error);
/** Call it after errors, too: it removes an incomplete CSV. */
void adcgs_eval_report_clear(adcgs_eval_report *report);

#endif

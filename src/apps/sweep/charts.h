/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The charts of a sweep. Each is a script NAME.gp in the sweep's folder, from which gnuplot makes NAME.svg and NAME.pdf. A chart
 * without data is not made.
 */
#ifndef ADCGS_APPS_SWEEP_CHARTS_H
#define ADCGS_APPS_SWEEP_CHARTS_H

#include "apps/sweep/sweep.h"
#include "system/atomic.h"

/** Opens a script; adcgs_atomic_commit() completes it. */
adcgs_status adcgs_chart_open(adcgs_atomic *file, const adcgs_sweep *sweep, const char *name, adcgs_error *error);
/** Renders the chart with gnuplot. *drawn: 0 without gnuplot. */
adcgs_status adcgs_chart_draw(const adcgs_sweep *sweep, const char *name, int *drawn, adcgs_error *error);

/** Quantities of the axes. */
typedef enum adcgs_quantity {
    ADCGS_Q_BYTES,
    ADCGS_Q_SECONDS,
    ADCGS_Q_SPEED,
    ADCGS_Q_PSNR,
    ADCGS_Q_MOVING,
    ADCGS_Q_SSIM,
    ADCGS_Q_COUNT
} adcgs_quantity;

/** A chart of the page. */
typedef struct adcgs_chart adcgs_chart;
typedef adcgs_status adcgs_chart_make(const adcgs_chart *chart, const adcgs_sweep *sweep, const adcgs_sweep_plan *plan,
                                      int *drawn, adcgs_error *error);
struct adcgs_chart {
    const char *name, *title; /**< of its files; of the chart */
    adcgs_chart_make *make;
    adcgs_quantity x, y; /**< of curves */
};

/** One quantity of points against another, for all curves and yardsticks. */
adcgs_chart_make adcgs_chart_curves;
/** Distribution of each stream's bytes. */
adcgs_chart_make adcgs_chart_bytes;
/** Quality of each test view over time, of one run. */
adcgs_chart_make adcgs_chart_views;
/** Quality of each test view, by camera, of one run. */
adcgs_chart_make adcgs_chart_errors;
/** Quality of decoded parts of the stream, of one run. */
adcgs_chart_make adcgs_chart_portions;

/** All charts, in the order of the page; the last has no name. */
extern const adcgs_chart adcgs_charts[];

#endif

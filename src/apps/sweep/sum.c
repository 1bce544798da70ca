/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Summaries of a sweep's runs: means over seeds, rows, and the comparison of curves. */
#include "config.h"

#include "apps/sweep/sweep.h"

#include "metric/curve.h"

#include <math.h>

/** A point at most this much below another counts as equal, dB; chosen by hand, not measured. */
#define EQUAL_DB 0.1
/** Minimum relative difference of sizes that counts as fewer bytes; chosen by hand, not measured. */
#define FEWER 1e-6

adcgs_spread adcgs_sweep_spread(const adcgs_sweep_plan *plan, int cell, adcgs_figure figure)
{
    const adcgs_sweep_cell *const c = &plan->cell[cell];
    adcgs_spread s = {0, 0, (double)NAN, (double)NAN};
    for (int i = 0; i < c->n; i++) {
        const double x = plan->run[c->run[i]].figure[figure];
        if (plan->run[c->run[i]].state != ADCGS_RUN_DONE || !isfinite(x))
            continue;
        s.n++;
        s.mean += x;
        s.min = fmin(s.min, x); /* of a number and a NaN, these return the number */
        s.max = fmax(s.max, x);
    }
    s.mean = s.n ? s.mean / s.n : (double)NAN;
    return s;
}

int adcgs_sweep_row_make(adcgs_sweep_row *row, const adcgs_sweep_plan *plan, const char *name, int cell, adcgs_figure size)
{
    const adcgs_sweep_run *const first = &plan->run[plan->cell[cell].run[0]];
    *row = (adcgs_sweep_row){.name = name,
                             .lambda = first->lambda,
                             .is_stream = size == ADCGS_FIGURE_BYTES,
                             .bytes = adcgs_sweep_spread(plan, cell, size),
                             .psnr = adcgs_sweep_spread(plan, cell, ADCGS_FIGURE_PSNR),
                             .moving = adcgs_sweep_spread(plan, cell, ADCGS_FIGURE_MOVING),
                             .ssim = adcgs_sweep_spread(plan, cell, ADCGS_FIGURE_SSIM),
                             .seconds = adcgs_sweep_spread(plan, cell, ADCGS_FIGURE_SECONDS),
                             .speed = adcgs_sweep_spread(plan, cell, ADCGS_FIGURE_SPEED),
                             .objective = adcgs_sweep_spread(plan, cell, ADCGS_FIGURE_OBJECTIVE),
                             .networks = (double)NAN};
    memcpy(row->choice, first->choice, sizeof row->choice);
    if (row->is_stream)
        row->networks = adcgs_sweep_spread(plan, cell, ADCGS_FIGURE_NETWORKS).mean / row->bytes.mean;
    return row->bytes.n > 0;
}

int adcgs_sweep_point(adcgs_sweep_row *row, const adcgs_sweep_plan *plan, const adcgs_sweep_curve *curve, int index)
{
    if (!curve->earlier)
        return adcgs_sweep_row_make(row, plan, curve->name, curve->cell[index], curve->size);
    *row = curve->point[index];
    return 1;
}

/** moving: the quality is that of moving regions, NaN if unknown. */
static int points_of(adcgs_curve_point points[ADCGS_SWEEP_LIST], const adcgs_sweep_plan *plan, const adcgs_sweep_curve *curve,
                     int moving)
{
    int n = 0;
    for (int i = 0; i < curve->n; i++) {
        adcgs_sweep_row row;
        if (adcgs_sweep_point(&row, plan, curve, i))
            points[n++] = (adcgs_curve_point){row.bytes.mean, moving ? row.moving.mean : row.psnr.mean};
    }
    return n;
}

/** BD-rate of the codec's own curve against another, NaN if it is undefined. */
static double rate_against(const adcgs_sweep_plan *plan, const adcgs_sweep_curve *other, int moving)
{
    adcgs_curve_point own[ADCGS_SWEEP_LIST] = {{0, 0}}, theirs[ADCGS_SWEEP_LIST] = {{0, 0}};
    const int n_own = points_of(own, plan, &plan->curve[0], moving), n = points_of(theirs, plan, other, moving);
    double percent;
    return adcgs_bd_rate(theirs, n, own, n_own, &percent, NULL) == ADCGS_OK ? percent : (double)NAN;
}

adcgs_curve_facts adcgs_sweep_facts(const adcgs_sweep_plan *plan)
{
    adcgs_curve_point p[ADCGS_SWEEP_LIST];
    adcgs_curve_facts facts = {0, 0, (double)NAN};
    double least = (double)NAN, most = (double)NAN;
    facts.n = plan->n_curves ? points_of(p, plan, &plan->curve[0], 0) : 0;
    for (int i = 0; i < facts.n; i++) {
        least = fmin(least, p[i].bytes);
        most = fmax(most, p[i].bytes);
    }
    facts.monotone = adcgs_curve_is_monotone(p, facts.n);
    facts.span = most / least;
    return facts;
}

/** Bytes of the other curve's best point over those of our smallest point at most 0.1 dB worse. */
static double times_smaller(const adcgs_curve_point *own, int n_own, const adcgs_curve_point *other, int n_other)
{
    int best = 0;
    double least = (double)NAN;
    for (int i = 1; i < n_other; i++)
        if (other[i].quality > other[best].quality)
            best = i;
    for (int i = 0; n_other && i < n_own; i++)
        if (own[i].quality >= other[best].quality - EQUAL_DB)
            least = fmin(least, own[i].bytes);
    return n_other ? other[best].bytes / least : (double)NAN;
}

adcgs_comparison adcgs_sweep_compare(const adcgs_sweep_plan *plan, const adcgs_sweep_curve *other)
{
    adcgs_curve_point own[ADCGS_SWEEP_LIST] = {{0, 0}}, theirs[ADCGS_SWEEP_LIST] = {{0, 0}};
    const int n_own = points_of(own, plan, &plan->curve[0], 0), n = points_of(theirs, plan, other, 0);
    adcgs_comparison c = {.bd_rate = rate_against(plan, other, 0),
                          .bd_rate_moving = rate_against(plan, other, 1),
                          .margin = (double)NAN};
    for (int i = 0; i < n; i++) {
        const double quality = adcgs_curve_quality(own, n_own, theirs[i].bytes * (1 - FEWER));
        if (isnan(quality)) {
            c.beyond++;
            continue;
        }
        c.compared++;
        c.margin = fmin(c.margin, quality - theirs[i].quality);
    }
    c.above = c.compared > 0 && c.margin >= 0;
    c.smaller = times_smaller(own, n_own, theirs, n);
    return c;
}

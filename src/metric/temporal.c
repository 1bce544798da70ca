/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Quality over time, in running sums. The region is known before variances
 * begin. So the squares of all static pixels share one sum (Welford's, which is
 * accurate for large means), and only means are stored per pixel. The difference
 * of two changes is the change of the error, so flicker needs only one image of
 * errors.
 */
#include "config.h"

#include "metric/temporal.h"

#include "metric/metric.h"
#include "metric/region.h"

#include <math.h>

/** Running statistics of values over time. */
typedef struct moments {
    double *mean;  /* [3][plane] */
    double square; /* sum over static values of squared distances from their means */
} moments;

struct adcgs_temporal {
    int width, height;
    size_t plane, moving; /* pixels; pixels in the region */
    uint32_t looked, n;   /* images of the first pass, of the second */
    float *low, *high;    /* [3][plane] of the truth; until the region is found */
    uint8_t *region;      /* [plane] */
    double *error;        /* [3][plane] decoded - true of the previous image */
    moments decoded, truth;
};

static void free_range(adcgs_temporal *t)
{
    adcgs_free(NULL, t->low);
    adcgs_free(NULL, t->high);
    t->low = t->high = NULL;
}

void adcgs_temporal_free(adcgs_temporal **temporal)
{
    adcgs_temporal *t = *temporal;
    if (!t)
        return;
    free_range(t);
    adcgs_free(NULL, t->region);
    adcgs_free(NULL, t->error);
    adcgs_free(NULL, t->decoded.mean);
    adcgs_free(NULL, t->truth.mean);
    adcgs_free(NULL, t);
    *temporal = NULL;
}

adcgs_status adcgs_temporal_create(adcgs_temporal **out, int width, int height, adcgs_error *error)
{
    adcgs_temporal *t = *out = adcgs_alloc(NULL, 1, sizeof *t, error);
    if (!t)
        return adcgs_alloc_status(error);
    t->width = width;
    t->height = height;
    t->plane = (size_t)width * (size_t)height;
    t->low = adcgs_alloc(NULL, 3 * t->plane, sizeof *t->low, error);
    t->high = adcgs_alloc(NULL, 3 * t->plane, sizeof *t->high, error);
    t->region = adcgs_alloc(NULL, t->plane, 1, error);
    if (t->low && t->high && t->region)
        return ADCGS_OK;
    adcgs_temporal_free(out);
    return adcgs_alloc_status(error);
}

/* ---- The region ---- */

void adcgs_temporal_look(adcgs_temporal *t, const float *truth)
{
    for (size_t i = 0; i < 3 * t->plane; i++) {
        t->low[i] = t->looked ? fminf(t->low[i], truth[i]) : truth[i];
        t->high[i] = t->looked ? fmaxf(t->high[i], truth[i]) : truth[i];
    }
    t->looked++;
}

adcgs_status adcgs_temporal_find_region(adcgs_temporal *t, adcgs_error *error)
{
    uint8_t *scratch = adcgs_alloc(NULL, t->plane, 1, error);
    t->error = adcgs_alloc(NULL, 3 * t->plane, sizeof *t->error, error);
    t->decoded.mean = adcgs_alloc(NULL, 3 * t->plane, sizeof *t->decoded.mean, error);
    t->truth.mean = adcgs_alloc(NULL, 3 * t->plane, sizeof *t->truth.mean, error);
    if (!scratch || !t->error || !t->decoded.mean || !t->truth.mean) {
        adcgs_free(NULL, scratch);
        return adcgs_alloc_status(error);
    }
    for (size_t i = 0; i < 3 * t->plane; i++)
        t->region[i % t->plane] |= (double)t->high[i] - (double)t->low[i] > ADCGS_CHANGE_LEAST;
    free_range(t);
    adcgs_region_majority(t->region, scratch, t->width, t->height, ADCGS_CHANGE_NEAR);
    adcgs_region_dilate(t->region, scratch, t->width, t->height, ADCGS_CHANGE_REACH);
    for (size_t i = 0; i < t->plane; i++)
        t->moving += t->region[i];
    adcgs_free(NULL, scratch);
    return ADCGS_OK;
}

const uint8_t *adcgs_temporal_region(const adcgs_temporal *t)
{
    return t->region;
}

/* ---- The comparison ---- */

static void take_value(moments *m, size_t i, double value, uint32_t n)
{
    const double away = value - m->mean[i];
    m->mean[i] += away / n;
    m->square += away * (value - m->mean[i]);
}

adcgs_temporal_view adcgs_temporal_add(adcgs_temporal *t, const float *decoded, const float *truth)
{
    double squares = 0.0, changes = 0.0;
    t->n++;
    for (size_t i = 0; i < 3 * t->plane; i++) {
        const double seen = (double)(isnan(truth[i]) ? decoded[i] : truth[i]); /* unknown pixels count as correct */
        const double difference = (double)decoded[i] - seen;
        changes += fabs(difference - t->error[i]);
        t->error[i] = difference;
        if (t->region[i % t->plane]) {
            squares += difference * difference;
        } else {
            take_value(&t->decoded, i, (double)decoded[i], t->n);
            take_value(&t->truth, i, seen, t->n);
        }
    }
    return (adcgs_temporal_view){
        .dynamic_psnr = t->moving ? adcgs_psnr_from_mse(squares / (3.0 * (double)t->moving)) : (double)NAN,
        .flicker = t->n > 1 ? changes / (3.0 * (double)t->plane) : (double)NAN,
    };
}

adcgs_temporal_total adcgs_temporal_end(const adcgs_temporal *t)
{
    const double values = 3.0 * (double)(t->plane - t->moving) * t->n; /* 0 / 0 without static pixels */
    return (adcgs_temporal_total){
        .views = t->n,
        .dynamic_share = (double)t->moving / (double)t->plane,
        .static_variance = t->decoded.square / values,
        .truth_variance = t->truth.square / values,
    };
}

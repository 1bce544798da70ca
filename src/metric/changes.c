/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Changes over time, value by value. */
#include "config.h"

#include "metric/changes.h"

#include "metric/region.h"
#include "metric/temporal.h"

#include <math.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
/* Upper bound of the histogram of steps between successive images, of values 0..1; larger steps share one more bin. */
#define STEP_MOST 0.1F
enum { STEP_BINS = 1000 }; /* bins of the histogram */
/* Largest change by noise [its standard deviations]. */
#define NOISE_RANGE 5.0  /* of most pixels */
#define NOISE_ALONE 12.0 /* of any single pixel */
/* Multiple of `least` above which a pixel needs no changing neighbours. */
#define ALONE 1.5
/* Share of the mean square error below which changes are not worth modelling. */
#define WORTH 0.25

struct adcgs_changes {
    int width, height;
    size_t values;
    float *low, *high, *last; /* [values] minimum, maximum, previous value */
    double *sum, *square;     /* [values] */
    uint32_t *known;          /* [values] number of images in which it is not NaN */
    uint64_t steps[STEP_BINS + 1];
};

void adcgs_changes_free(adcgs_changes **changes)
{
    adcgs_changes *c = *changes;
    if (!c)
        return;
    adcgs_free(NULL, c->low);
    adcgs_free(NULL, c->sum);
    adcgs_free(NULL, c->known);
    adcgs_free(NULL, c);
    *changes = NULL;
}

adcgs_status adcgs_changes_create(adcgs_changes **out, int width, int height, adcgs_error *error)
{
    const size_t values = 3 * (size_t)width * (size_t)height;
    adcgs_changes *c = *out = adcgs_alloc(NULL, 1, sizeof *c, error);
    if (!c)
        return adcgs_alloc_status(error);
    c->width = width;
    c->height = height;
    c->values = values;
    c->low = adcgs_alloc(NULL, 3 * values, sizeof *c->low, error);
    c->sum = adcgs_alloc(NULL, 2 * values, sizeof *c->sum, error);
    c->known = adcgs_alloc(NULL, values, sizeof *c->known, error);
    if (!c->low || !c->sum || !c->known) {
        adcgs_changes_free(out);
        return adcgs_alloc_status(error);
    }
    c->high = c->low + values;
    c->last = c->high + values;
    c->square = c->sum + values;
    return ADCGS_OK;
}

void adcgs_changes_add(adcgs_changes *c, const float *picture)
{
    for (size_t i = 0; i < c->values; i++) {
        const float now = picture[i];
        if (isnan(now))
            continue;
        const float step = fabsf(now - c->last[i]);
        if (c->known[i])
            c->steps[step < STEP_MOST ? (int)(step / STEP_MOST * STEP_BINS) : STEP_BINS]++;
        c->low[i] = c->known[i] ? fminf(c->low[i], now) : now;
        c->high[i] = c->known[i] ? fmaxf(c->high[i], now) : now;
        c->last[i] = now;
        c->sum[i] += (double)now;
        c->square[i] += (double)now * (double)now;
        c->known[i]++;
    }
}

/**
 * Steps of static values are normal, with twice the noise variance. Half of these steps, a quarter of all, lie below the bound.
 */
double adcgs_changes_noise(const adcgs_changes *c)
{
    static const double bound = 0.6745 * 1.4142; /* in standard deviations of the noise */
    uint64_t all = 0, sum = 0;
    int i = 0;
    for (int j = 0; j <= STEP_BINS; j++)
        all += c->steps[j];
    while (i < STEP_BINS && 4 * (sum += c->steps[i]) < all)
        i++;
    return (i + 0.5) * (double)STEP_MOST / STEP_BINS / bound;
}

/** Mean variance, less the noise variance, of the values that change by more than `low` and at most `least`. */
static double spread_between(const adcgs_changes *c, double low, double least, double noise)
{
    double sum = 0;
    size_t n = 0;
    for (size_t i = 0; i < c->values; i++) {
        const double change = (double)c->high[i] - (double)c->low[i];
        if (!c->known[i] || change <= low || change > least)
            continue;
        const double mean = c->sum[i] / c->known[i];
        sum += fmax(c->square[i] / c->known[i] - mean * mean - noise * noise, 0);
        n++;
    }
    return n ? sum / (double)n : 0;
}

double adcgs_changes_least(const adcgs_changes *c, double unseen, double mse)
{
    const double noise = adcgs_changes_noise(c), low = fmin(fmax(NOISE_RANGE * noise, unseen), ADCGS_CHANGE_LEAST);
    double least = ADCGS_CHANGE_LEAST;
    while (least > low && spread_between(c, low, least, noise) > WORTH * mse)
        least = fmax(low, least / 2);
    return least;
}

/** The largest change of a pixel's channels. */
static double change_of(const adcgs_changes *c, size_t pixel)
{
    const size_t plane = c->values / 3;
    float most = 0;
    for (size_t i = pixel; i < c->values; i += plane)
        most = fmaxf(most, c->high[i] - c->low[i]);
    return (double)most;
}

adcgs_status adcgs_changes_region(const adcgs_changes *c, double least, uint8_t *region, adcgs_error *error)
{
    const double alone = fmax(ALONE * least, NOISE_ALONE * adcgs_changes_noise(c));
    const size_t plane = c->values / 3;
    uint8_t *const scratch = adcgs_alloc(NULL, plane, 1, error);
    if (!scratch)
        return adcgs_alloc_status(error);
    for (size_t i = 0; i < plane; i++)
        region[i] = change_of(c, i) > least;
    adcgs_region_majority(region, scratch, c->width, c->height, ADCGS_CHANGE_NEAR);
    for (size_t i = 0; i < plane; i++)
        region[i] |= change_of(c, i) > alone;
    adcgs_region_dilate(region, scratch, c->width, c->height, ADCGS_CHANGE_REACH);
    adcgs_free(NULL, scratch);
    return ADCGS_OK;
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Detects a camera whose clock is off by whole frames. Sudden changes (jerks, starts, stops) appear in all cameras at once. The
 * detector compares how much images change from frame to frame, after it has removed changes that are smooth in time. A passing
 * object is nearest to one camera earlier than to another, without any fault.
 */
#include "config.h"

#include "check/faults.h"

#include "system/sort_values.h"

#include <math.h>
#include <stdlib.h>

/*
 * Origin: chosen by hand, and checked on 46 generated scenes and six others without faults, and on faults of known strength
 * (doc/log/stability.md, "Warnings about footage").
 */
#define CAMERAS 3      /* least number of cameras: of two that differ, either may be wrong */
#define CHANGES_MIN 12 /* least number of changes in common, at any shift */
#define STRONG 4       /* least number of strong changes: a camera may simply have seen a single event later */
#define REACH 2        /* changes to either side; their median is the smooth part */
/*
 * Correlations with the mean of the other cameras. They were calibrated on 32 generated scenes filmed by four correct cameras,
 * and on rigs of 4, 8 and 17 cameras. Where cameras agree by 0.8 and more (bounce, collide, merge, race, soft, clip,
 * synth_robot_multiview), no shift fits any camera better. With one camera of clip 1 to 5 frames off, the shift gains 1.0 and
 * more, and matches by 0.9. Without sudden changes cameras agree by less than 0.8, and shifts gain up to 1.4 by chance: nothing
 * is reported.
 */
#define AGREE 0.8  /* least median correlation of the other cameras with each other */
#define MATCH 0.7  /* least correlation of the suspected camera, at its shift */
#define GAIN 0.4   /* least increase of this correlation by the shift */
#define UNIQUE 0.2 /* least lead over shifts that are not adjacent: repeated motion matches at many shifts */

/** Changes of all cameras from frame to frame: [cameras][steps], NaN if one of the two images is missing. */
typedef struct signals {
    uint32_t cameras, steps;
    double *values;
    double *mean;                   /* [steps] over all cameras except one or two */
    double *times;                  /* [steps + 1] */
    const adcgs_scene_view **first; /* [cameras] first view of each */
} signals;

static double median_around(const double *values, uint32_t n, uint32_t at)
{
    double near[2 * REACH + 1];
    size_t count = 0;
    for (uint32_t i = at > REACH ? at - REACH : 0; i < n && i <= at + REACH; i++)
        if (!isnan(values[i]))
            near[count++] = values[i];
    adcgs_sort(near, count);
    return count % 2 ? near[count / 2] : 0.5 * (near[count / 2 - 1] + near[count / 2]);
}

/** Removes the smooth part and scales the rest to mean 0 and deviation 1. buffer: [n]. Returns 0 if too little is left. */
static int sharpen(double *values, uint32_t n, double *buffer)
{
    double sum = 0.0, square = 0.0;
    uint32_t count = 0, strong = 0;
    for (uint32_t i = 0; i < n; i++)
        buffer[i] = isnan(values[i]) ? values[i] : values[i] - median_around(values, n, i);
    for (uint32_t i = 0; i < n; i++)
        if (!isnan(buffer[i])) {
            sum += buffer[i];
            square += buffer[i] * buffer[i];
            count++;
        }
    const double mean = count ? sum / count : 0.0, deviation = count ? sqrt(fmax(square / count - mean * mean, 0.0)) : 0.0;
    for (uint32_t i = 0; i < n; i++)
        values[i] = deviation > 0.0 ? (buffer[i] - mean) / deviation : (double)NAN;
    for (uint32_t i = 0; i < n; i++)
        strong += fabs(values[i]) >= 0.5;
    return count >= CHANGES_MIN && strong >= STRONG;
}

/** Correlation of a camera with a mean that it follows by `late` steps; NaN if they have too little in common. */
static double correlate(const double *a, const double *b, uint32_t n, int late)
{
    double s[5] = {0.0, 0.0, 0.0, 0.0, 0.0};
    uint32_t count = 0;
    for (int64_t i = 0; i < (int64_t)n; i++) {
        const int64_t j = i - late;
        if (j < 0 || j >= (int64_t)n || isnan(a[i]) || isnan(b[j]))
            continue;
        s[0] += a[i];
        s[1] += b[j];
        s[2] += a[i] * a[i];
        s[3] += b[j] * b[j];
        s[4] += a[i] * b[j];
        count++;
    }
    const double va = s[2] - s[0] * s[0] / count, vb = s[3] - s[1] * s[1] / count;
    return count >= CHANGES_MIN && va > 0.0 && vb > 0.0 ? (s[4] - s[0] * s[1] / count) / sqrt(va * vb) : (double)NAN;
}

/** Mean of all cameras except one or two. */
static void take_mean(signals *s, uint32_t without, uint32_t and_without)
{
    for (uint32_t i = 0; i < s->steps; i++) {
        double sum = 0.0;
        uint32_t count = 0;
        for (uint32_t c = 0; c < s->cameras; c++) {
            const double value = s->values[(size_t)c * s->steps + i];
            if (c == without || c == and_without || isnan(value))
                continue;
            sum += value;
            count++;
        }
        s->mean[i] = count ? sum / count : (double)NAN;
    }
}

/**
 * Returns by how many steps a camera is late. *match: its correlation at this shift; *gain: the increase of the correlation by
 * the shift, 0 if the camera is synchronised or the shift is ambiguous.
 */
static int find_shift(const double *values, const signals *s, double *gain, double *match)
{
    const int most = (int)ADCGS_MIN(s->steps - CHANGES_MIN, s->steps / 2);
    int late = 0;
    double best = correlate(values, s->mean, s->steps, 0), other = -1.0;
    const double now = best;
    *gain = *match = 0.0;
    if (isnan(now))
        return 0;
    for (int k = -most; k <= most; k++) {
        const double r = correlate(values, s->mean, s->steps, k);
        if (r > best) {
            best = r;
            late = k;
        }
    }
    for (int k = -most; k <= most; k++)
        if (abs(k - late) > 1)
            other = fmax(other, correlate(values, s->mean, s->steps, k));
    *match = best;
    *gain = late && best - other >= UNIQUE ? best - now : 0.0;
    return late;
}

/** Agreement of all cameras except one: the median correlation of one of them with the others. agreed: [cameras]. */
static double agreement(signals *s, uint32_t without, double *agreed)
{
    uint32_t n = 0;
    for (uint32_t c = 0; c < s->cameras; c++) {
        if (c == without)
            continue;
        take_mean(s, without, c);
        const double r = correlate(s->values + (size_t)c * s->steps, s->mean, s->steps, 0);
        agreed[n++] = isnan(r) ? -1.0 : r;
    }
    adcgs_sort(agreed, n);
    return n % 2 ? agreed[n / 2] : 0.5 * (agreed[n / 2 - 1] + agreed[n / 2]);
}

static void judge(adcgs_fault *f, signals *s, double *agreed)
{
    for (uint32_t c = 0; c < s->cameras; c++) {
        double gain, match;
        take_mean(s, c, c);
        const double *const values = s->values + (size_t)c * s->steps;
        const int late = find_shift(values, s, &gain, &match);
        if (match < MATCH || gain < GAIN || agreement(s, c, agreed) < AGREE)
            continue;
        f->cameras++;
        if (f->cameras > 1 && gain <= f->to)
            continue;
        f->to = gain;
        f->path = s->first[c]->path;
        f->size = late * (s->times[s->steps] - s->times[0]) / s->steps;
        f->count = (uint32_t)abs(late);
    }
    f->from = f->to = 0.0;
    if (2 * f->cameras >= s->cameras)
        f->cameras = 0;
}

/** Index of a view's time in s->times, which holds it to within a thousandth of a step. */
static uint32_t find_step(const signals *s, double time)
{
    uint32_t low = 0, high = s->steps;
    while (low < high) {
        const uint32_t middle = (low + high) / 2;
        if (s->times[middle] < time)
            low = middle + 1;
        else
            high = middle;
    }
    return low && time - s->times[low - 1] < s->times[low] - time ? low - 1 : low;
}

/** Lists the distinct times of all views; times that differ only by rounding count as one. */
static void take_times(signals *s, const adcgs_scene_view *views, uint32_t n)
{
    uint32_t count = 1;
    for (uint32_t i = 0; i < n; i++)
        s->times[i] = views[i].time;
    adcgs_sort(s->times, n);
    const double tolerance = ADCGS_TIME_TOLERANCE * (s->times[n - 1] - s->times[0]);
    for (uint32_t i = 1; i < n; i++)
        if (s->times[i] - s->times[count - 1] > tolerance)
            s->times[count++] = s->times[i];
    s->steps = count - 1;
}

/** Computes the signals of the cameras that have enough strong changes, and sets s->cameras to their number. */
static void take_signals(signals *s, const adcgs_camera_order *tracks, const adcgs_scene_view *views,
                         const adcgs_thumbnail *thumbnails)
{
    for (uint32_t c = 0; c < tracks->n; c++) {
        double *const values = s->values + (size_t)s->cameras * s->steps;
        const uint32_t *const order = tracks->order + tracks->begin[c], n = tracks->begin[c + 1] - tracks->begin[c];
        for (uint32_t i = 0; i < s->steps; i++)
            values[i] = (double)NAN;
        for (uint32_t i = 1; i < n; i++) {
            const uint32_t at = find_step(s, views[order[i]].time);
            if (at && find_step(s, views[order[i - 1]].time) == at - 1)
                values[at - 1] = adcgs_thumbnail_difference(&thumbnails[order[i - 1]], &thumbnails[order[i]]);
        }
        s->first[s->cameras] = &views[order[0]];
        s->cameras += (uint32_t)sharpen(values, s->steps, s->mean);
    }
}

static adcgs_status compare_clocks(adcgs_fault *f, signals *s, const adcgs_camera_order *tracks, const adcgs_scene_view *views,
                                   const adcgs_thumbnail *thumbnails, adcgs_error *error)
{
    double *const agreed = adcgs_alloc(NULL, tracks->n, sizeof *agreed, error);
    s->values = adcgs_alloc(NULL, (size_t)tracks->n * s->steps, sizeof *s->values, error);
    s->mean = adcgs_alloc(NULL, s->steps, sizeof *s->mean, error);
    s->first = adcgs_alloc(NULL, tracks->n, sizeof *s->first, error);
    const adcgs_status status = agreed && s->values && s->mean && s->first ? ADCGS_OK : adcgs_alloc_status(error);
    if (status == ADCGS_OK)
        take_signals(s, tracks, views, thumbnails);
    f->of = s->cameras;
    if (status == ADCGS_OK && s->cameras >= CAMERAS)
        judge(f, s, agreed);
    adcgs_free(NULL, agreed);
    adcgs_free(NULL, s->values);
    adcgs_free(NULL, s->mean);
    adcgs_free(NULL, s->first);
    return status;
}

adcgs_status adcgs_fault_clocks(adcgs_fault *fault, const adcgs_scene_view *views, const adcgs_camera_order *tracks,
                                const adcgs_thumbnail *thumbnails, adcgs_error *error)
{
    *fault = (adcgs_fault){.cameras = 0};
    if (tracks->n < CAMERAS)
        return ADCGS_OK;
    const uint32_t n = tracks->begin[tracks->n];
    signals s = {.times = adcgs_alloc(NULL, n, sizeof *s.times, error)};
    adcgs_status status = s.times ? ADCGS_OK : adcgs_alloc_status(error);
    if (status == ADCGS_OK)
        take_times(&s, views, n);
    if (status == ADCGS_OK && s.steps >= CHANGES_MIN)
        status = compare_clocks(fault, &s, tracks, views, thumbnails, error);
    adcgs_free(NULL, s.times);
    return status;
}

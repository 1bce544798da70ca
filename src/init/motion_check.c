/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Checks the motion that matching found. */
#include "config.h"

#include "init/motion_check.h"

#include "system/sort_values.h"

#include <math.h>

/*
 * Least share of the moving points that belong to bodies or leave static surfaces. Calibrated on zju313_15f, which has none, and
 * on generated scenes, which keep their lifetimes (doc/log/robustness.md, "Lifetimes need motion that was measured").
 */
#define OWN_LEAST 0.02
/*
 * Camera distances per clip: slower motion is found without lifetimes; calibrated on the films cross80, cross20, turn1 and demo.
 */
#define FILM_FAR 0.4
#define AHEAD 4      /* frames, of the prediction; chosen by hand, not measured */
#define SAMPLES 1000 /* points that predict; chosen by hand, not measured */
/*
 * Median error of the prediction, in distances of neighbours: 12 to 16 in four generated films, 41 in nrnerf_hand, whose
 * velocities are wrong. Calibrated on these five.
 */
#define PREDICT_MOST 25.0

static int is_independent(const adcgs_stereo_point *p)
{
    return p->body || !p->in_place;
}

static uint32_t count_independent(const adcgs_stereo *found)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < found->n_moving; i++)
        n += (uint32_t)is_independent(&found->moving[i]);
    return n;
}

/** Median speed of the points that do not lie on static surfaces. */
static adcgs_status find_speed(double *speed, const adcgs_stereo *found, adcgs_error *error)
{
    double *const all = adcgs_alloc(NULL, (size_t)found->n_moving + 1, sizeof *all, error);
    uint32_t n = 0;
    if (!all)
        return adcgs_alloc_status(error);
    for (uint32_t i = 0; i < found->n_moving; i++) {
        const float *v = found->moving[i].velocity;
        if (!found->moving[i].in_place)
            all[n++] = sqrt((double)(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]));
    }
    adcgs_sort(all, n);
    *speed = n ? all[n / 2] : 0;
    adcgs_free(NULL, all);
    return ADCGS_OK;
}

/** Distance from the point's predicted position in a frame to the nearest other moving point there; negative without one. */
static double error_in(const adcgs_stereo *found, uint32_t point, float time)
{
    const adcgs_stereo_point *const p = &found->moving[point];
    double least = INFINITY;
    for (uint32_t i = 0; i < found->n_moving; i++) {
        const adcgs_stereo_point *const q = &found->moving[i];
        double sum = 0;
        if (q->in_place || i == point || q->t < time || q->t > time)
            continue;
        for (int a = 0; a < 3; a++) {
            const double d = p->x[a] + (double)p->velocity[a] * (double)(time - p->t) - q->x[a];
            sum += d * d;
        }
        least = fmin(least, sum);
    }
    return isfinite(least) ? sqrt(least) : -1;
}

/** Median error of predictions over some frames; 0 frames: the distance of neighbours. 0 if nothing can be predicted. */
static adcgs_status find_error(double *median, const adcgs_stereo *found, uint32_t ahead, adcgs_error *error)
{
    double *const all = adcgs_alloc(NULL, SAMPLES + 1, sizeof *all, error);
    const uint32_t step = found->n_moving / SAMPLES + 1;
    uint32_t n = 0;
    if (!all)
        return adcgs_alloc_status(error);
    for (uint32_t i = 0, frame = 0; i < found->n_moving; i += step) {
        if (found->moving[i].in_place)
            continue;
        while (frame < found->n_frames && found->frame_time[frame] < found->moving[i].t)
            frame++;
        if (frame + ahead >= found->n_frames)
            continue;
        const double e = error_in(found, i, found->frame_time[frame + ahead]);
        if (e >= 0)
            all[n++] = e;
    }
    adcgs_sort(all, n);
    *median = n ? all[n / 2] : 0;
    adcgs_free(NULL, all);
    return ADCGS_OK;
}

adcgs_status adcgs_stereo_check_motion(int *moves, const adcgs_stereo *found, adcgs_error *error)
{
    double speed = 0, spacing = 0, ahead = 0;
    *moves = found->n_moving > 0 && count_independent(found) >= OWN_LEAST * found->n_moving;
    if (!*moves || !found->monocular || found->n_bodies)
        return ADCGS_OK;
    ADCGS_TRY(find_speed(&speed, found, error));
    ADCGS_TRY(find_error(&spacing, found, 0, error));
    ADCGS_TRY(find_error(&ahead, found, AHEAD, error));
    *moves = speed >= FILM_FAR && ahead <= PREDICT_MOST * spacing;
    return ADCGS_OK;
}

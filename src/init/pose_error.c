/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Pose errors measured from images alone. */
#include "init/pose_error.h"

#include "init/match_window.h"
#include "system/sort_values.h"

#include <math.h>

/*
 * Origin: chosen by hand, not measured one by one. Errors as a whole are measured on scenes with and without faults
 * (doc/log/stability.md, "Warning about errors common to all poses").
 */
enum { SIDE = ADCGS_WINDOW_SIDE, WINDOW = ADCGS_WINDOW };
enum { CELL = 7 };         /* pixels between sampled windows */
enum { REACH = 4 };        /* pixels: search range to each side of an epipolar line */
enum { STEPS_MOST = 200 }; /* maximum number of steps along a line */
enum {
    MATCHES_LEAST = 12, /* minimum number of matches of a pair of cameras for a result */
    MATCHES_MOST = 1024 /* maximum number of matches of a pair of cameras */
};
enum { NEIGHBOURS = 2 }; /* per camera */
#define AXES_ALIKE 0.85  /* cosine: minimum alignment of the axes of compared cameras */
#define APART 0.02       /* scene units: minimum distance between them */
#define ALIKE 0.9        /* minimum correlation of a match */
#define SHARP 0.05       /* minimum decrease of the correlation one pixel aside; an edge along the line would match anywhere */
#define LINE_LEAST 2     /* pixels: minimum length of an epipolar line, whose direction is unclear below */

typedef struct pair {
    const adcgs_stereo_view *from, *to;
    double nearest, farthest;
    double off; /* pixels, signed; NaN: unknown */
} pair;

/** Correlations at a position on the line and at offsets perpendicular to it. */
static void compare_across(const pair *p, const float own[WINDOW], const double at[2], const double side[2],
                           const double right[2], const double down[2], double alike[2 * REACH + 1])
{
    for (int o = -REACH; o <= REACH; o++) {
        const double there[2] = {at[0] + o * side[0], at[1] + o * side[1]};
        float other[WINDOW];
        alike[o + REACH] = adcgs_window_sample(other, p->to, there, right, down) > ADCGS_WINDOW_TEXTURE
                               ? (double)adcgs_window_correlation(own, other)
                               : -1;
    }
}

/** Sub-pixel offset of a pixel's best match from its epipolar line; NaN if there is no good match. */
static double off_line(const pair *p, const float own[WINDOW], int px, int py)
{
    double ends[2][2], right[2], down[2], at[2], alike[2 * REACH + 1], off = (double)NAN, best = ALIKE;
    if (!adcgs_window_pass(p->from, p->to, px, py, p->farthest, ends[0], right, down) ||
        !adcgs_window_pass(p->from, p->to, px, py, p->nearest, ends[1], right, down))
        return (double)NAN;
    const double way[2] = {ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]}, length = hypot(way[0], way[1]);
    if (!(length >= LINE_LEAST))
        return (double)NAN;
    const double side[2] = {-way[1] / length, way[0] / length};
    const int steps = ADCGS_MIN((int)ceil(length), STEPS_MOST);
    for (int k = 0; k <= steps; k++) {
        const double inverse = 1 / p->farthest + (1 / p->nearest - 1 / p->farthest) * k / steps;
        if (!adcgs_window_pass(p->from, p->to, px, py, 1 / inverse, at, right, down) ||
            !(at[0] > 0 && at[1] > 0 && at[0] < p->to->w && at[1] < p->to->h))
            continue;
        compare_across(p, own, at, side, right, down, alike);
        for (int o = 1; o < 2 * REACH; o++) {
            const double c = alike[o], a = alike[o - 1], b = alike[o + 1];
            if (!(c > best && c > a && c > b && c - a > SHARP && c - b > SHARP))
                continue;
            best = c;
            off = o - REACH + 0.5 * (a - b) / (a - 2 * c + b);
        }
    }
    return off;
}

static void look_at_pair(void *arg, int i, int thread)
{
    pair *p = (pair *)arg + i;
    double offs[MATCHES_MOST];
    size_t n = 0;
    (void)thread;
    p->off = (double)NAN;
    for (int y = SIDE; y + SIDE < p->from->h && n < MATCHES_MOST; y += CELL)
        for (int x = SIDE; x + SIDE < p->from->w && n < MATCHES_MOST; x += CELL) {
            float own[WINDOW];
            const double at[2] = {x + 0.5, y + 0.5}, right[2] = {1, 0}, down[2] = {0, 1};
            if (!(adcgs_window_sample(own, p->from, at, right, down) > ADCGS_WINDOW_TEXTURE))
                continue;
            const double off = off_line(p, own, x, y);
            if (!isnan(off))
                offs[n++] = off;
        }
    if (n < MATCHES_LEAST)
        return;
    adcgs_sort(offs, n);
    p->off = offs[n / 2];
}

/** The nearest camera with a similar viewing direction, except `taken`; -1: none. */
static int next_neighbour(const adcgs_stereo_rig *rig, int own, int taken)
{
    const adcgs_stereo_view *const a = &rig->camera[own].view;
    int best = -1;
    for (int i = 0; i < rig->n_cameras; i++) {
        const adcgs_stereo_view *const b = &rig->camera[i].view;
        const double d = adcgs_stereo_baseline(a, b);
        if (i != own && i != taken && b->pixels && d >= APART && adcgs_stereo_axes_dot(a, b) >= AXES_ALIKE &&
            (best < 0 || d < adcgs_stereo_baseline(a, &rig->camera[best].view)))
            best = i;
    }
    return best;
}

static int find_pairs(const adcgs_stereo_rig *rig, pair *pairs)
{
    int n = 0;
    for (int i = 0; i < rig->n_cameras; i++)
        for (int k = 0, other = -1; k < NEIGHBOURS && rig->camera[i].view.pixels; k++) {
            other = next_neighbour(rig, i, other);
            if (other < 0)
                break;
            pairs[n++] = (pair){&rig->camera[i].view, &rig->camera[other].view, rig->nearest, rig->farthest, (double)NAN};
        }
    return n;
}

adcgs_status adcgs_stereo_measure_pose_error(const adcgs_stereo_rig *rig, adcgs_stereo_pose_error *out, adcgs_pool *pool,
                                             adcgs_error *error)
{
    pair *const pairs = adcgs_alloc(NULL, NEIGHBOURS * ADCGS_STEREO_CAMERAS, sizeof *pairs, error);
    double offs[NEIGHBOURS * ADCGS_STEREO_CAMERAS];
    size_t count = 0;
    if (!pairs)
        return adcgs_alloc_status(error);
    const int n = find_pairs(rig, pairs);
    adcgs_pool_run(pool, look_at_pair, pairs, n);
    for (int i = 0; i < n; i++)
        if (!isnan(pairs[i].off))
            offs[count++] = fabs(pairs[i].off);
    adcgs_sort(offs, count);
    out->pairs = (int)count;
    out->median = count ? offs[count / 2] : 0;
    adcgs_free(NULL, pairs);
    return ADCGS_OK;
}

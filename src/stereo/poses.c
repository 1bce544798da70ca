/* SPDX-License-Identifier: BSD-2-Clause */
/** \file How far poses are off, by pictures alone. */
#include "stereo/poses.h"

#include "data/sort.h"

#include <math.h>

enum { SIDE = 7, WINDOW = SIDE * SIDE };      /* pixels that are compared */
enum { CELL = 7 };                            /* pixels from one place that is looked for to the next */
enum { REACH = 4 };                           /* pixels beside a line */
enum { STEPS_MOST = 200 };                    /* along it */
enum { MATCHES_LEAST = 12, MATCHES_MOST = 1024 }; /* of a pair, that say something */
enum { NEIGHBOURS = 2 };                      /* of a camera */
#define AXES_ALIKE 0.85 /* cosine between axes of cameras that are compared */
#define APART 0.02      /* scene units between them */
#define ALIKE 0.9       /* correlation of a match */
#define SHARP 0.05      /* that it falls by, a pixel beside it: an edge along the line would match anywhere */
#define TEXTURE 4e-4f   /* variance of a window that can be found again */

typedef struct pair {
    const adcgs_stereo_view *from, *to;
    double nearest, farthest;
    double off; /* NaN: not known */
} pair;

/** Grey at a place, pixel centres at + 0.5; NaN where it is not known. */
static float grey_at(const adcgs_stereo_view *v, double x, double y)
{
    const double u = x - 0.5, w = y - 0.5;
    if (!(u >= 0 && w >= 0 && u < v->w - 1 && w < v->h - 1))
        return NAN;
    const int iu = (int)u, iv = (int)w;
    const float a = (float)(u - iu), b = (float)(w - iv), *p = v->pixels + 4 * ((size_t)iv * (size_t)v->w + (size_t)iu);
    const float *const q = p + 4 * (size_t)v->w;
    if (!(p[3] > 0.99f && p[7] > 0.99f && q[3] > 0.99f && q[7] > 0.99f))
        return NAN;
    return ((1 - b) * ((1 - a) * (p[0] + p[1] + p[2]) + a * (p[4] + p[5] + p[6])) +
            b * ((1 - a) * (q[0] + q[1] + q[2]) + a * (q[4] + q[5] + q[6]))) * (1.0f / 3);
}

/** A window in numbers of mean 0 and length 1; its variance, NaN where it is not all known. */
static float take_window(float out[WINDOW], const adcgs_stereo_view *v, const double at[2], const double right[2],
                         const double down[2])
{
    float sum = 0, square = 0;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            const double i = x - SIDE / 2, j = y - SIDE / 2;
            const float g = grey_at(v, at[0] + i * right[0] + j * down[0], at[1] + i * right[1] + j * down[1]);
            out[y * SIDE + x] = g;
            sum += g;
        }
    const float mean = sum * (1.0f / WINDOW);
    for (int i = 0; i < WINDOW; i++) {
        out[i] -= mean;
        square += out[i] * out[i];
    }
    const float over = 1 / sqrtf(fmaxf(square, 1e-12f));
    for (int i = 0; i < WINDOW; i++)
        out[i] *= over;
    return square * (1.0f / WINDOW);
}

static float product(const float a[WINDOW], const float b[WINDOW])
{
    float sum = 0;
    for (int i = 0; i < WINDOW; i++)
        sum += a[i] * b[i];
    return sum;
}

/** Where a pixel of one, at a depth, lies in the other, and where its neighbours to the right and below lie from there. */
static int pass(const pair *p, int px, int py, double depth, double at[2], double right[2], double down[2])
{
    double x[3], z, next[2], below[2];
    adcgs_stereo_rig_lift(p->from, px, py, depth, x);
    adcgs_stereo_rig_project(p->to, x, at, &z);
    if (!(z > 1e-6))
        return 0;
    adcgs_stereo_rig_lift(p->from, px + 1, py, depth, x);
    adcgs_stereo_rig_project(p->to, x, next, &z);
    if (!(z > 1e-6))
        return 0;
    adcgs_stereo_rig_lift(p->from, px, py + 1, depth, x);
    adcgs_stereo_rig_project(p->to, x, below, &z);
    if (!(z > 1e-6))
        return 0;
    for (int a = 0; a < 2; a++) {
        right[a] = next[a] - at[a];
        down[a] = below[a] - at[a];
    }
    return 1;
}

/** Correlations at a place of the line, and to its sides. */
static void compare_across(const pair *p, const float own[WINDOW], const double at[2], const double side[2],
                           const double right[2], const double down[2], double alike[2 * REACH + 1])
{
    for (int o = -REACH; o <= REACH; o++) {
        const double there[2] = { at[0] + o * side[0], at[1] + o * side[1] };
        float other[WINDOW];
        alike[o + REACH] = take_window(other, p->to, there, right, down) > TEXTURE ? (double)product(own, other) : -1;
    }
}

/** How far the best match of a pixel is beside its line, between pixels; NaN where none is good. */
static double off_line(const pair *p, const float own[WINDOW], int px, int py)
{
    double ends[2][2], right[2], down[2], at[2], alike[2 * REACH + 1], off = (double)NAN, best = ALIKE;
    if (!pass(p, px, py, p->farthest, ends[0], right, down) || !pass(p, px, py, p->nearest, ends[1], right, down))
        return (double)NAN;
    const double way[2] = { ends[1][0] - ends[0][0], ends[1][1] - ends[0][1] }, length = hypot(way[0], way[1]);
    if (!(length >= 2))
        return (double)NAN;
    const double side[2] = { -way[1] / length, way[0] / length };
    const int steps = ADCGS_MIN((int)ceil(length), STEPS_MOST);
    for (int k = 0; k <= steps; k++) {
        const double inverse = 1 / p->farthest + (1 / p->nearest - 1 / p->farthest) * k / steps;
        if (!pass(p, px, py, 1 / inverse, at, right, down) || !(at[0] > 0 && at[1] > 0 && at[0] < p->to->w && at[1] < p->to->h))
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
            const double at[2] = { x + 0.5, y + 0.5 }, right[2] = { 1, 0 }, down[2] = { 0, 1 };
            if (!(take_window(own, p->from, at, right, down) > TEXTURE))
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

/** The nearest that look the same way and are not yet taken; -1: none. */
static int next_neighbour(const adcgs_stereo_rig *rig, int own, int taken)
{
    const adcgs_stereo_view *const a = &rig->camera[own].view;
    int best = -1;
    for (int i = 0; i < rig->n_cameras; i++) {
        const adcgs_stereo_view *const b = &rig->camera[i].view;
        const double d = adcgs_stereo_apart(a, b);
        if (i != own && i != taken && b->pixels && d >= APART && adcgs_stereo_axes_dot(a, b) >= AXES_ALIKE &&
            (best < 0 || d < adcgs_stereo_apart(a, &rig->camera[best].view)))
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
            pairs[n++] = (pair){ &rig->camera[i].view, &rig->camera[other].view, rig->nearest, rig->farthest, (double)NAN };
        }
    return n;
}

adcgs_status adcgs_stereo_poses_off(const adcgs_stereo_rig *rig, adcgs_stereo_off *out, adcgs_pool *pool, adcgs_error *error)
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

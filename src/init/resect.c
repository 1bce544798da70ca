/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Camera pose from correspondences. */
#include "init/resect.h"

#include "grad/random.h"
#include "init/rigid/rigid.h"

#include <math.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
enum { ROUNDS = 30 };      /* of least squares */
enum { TRIES = 400 };      /* poses from two correspondences */
enum { SIGHTS_LEAST = 6 }; /* minimum number of correspondences; least squares of six unknowns need three */
#define SHARP 0.7          /* pixels: final error at which the fit is one half */
#define NARROWER 0.8       /* factor of that error from one round to the next */
#define ROUGHLY 0.06       /* share of the image width: tolerance of a pose from two correspondences, which ignores parallax */
#define DAMPING 1e-6       /* relative increase of the system's diagonal */

static void to_camera(const adcgs_stereo_view *v, const double x[3], double p[3])
{
    for (int a = 0; a < 3; a++)
        p[a] = v->rotation[3 * a] * (x[0] - v->centre[0]) + v->rotation[3 * a + 1] * (x[1] - v->centre[1]) +
               v->rotation[3 * a + 2] * (x[2] - v->centre[2]);
}

/** Reprojection error of a correspondence. Returns 0 if the point is behind the camera. */
static int difference(const adcgs_stereo_view *v, const adcgs_correspondence *s, double p[3], double off[2])
{
    to_camera(v, s->x, p);
    if (!(p[2] > 1e-6))
        return 0;
    off[0] = v->fx * p[0] / p[2] + v->cx - s->at[0];
    off[1] = v->fy * p[1] / p[2] + v->cy - s->at[1];
    return 1;
}

double adcgs_reprojection_error(const adcgs_stereo_view *view, const adcgs_correspondence *match)
{
    double p[3], off[2];
    return difference(view, match, p, off) ? hypot(off[0], off[1]) : (double)INFINITY;
}

int adcgs_correspondences_count_inliers(const adcgs_stereo_view *view, const adcgs_correspondences *s, double off)
{
    int n = 0;
    for (int i = 0; i < s->n; i++)
        n += adcgs_reprojection_error(view, &s->match[i]) < off;
    return n;
}

/* ---- Least squares ---- */

/** Rotates the camera about its centre by a small rotation in its own axes, and shifts the scene. */
static void move(adcgs_stereo_view *v, const double turn[3], const double shift[3])
{
    adcgs_rigid own, step;
    memcpy(own.r, v->rotation, sizeof own.r);
    for (int a = 0; a < 3; a++)
        own.t[a] = -(own.r[3 * a] * v->centre[0] + own.r[3 * a + 1] * v->centre[1] + own.r[3 * a + 2] * v->centre[2]);
    adcgs_rigid_about(turn, (const double[]){0, 0, 0}, shift, &step);
    adcgs_rigid_then(&own, &step, &own);
    memcpy(v->rotation, own.r, sizeof own.r);
    for (int a = 0; a < 3; a++)
        v->centre[a] = -(own.r[a] * own.t[0] + own.r[3 + a] * own.t[1] + own.r[6 + a] * own.t[2]);
}

/** Derivatives of a pixel coordinate by camera rotation and scene shift. axis: 0 or 1, the coordinate. */
static void slope_of(const double p[3], int axis, double focal, double row[6])
{
    double by_place[3] = {0, 0, -focal * p[axis] / (p[2] * p[2])};
    by_place[axis] = focal / p[2];
    row[0] = p[1] * by_place[2] - p[2] * by_place[1];
    row[1] = p[2] * by_place[0] - p[0] * by_place[2];
    row[2] = p[0] * by_place[1] - p[1] * by_place[0];
    memcpy(row + 3, by_place, sizeof by_place);
}

/** One step; 0 if the system is singular. sharp: error in pixels at which the fit is one half. */
static int step(adcgs_stereo_view *v, const adcgs_correspondences *s, double sharp)
{
    double a[36] = {0}, b[6] = {0}, p[3], off[2], row[6];
    for (int i = 0; i < s->n; i++) {
        if (!difference(v, &s->match[i], p, off))
            continue;
        const double fits = 1 / (1 + (off[0] * off[0] + off[1] * off[1]) / (sharp * sharp)), weight = fits * fits;
        for (int axis = 0; axis < 2; axis++) {
            slope_of(p, axis, axis ? v->fy : v->fx, row);
            for (int j = 0; j < 6; j++) {
                for (int k = 0; k < 6; k++)
                    a[6 * j + k] += weight * row[j] * row[k];
                b[j] -= weight * row[j] * off[axis];
            }
        }
    }
    for (int j = 0; j < 6; j++)
        a[7 * j] += DAMPING * a[7 * j] + 1e-9;
    if (!adcgs_solve_six(a, b))
        return 0;
    move(v, b, b + 3);
    return 1;
}

void adcgs_resect(adcgs_stereo_view *view, const adcgs_correspondences *matches, double off)
{
    double sharp = off;
    if (matches->n < SIGHTS_LEAST)
        return;
    for (int round = 0; round < ROUNDS && step(view, matches, sharp); round++)
        sharp = fmax(sharp * NARROWER, SHARP);
}

/* ---- Without an initial pose ---- */

/** Rotates a camera about its centre so that two correspondences agree. */
static void turn_to(adcgs_stereo_view *v, const adcgs_correspondence *two[2])
{
    adcgs_rigid_sums sums = {.weight = 0};
    adcgs_rigid turn;
    for (int i = 0; i < 2; i++) {
        double world[3], own[3] = {(two[i]->at[0] - v->cx) / v->fx, (two[i]->at[1] - v->cy) / v->fy, 1}, far = 0, length = 0;
        for (int a = 0; a < 3; a++) {
            world[a] = two[i]->x[a] - v->centre[a];
            far += world[a] * world[a];
            length += own[a] * own[a];
        }
        for (int a = 0; a < 3; a++) {
            world[a] /= fmax(sqrt(far), 1e-300);
            own[a] /= sqrt(length);
        }
        adcgs_rigid_add(&sums, world, own, 1);
        for (int a = 0; a < 3; a++) { /* with the opposite vector, so that the fit contains no translation */
            world[a] = -world[a];
            own[a] = -own[a];
        }
        adcgs_rigid_add(&sums, world, own, 1);
    }
    adcgs_rigid_fit(&sums, &turn);
    memcpy(v->rotation, turn.r, sizeof turn.r);
}

void adcgs_resect_anywhere(adcgs_stereo_view *view, const adcgs_correspondences *s, const adcgs_stereo_view *views, uint64_t seed)
{
    const double roughly = ROUGHLY * view->w;
    adcgs_stereo_view best = *view;
    int most = 0;
    if (s->n < SIGHTS_LEAST)
        return;
    for (uint64_t k = 0; k < TRIES; k++) {
        const adcgs_correspondence *two[2];
        adcgs_stereo_view v = *view;
        for (uint64_t i = 0; i < 2; i++)
            two[i] = &s->match[adcgs_random64(seed, 3000 + i, k) % (uint64_t)s->n];
        if (two[0] == two[1])
            continue;
        if (k % 2)
            memcpy(v.centre, views[two[0]->from].centre, sizeof v.centre);
        turn_to(&v, two);
        const int near = adcgs_correspondences_count_inliers(&v, s, roughly);
        if (near > most) {
            most = near;
            best = v;
        }
    }
    adcgs_resect(&best, s, roughly);
    *view = best;
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Spline of a camera through key frames. */
#include "config.h"

#include "camera/spline.h"

#include "geometry/rotation.h"

#include <math.h>
#include <stdlib.h>

/* Places of rates, by definition: of the position, of the rotation (a turn in the camera's own axes), of single numbers. */
enum { POSITION = 0, ROTATION = 3, NUMBERS = 6, N_NUMBERS = 6, RATES = NUMBERS + N_NUMBERS };

struct adcgs_knot {
    double at;
    double position[3], rotation[4];
    double numbers[N_NUMBERS]; /* fx, fy, cx, cy, near plane, time */
    double rate[RATES];        /* at the knot, per unit of at */
    double chord[RATES];       /* mean rate up to the next knot */
};

static void make_knot(adcgs_knot *knot, const adcgs_camera_key *key)
{
    const adcgs_camera *camera = &key->frame.camera;
    const double numbers[N_NUMBERS] = {camera->fx, camera->fy, camera->cx, camera->cy, camera->near_plane, key->frame.time};
    *knot = (adcgs_knot){.at = key->at};
    for (int i = 0; i < 3; i++)
        knot->position[i] = camera->cam_to_world[4 * i + 3];
    adcgs_rotation_from_pose(camera->cam_to_world, knot->rotation);
    memcpy(knot->numbers, numbers, sizeof numbers);
}

static void make_chord(adcgs_knot *knot)
{
    const adcgs_knot *next = knot + 1;
    double *chord = knot->chord;
    for (int i = 0; i < 3; i++)
        chord[POSITION + i] = next->position[i] - knot->position[i];
    adcgs_rotation_between(knot->rotation, next->rotation, chord + ROTATION);
    for (int i = 0; i < N_NUMBERS; i++)
        chord[NUMBERS + i] = next->numbers[i] - knot->numbers[i];
    for (int i = 0; i < RATES; i++)
        chord[i] /= next->at - knot->at;
}

/** Rate of a vector between two chords: that of the parabola through three knots, or zero next to a standstill. */
static void vector_rate(const double before[3], const double after[3], double h0, double h1, double out[3])
{
    const int still = adcgs_v3_dot(before, before) == 0.0 || adcgs_v3_dot(after, after) == 0.0;
    for (int i = 0; i < 3; i++)
        out[i] = still ? 0.0 : (h1 * before[i] + h0 * after[i]) / (h0 + h1);
}

/** Rate of a number between two chords: a weighted harmonic mean, small enough to prevent overshoot. */
static double number_rate(double before, double after, double h0, double h1)
{
    const double w0 = h0 + 2.0 * h1, w1 = 2.0 * h0 + h1;
    return before * after > 0.0 ? (w0 + w1) / (w0 / before + w1 / after) : 0.0;
}

static void make_rate(double rate[RATES], const adcgs_knot *before, const adcgs_knot *knot)
{
    const double h0 = before[1].at - before->at, h1 = knot[1].at - knot->at;
    vector_rate(before->chord + POSITION, knot->chord + POSITION, h0, h1, rate + POSITION);
    vector_rate(before->chord + ROTATION, knot->chord + ROTATION, h0, h1, rate + ROTATION);
    for (int i = NUMBERS; i < RATES; i++)
        rate[i] = number_rate(before->chord[i], knot->chord[i], h0, h1);
}

/** Rates at the ends of an open spline, for zero curvature there. */
static void make_end_rates(adcgs_knot *knots, int n)
{
    for (int i = 0; i < RATES; i++) {
        const double first = knots[0].chord[i], last = knots[n - 2].chord[i];
        knots[0].rate[i] = n == 2 ? first : 0.5 * (3.0 * first - knots[1].rate[i]);
        knots[n - 1].rate[i] = n == 2 ? last : 0.5 * (3.0 * last - knots[n - 2].rate[i]);
    }
}

adcgs_status adcgs_camera_spline_init(adcgs_camera_spline *spline, const adcgs_camera_key *keys, int n, int linear, int closed,
                                      adcgs_error *error)
{
    *spline = (adcgs_camera_spline){.n = n, .linear = linear, .camera = keys[0].frame.camera};
    adcgs_knot *knots = malloc((size_t)n * sizeof *knots);
    if (!knots)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for a camera path of %d keys", n);
    spline->knots = knots;
    for (int i = 0; i < n; i++)
        make_knot(&knots[i], &keys[i]);
    for (int i = 0; i + 1 < n; i++)
        make_chord(&knots[i]);
    for (int i = 1; i + 1 < n; i++)
        make_rate(knots[i].rate, &knots[i - 1], &knots[i]);
    if (closed && n > 2) {
        make_rate(knots[0].rate, &knots[n - 2], &knots[0]);
        memcpy(knots[n - 1].rate, knots[0].rate, sizeof knots[0].rate);
    } else if (n > 1)
        make_end_rates(knots, n);
    return ADCGS_OK;
}

void adcgs_camera_spline_clear(adcgs_camera_spline *spline)
{
    free(spline->knots);
    *spline = (adcgs_camera_spline){0};
}

/** The last knot at or before a position that has a successor. */
static const adcgs_knot *find_knot(const adcgs_camera_spline *spline, double at)
{
    int lo = 0, hi = spline->n - 1;
    while (hi - lo > 1) {
        const int middle = lo + (hi - lo) / 2;
        if (spline->knots[middle].at <= at)
            lo = middle;
        else
            hi = middle;
    }
    return &spline->knots[lo];
}

/** Cubic through a and b with rates over the whole interval. */
static double hermite(double a, double rate_a, double b, double rate_b, double t)
{
    const double u = 1.0 - t;
    return u * u * ((1.0 + 2.0 * t) * a + t * rate_a) + t * t * ((1.0 + 2.0 * u) * b - u * rate_b);
}

/**
 * From a to b with given angular velocities over the interval: a exp(w0 f0) exp(w1 f1) exp(w2 f2). w0 and w2 are a third of the
 * velocities, w1 is the remaining turn, and the f are the cumulative cubic Bernstein polynomials.
 */
static void rotation_curve(const adcgs_knot *a, const adcgs_knot *b, double h, double t, double out[4])
{
    const double u = 1.0 - t, third = h / 3.0;
    double start[4], end[4], w1[3], q[4];
    adcgs_rotation_exp(a->rate + ROTATION, third, start);
    adcgs_rotation_multiply(a->rotation, start, start);
    adcgs_rotation_exp(b->rate + ROTATION, -third, end);
    adcgs_rotation_multiply(b->rotation, end, end);
    adcgs_rotation_between(start, end, w1);
    adcgs_rotation_exp(a->rate + ROTATION, third * (1.0 - u * u * u), q);
    adcgs_rotation_multiply(a->rotation, q, out);
    adcgs_rotation_exp(w1, t * t * (3.0 - 2.0 * t), q);
    adcgs_rotation_multiply(out, q, out);
    adcgs_rotation_exp(b->rate + ROTATION, third * t * t * t, q);
    adcgs_rotation_multiply(out, q, out);
}

static void set_shot(const adcgs_camera_spline *spline, const double position[3], const double rotation[4],
                     const double numbers[N_NUMBERS], adcgs_camera_frame *frame)
{
    const double length = sqrt(rotation[0] * rotation[0] + adcgs_v3_dot(rotation + 1, rotation + 1));
    const double unit[4] = {rotation[0] / length, rotation[1] / length, rotation[2] / length, rotation[3] / length};
    adcgs_camera *camera = &frame->camera;
    *camera = spline->camera;
    adcgs_rotation_to_pose(unit, camera->cam_to_world);
    for (int i = 0; i < 3; i++)
        camera->cam_to_world[4 * i + 3] = position[i];
    camera->fx = numbers[0];
    camera->fy = numbers[1];
    camera->cx = numbers[2];
    camera->cy = numbers[3];
    camera->near_plane = numbers[4];
    frame->time = numbers[5];
}

void adcgs_camera_spline_at(const adcgs_camera_spline *spline, double at, adcgs_camera_frame *frame)
{
    const adcgs_knot *a = find_knot(spline, at), *b = spline->n > 1 ? a + 1 : a;
    const double h = b->at - a->at, t = h > 0.0 ? fmin(fmax((at - a->at) / h, 0.0), 1.0) : 0.0;
    double position[3], rotation[4], numbers[N_NUMBERS];
    for (int i = 0; i < 3; i++)
        position[i] = spline->linear ? (1.0 - t) * a->position[i] + t * b->position[i]
                                     : hermite(a->position[i], h * a->rate[i], b->position[i], h * b->rate[i], t);
    for (int i = 0; i < N_NUMBERS; i++) {
        const int r = NUMBERS + i;
        numbers[i] = spline->linear ? (1.0 - t) * a->numbers[i] + t * b->numbers[i]
                                    : hermite(a->numbers[i], h * a->rate[r], b->numbers[i], h * b->rate[r], t);
    }
    if (spline->linear && h > 0.0) {
        adcgs_rotation_exp(a->chord + ROTATION, t * h, rotation);
        adcgs_rotation_multiply(a->rotation, rotation, rotation);
    } else
        rotation_curve(a, b, h, t, rotation);
    set_shot(spline, position, rotation, numbers, frame);
}

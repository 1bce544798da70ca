/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Rate-distortion curves. */
#include "config.h"

#include "metric/curve.h"

#include <math.h>
#include <stdlib.h>

/* ---- Bjontegaard's difference ---- */

/** log(bytes) as a function of quality: knots, values and slopes; piecewise linear without slopes. */
typedef struct spline {
    int n, cubic;
    double x[ADCGS_CURVE_MAX], y[ADCGS_CURVE_MAX], slope[ADCGS_CURVE_MAX];
} spline;

static int by_quality(const void *a, const void *b)
{
    const adcgs_curve_point *p = a, *q = b;
    return (p->quality > q->quality) - (p->quality < q->quality);
}

static int by_bytes(const void *a, const void *b)
{
    const adcgs_curve_point *p = a, *q = b;
    if (p->bytes != q->bytes)
        return p->bytes < q->bytes ? -1 : 1;
    return by_quality(a, b);
}

/** Slope at an end from the two nearest pieces, of widths h0, h1 and slopes d0, d1; it keeps their direction. */
static double end_slope(double h0, double h1, double d0, double d1)
{
    const double slope = ((2 * h0 + h1) * d0 - h0 * d1) / (h0 + h1);
    if (slope * d0 <= 0)
        return 0;
    return d0 * d1 <= 0 && fabs(slope) > 3 * fabs(d0) ? 3 * d0 : slope;
}

/** Fritsch and Carlson: the weighted harmonic mean of the slopes of two pieces with the same direction, else zero. */
static void set_slopes(spline *s)
{
    double h[ADCGS_CURVE_MAX], d[ADCGS_CURVE_MAX];
    for (int i = 0; i + 1 < s->n; i++) {
        h[i] = s->x[i + 1] - s->x[i];
        d[i] = (s->y[i + 1] - s->y[i]) / h[i];
    }
    for (int i = 1; i + 1 < s->n; i++) {
        const double w0 = 2 * h[i] + h[i - 1], w1 = h[i] + 2 * h[i - 1];
        s->slope[i] = d[i - 1] * d[i] > 0 ? (w0 + w1) / (w0 / d[i - 1] + w1 / d[i]) : 0;
    }
    const int last = s->n - 1;
    s->slope[0] = end_slope(h[0], h[1], d[0], d[1]);
    s->slope[last] = end_slope(h[last - 1], h[last - 2], d[last - 1], d[last - 2]);
}

static adcgs_status spline_init(spline *s, const adcgs_curve_point *points, int n, adcgs_error *error)
{
    adcgs_curve_point sorted[ADCGS_CURVE_MAX];
    if (n < 2 || n > ADCGS_CURVE_MAX)
        return adcgs_fail(error, ADCGS_ERR_DATA, "a curve of %d points: expected 2 to %d", n, ADCGS_CURVE_MAX);
    memcpy(sorted, points, (size_t)n * sizeof *points);
    for (int i = 0; i < n; i++)
        if (!isfinite(sorted[i].quality) || !isfinite(sorted[i].bytes) || !(sorted[i].bytes > 0))
            return adcgs_fail(error, ADCGS_ERR_DATA, "an invalid point on the curve: %g bytes, %g dB", sorted[i].bytes,
                              sorted[i].quality);
    qsort(sorted, (size_t)n, sizeof *sorted, by_quality);
    s->n = n;
    s->cubic = n >= 4;
    for (int i = 0; i < n; i++) {
        s->x[i] = sorted[i].quality;
        s->y[i] = log(sorted[i].bytes);
        if (i && s->x[i] == s->x[i - 1])
            return adcgs_fail(error, ADCGS_ERR_DATA, "two points of %g dB on the curve", s->x[i]);
    }
    if (s->cubic)
        set_slopes(s);
    return ADCGS_OK;
}

/** Integral of piece i from its left knot over a length u. */
static double piece_integral(const spline *s, int i, double u)
{
    const double h = s->x[i + 1] - s->x[i], d = (s->y[i + 1] - s->y[i]) / h;
    if (!s->cubic)
        return u * (s->y[i] + u * d / 2);
    const double c = (3 * d - 2 * s->slope[i] - s->slope[i + 1]) / h, b = (s->slope[i] + s->slope[i + 1] - 2 * d) / (h * h);
    return u * (s->y[i] + u * (s->slope[i] / 2 + u * (c / 3 + u * b / 4)));
}

static double integral(const spline *s, double from, double to)
{
    double sum = 0;
    for (int i = 0; i + 1 < s->n; i++) {
        const double a = fmax(from, s->x[i]), b = fmin(to, s->x[i + 1]);
        if (a < b)
            sum += piece_integral(s, i, b - s->x[i]) - piece_integral(s, i, a - s->x[i]);
    }
    return sum;
}

adcgs_status adcgs_bd_rate(const adcgs_curve_point *reference, int n_reference, const adcgs_curve_point *test, int n_test,
                           double *percent, adcgs_error *error)
{
    spline r, t;
    ADCGS_TRY(spline_init(&r, reference, n_reference, error));
    ADCGS_TRY(spline_init(&t, test, n_test, error));
    const double from = fmax(r.x[0], t.x[0]), to = fmin(r.x[r.n - 1], t.x[t.n - 1]);
    if (!(from < to))
        return adcgs_fail(error, ADCGS_ERR_DATA, "the curves have no quality in common");
    *percent = 100 * expm1((integral(&t, from, to) - integral(&r, from, to)) / (to - from));
    return ADCGS_OK;
}

/* ---- Queries of one curve ---- */

static int sort_by_bytes(adcgs_curve_point sorted[ADCGS_CURVE_MAX], const adcgs_curve_point *points, int n)
{
    n = ADCGS_MIN(n, ADCGS_CURVE_MAX);
    memcpy(sorted, points, (size_t)n * sizeof *points);
    qsort(sorted, (size_t)n, sizeof *sorted, by_bytes);
    return n;
}

double adcgs_curve_quality(const adcgs_curve_point *points, int n, double bytes)
{
    adcgs_curve_point p[ADCGS_CURVE_MAX];
    double best = (double)NAN;
    n = sort_by_bytes(p, points, n);
    for (int i = 0; i < n && p[i].bytes <= bytes; i++) {
        best = fmax(best, p[i].quality); /* fmax() ignores a NaN */
        if (i + 1 < n && p[i + 1].bytes > bytes) {
            const double u = log(bytes / p[i].bytes) / log(p[i + 1].bytes / p[i].bytes);
            best = fmax(best, p[i].quality + u * (p[i + 1].quality - p[i].quality));
        }
    }
    return best;
}

int adcgs_curve_is_monotone(const adcgs_curve_point *points, int n)
{
    adcgs_curve_point p[ADCGS_CURVE_MAX];
    n = sort_by_bytes(p, points, n);
    for (int i = 1; i < n; i++)
        if (!(p[i].bytes > p[i - 1].bytes && p[i].quality > p[i - 1].quality))
            return 0;
    return n >= 2;
}

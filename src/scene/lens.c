/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The lens model: projection, inverse and first fold. */
#include "config.h"

#include "scene/lens_model.h"

#include <math.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define REACH 1e4              /* largest r^2 that is considered */
#define HALVINGS 60            /* bisection steps; the last ones reach rounding precision, arithmetic */
#define START_HALVINGS 16      /* bisection steps before Newton's method takes over */
#define NEWTON_STEPS 40        /* maximum number of steps */
#define NEWTON_TOLERANCE 1e-12 /* residual, relative to 1 + radius in the image plane */

/* Number of coefficients in r^2 of numerator and denominator; degree of their product. Literature: OpenCV's lens model. */
enum { ABOVE = 5, BELOW = 4, DEGREE = ABOVE + BELOW - 2 };

/** The distorted direction (x', y'), with dx'/dx, dx'/dy = dy'/dx and dy'/dy. */
typedef struct bent {
    double x, y, xx, xy, yy;
} bent;

static void list_terms(const adcgs_lens *lens, double above[ABOVE], double below[BELOW])
{
    above[0] = below[0] = 1.0;
    for (int i = 0; i < 3; i++) {
        above[1 + i] = lens->k[i];
        below[1 + i] = lens->k[3 + i];
    }
    above[4] = lens->k8;
}

/* ---- Projection ---- */

/** Distorts the angle from the axis. factor is the length in the image over the length of the direction. */
static bent bend_angle(const adcgs_lens *lens, double x, double y)
{
    const double *k = lens->k, r = hypot(x, y), a = atan(r), s = a * a;
    const double factor = r > 0.0 ? a / r * (1.0 + s * (k[0] + s * (k[1] + s * (k[2] + s * k[3])))) : 1.0;
    const double growth = 1.0 + s * (3.0 * k[0] + s * (5.0 * k[1] + s * (7.0 * k[2] + s * 9.0 * k[3])));
    const double slope = r > 0.0 ? (growth / (1.0 + r * r) - factor) / (r * r) : 0.0; /* d factor / dr, over r */
    return (
        bent){.x = x * factor, .y = y * factor, .xx = factor + x * x * slope, .xy = x * y * slope, .yy = factor + y * y * slope};
}

static bent bend(const adcgs_lens *lens, double x, double y)
{
    if (lens->is_fisheye)
        return bend_angle(lens, x, y);
    const double *k = lens->k, p1 = lens->p[0], p2 = lens->p[1], s = x * x + y * y;
    const double above = 1.0 + s * (k[0] + s * (k[1] + s * (k[2] + s * lens->k8)));
    const double below = 1.0 + s * (k[3] + s * (k[4] + s * k[5])), share = 1.0 / below, factor = above * share;
    const double above_slope = k[0] + s * (2.0 * k[1] + s * (3.0 * k[2] + s * 4.0 * lens->k8));
    const double below_slope = k[3] + s * (2.0 * k[4] + s * 3.0 * k[5]);
    const double slope = 2.0 * (above_slope - factor * below_slope) * share; /* twice d factor / ds */
    return (bent){
        .x = x * factor + 2.0 * p1 * x * y + p2 * (s + 2.0 * x * x),
        .y = y * factor + 2.0 * p2 * x * y + p1 * (s + 2.0 * y * y),
        .xx = factor + x * x * slope + 2.0 * p1 * y + 6.0 * p2 * x,
        .xy = x * y * slope + 2.0 * p1 * x + 2.0 * p2 * y,
        .yy = factor + y * y * slope + 6.0 * p1 * y + 2.0 * p2 * x,
    };
}

/** True if the derivatives are positive definite. They are the identity on the axis, and positive definite up to the fold. */
static int is_open(const bent *b)
{
    return b->xx > 0.0 && b->xx * b->yy > b->xy * b->xy;
}

static void put_pixel(const adcgs_lens *lens, const bent *b, double uv[2])
{
    uv[0] = lens->fx * b->x + lens->skew * b->y + lens->cx;
    uv[1] = lens->fy * b->y + lens->cy;
}

void adcgs_lens_project(const adcgs_lens *lens, double x, double y, double uv[2])
{
    const bent b = bend(lens, x, y);
    put_pixel(lens, &b, uv);
}

int adcgs_lens_see(const adcgs_lens *lens, double fold, double x, double y, double uv[2])
{
    const bent b = bend(lens, x, y);
    put_pixel(lens, &b, uv);
    return x * x + y * y < fold && is_open(&b);
}

/* ---- The first fold ---- */

static double polynomial(const double *p, int degree, double s)
{
    double value = p[degree];
    for (int i = degree - 1; i >= 0; i--)
        value = value * s + p[i];
    return value;
}

/**
 * Finds sign changes between 0 and end, in ascending order: at most one between two roots of the derivative. Returns how many.
 */
static int find_roots(const double *p, int degree, double end, double roots[DEGREE])
{
    double slope[DEGREE], turns[DEGREE], low = 0.0;
    int n = 0;
    while (degree > 0 && p[degree] == 0.0)
        degree--;
    for (int i = 0; i < degree; i++)
        slope[i] = (i + 1) * p[i + 1];
    const int n_turns = degree > 1 ? find_roots(slope, degree - 1, end, turns) : 0;
    for (int i = 0; i <= n_turns; i++) {
        const double next = i < n_turns ? turns[i] : end;
        const int sign = polynomial(p, degree, low) > 0.0;
        double high = next;
        if (sign != (polynomial(p, degree, high) > 0.0)) {
            for (int halving = 0; halving < HALVINGS; halving++) {
                const double middle = 0.5 * (low + high);
                if ((polynomial(p, degree, middle) > 0.0) == sign)
                    low = middle;
                else
                    high = middle;
            }
            roots[n++] = low; /* the side before the sign change */
        }
        low = next;
    }
    return n;
}

/** The distorted angle grows with the angle a, s = a^2, while 1 + 3 k1 s + 5 k2 s^2 + 7 k3 s^3 + 9 k4 s^4 > 0. */
static double find_fold_of_angle(const adcgs_lens *lens)
{
    const double *k = lens->k, growth[] = {1.0, 3.0 * k[0], 5.0 * k[1], 7.0 * k[2], 9.0 * k[3]}, widest = atan(sqrt(REACH));
    double roots[DEGREE];
    if (!find_roots(growth, ADCGS_COUNTOF(growth) - 1, widest * widest, roots))
        return REACH;
    const double r = tan(sqrt(roots[0]));
    return r * r;
}

double adcgs_lens_fold(const adcgs_lens *lens)
{
    if (lens->is_fisheye)
        return find_fold_of_angle(lens);
    double above[ABOVE], below[BELOW], growth[DEGREE + 1] = {0.0}, roots[DEGREE], fold = REACH;
    list_terms(lens, above, below);
    /* With s = r^2, r A(s)/B(s) grows while (A + 2 s A') B - 2 s A B' > 0. */
    for (int i = 0; i < ABOVE; i++)
        for (int j = 0; j < BELOW; j++)
            growth[i + j] += above[i] * below[j] * (1 + 2 * i - 2 * j);
    if (find_roots(growth, DEGREE, fold, roots))
        fold = roots[0];
    if (find_roots(below, BELOW - 1, fold, roots))
        fold = roots[0];
    return fold;
}

/* ---- The inverse ---- */

/** Approximate length of the direction for a length in the image, without tangential terms. */
static double straighten_radius(const adcgs_lens *lens, double fold, double radius)
{
    double low = 0.0, high = sqrt(fold);
    adcgs_lens radial = *lens;
    radial.p[0] = radial.p[1] = 0.0;
    for (int i = 0; i < START_HALVINGS; i++) {
        const double middle = 0.5 * (low + high);
        if (bend(&radial, middle, 0.0).x < radius)
            low = middle;
        else
            high = middle;
    }
    return low;
}

static double miss(const bent *b, const double target[2])
{
    return hypot(b->x - target[0], b->y - target[1]);
}

/** One Newton step, halved until it stays inside the fold and comes closer. Returns 0 if no halving does. */
static int step_closer(const adcgs_lens *lens, double fold, const double target[2], double xy[2], bent *b)
{
    const double ex = b->x - target[0], ey = b->y - target[1], determinant = b->xx * b->yy - b->xy * b->xy;
    const double before = miss(b, target);
    double dx = (b->yy * ex - b->xy * ey) / determinant, dy = (b->xx * ey - b->xy * ex) / determinant;
    for (int i = 0; i < NEWTON_STEPS; i++, dx *= 0.5, dy *= 0.5) {
        const double x = xy[0] - dx, y = xy[1] - dy;
        const bent next = bend(lens, x, y);
        if (x * x + y * y < fold && is_open(&next) && miss(&next, target) < before) {
            xy[0] = x;
            xy[1] = y;
            *b = next;
            return 1;
        }
    }
    return 0;
}

int adcgs_lens_invert(const adcgs_lens *lens, double fold, double u, double v, double xy[2])
{
    double target[2];
    target[1] = (v - lens->cy) / lens->fy;
    target[0] = (u - lens->cx - lens->skew * target[1]) / lens->fx;
    const double radius = hypot(target[0], target[1]), tolerance = NEWTON_TOLERANCE * (1.0 + radius);
    const double scale = radius > 0.0 ? straighten_radius(lens, fold, radius) / radius : 0.0;
    xy[0] = scale * target[0];
    xy[1] = scale * target[1];
    bent b = bend(lens, xy[0], xy[1]);
    if (!is_open(&b)) { /* tangential terms fold here; the axis never folds */
        xy[0] = xy[1] = 0.0;
        b = bend(lens, 0.0, 0.0);
    }
    for (int i = 0; i < NEWTON_STEPS && miss(&b, target) > tolerance; i++)
        if (!step_closer(lens, fold, target, xy, &b))
            break;
    return miss(&b, target) <= tolerance && xy[0] * xy[0] + xy[1] * xy[1] < fold;
}

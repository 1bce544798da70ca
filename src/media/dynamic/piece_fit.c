/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Least squares for one piece of a splat over time, and the error of all its pieces. */
#include "config.h"

#include "media/dynamic/piece_fit.h"

#include <math.h>

#define TERMS (ADCGS_PIECE_ORDERS + 1) /* coefficients of a polynomial; arithmetic */

/* Origin: chosen by hand, not measured. */
#define REACH 4.3         /* standard deviations in which a piece counts; arithmetic: its weight is below 1e-4 beyond */
#define WEIGHT_MIN 1e-4   /* of samples that count */
#define RIDGE 1e-6        /* part of the sum of weights that is added to the diagonal: few samples give a low order */
#define COLOUR_MOST 0.04  /* tolerated error of a colour */
#define SCALE_MOST 0.15   /* tolerated error of a scale's logarithm */
#define OPACITY_MOST 0.04 /* tolerated error of an opacity */
#define BESIDE 0.25       /* share of frames in which the splat does not exist, next to those in which it does, in the error */

double adcgs_piece_weight(const adcgs_piece *p, double frame)
{
    const double u = (frame - (double)p->centre) / (double)p->sigma;
    return p->sigma >= ADCGS_PIECE_FOREVER ? 1.0 : exp(-0.5 * u * u);
}

/** Solves the symmetric system of n equations in place, by elimination; it is positive definite. */
static void solve(double m[TERMS][TERMS], double *b, int n)
{
    for (int i = 0; i < n; i++)
        for (int k = i + 1; k < n; k++) {
            const double f = m[k][i] / m[i][i];
            for (int j = i; j < n; j++)
                m[k][j] -= f * m[i][j];
            b[k] -= f * b[i];
        }
    for (int i = n - 1; i >= 0; i--) {
        for (int j = i + 1; j < n; j++)
            b[i] -= m[i][j] * b[j];
        b[i] /= m[i][i];
    }
}

/** A value of a sample: 0..2 position, 3..6 rotation, 7..9 logarithms of scales, 10..12 colour. */
static double value_of(const adcgs_path_sample *s, int which)
{
    return which < 3    ? (double)s->mean[which]
           : which < 7  ? (double)s->rotation[which - 3]
           : which < 10 ? log((double)s->scale[which - 7])
                        : (double)s->colour[which - 10];
}

/** The polynomial of a value, in units of `unit` frames from the centre. */
static void fit_value(double out[TERMS], const adcgs_piece *p, const adcgs_piece_path *path, int which, int terms, double unit)
{
    double m[TERMS][TERMS] = {{0}}, total = 0.0;
    const double base = value_of(&path->sample[path->low], which);
    for (int i = 0; i < TERMS; i++)
        out[i] = 0.0;
    const double reach = REACH * ADCGS_MIN((double)p->sigma, (double)ADCGS_PIECE_FOREVER), c = (double)p->centre;
    for (int t = (int)fmax(path->low, ceil(c - reach)); t <= path->high && t <= c + reach; t++) {
        const adcgs_path_sample *const s = &path->sample[t];
        const double w = (double)s->opacity * adcgs_piece_weight(p, t), x = (t - (double)p->centre) / unit;
        double power = w;
        if (w < WEIGHT_MIN)
            continue;
        total += w;
        for (int i = 0; i < terms; i++, power *= x) {
            double product = power;
            out[i] += power * (value_of(s, which) - base); /* differences keep digits */
            for (int j = 0; j < terms; j++, product *= x)
                m[i][j] += product;
        }
    }
    for (int i = 0; i < terms; i++)
        m[i][i] += i ? RIDGE * total : 0.0;
    if (total > 0.0)
        solve(m, out, terms);
    out[0] += base;
}

void adcgs_piece_fit_motion(adcgs_piece *p, const adcgs_piece_path *path)
{
    const double unit = p->sigma < ADCGS_PIECE_FOREVER ? (double)p->sigma : ADCGS_MAX(path->frames / 2.0, 1.0);
    const int cubic = path->form == ADCGS_PIECE_CUBIC;
    double c[TERMS];
    for (int a = 0; a < 3; a++) {
        fit_value(c, p, path, a, cubic ? TERMS : 2, unit);
        p->mean[a] = (float)c[0];
        for (int j = 0; j < ADCGS_PIECE_ORDERS; j++)
            p->motion[j][a] = (float)(c[j + 1] / pow(unit, j + 1));
        fit_value(c, p, path, 7 + a, 1, unit);
        p->scale[a] = (float)exp(c[0]);
        fit_value(c, p, path, 10 + a, 1, unit);
        p->colour[a] = (float)c[0];
    }
    double square = 0.0;
    for (int a = 0; a < 4; a++) {
        fit_value(c, p, path, 3 + a, cubic ? 2 : 1, unit);
        p->rotation[a] = (float)c[0];
        p->turn[a] = (float)(c[1] / unit);
        square += c[0] * c[0];
    }
    if (!(square > 1e-6)) /* turns that cancel have no mean */
        for (int a = 0; a < 4; a++) {
            p->rotation[a] = path->sample[path->low].rotation[a];
            p->turn[a] = 0.0f;
        }
}

/** The square of the angle between a piece and a sample, for small angles. */
static double turn_error(const adcgs_piece *p, const adcgs_path_sample *s, double dt)
{
    double q[4], square = 0.0, dot = 0.0;
    for (int a = 0; a < 4; a++) {
        q[a] = (double)p->rotation[a] + (double)p->turn[a] * dt;
        square += q[a] * q[a];
        dot += q[a] * (double)s->rotation[a];
    }
    return square > 0.0 ? 8.0 * (1.0 - ADCGS_MIN(fabs(dot) / sqrt(square), 1.0)) : 1.0;
}

/** Square of a piece's error in a frame besides its opacity, in units of the tolerance. */
static double shape_error(const adcgs_piece *p, const adcgs_piece_path *path, int t)
{
    const adcgs_path_sample *const s = &path->sample[t];
    const double dt = t - (double)p->centre;
    double sum = 0.0, most = 0.0, least = INFINITY;
    for (int a = 0; a < 3; a++) {
        const double at =
            (double)p->mean[a] + dt * ((double)p->motion[0][a] + dt * ((double)p->motion[1][a] + dt * (double)p->motion[2][a]));
        const double off = (at - (double)s->mean[a]) / path->size, hue = (double)(p->colour[a] - s->colour[a]) / COLOUR_MOST,
                     size = log((double)p->scale[a] / (double)s->scale[a]) / SCALE_MOST;
        sum += off * off + (hue * hue + size * size) / 3.0;
        most = fmax(most, (double)s->scale[a]);
        least = fmin(least, (double)s->scale[a]);
    }
    const double reach = (most - least) / path->size; /* of a turn by one radian */
    return sum + turn_error(p, s, dt) * reach * reach;
}

static double frame_error(const adcgs_piece_trial *trial, const adcgs_piece_path *path, int t)
{
    const int exists = t >= path->low && t <= path->high;
    const double wanted = exists ? (double)path->sample[t].opacity : 0.0;
    const double d = trial->n > 1 ? (double)(trial->piece[1].centre - trial->piece[0].centre) : INFINITY;
    const int near_by = (int)floor((t - (double)trial->piece[0].centre) / d), most = (int)REACH;
    double left = 1.0, total = 0.0, sum = 0.0;
    for (int k = ADCGS_MAX(near_by - most, 0); k <= ADCGS_MIN(near_by + 1 + most, trial->n - 1); k++) {
        const double a = (double)trial->piece[k].opacity * adcgs_piece_weight(&trial->piece[k], t);
        if (a < WEIGHT_MIN)
            continue;
        left *= 1.0 - a;
        total += a;
        if (wanted > 0.0)
            sum += a * shape_error(&trial->piece[k], path, t);
    }
    const double off = (1.0 - left - wanted) / OPACITY_MOST;
    return off * off + (total > 0.0 ? wanted * sum / total : 0.0);
}

void adcgs_piece_judge(adcgs_piece_trial *trial, const adcgs_piece_path *path)
{
    double sum = 0.0, frames = 0.0;
    for (int t = path->first; t < path->end; t++) {
        const double share = t >= path->low && t <= path->high ? 1.0 : BESIDE;
        sum += share * frame_error(trial, path, t);
        frames += share;
    }
    trial->error = sqrt(sum / frames);
}

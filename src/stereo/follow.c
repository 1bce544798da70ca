/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Velocities of points. */
#include "stereo/follow.h"

#include <math.h>

enum { ROUNDS = 6, NEIGHBOURS = 8 };
#define COLOUR 0.5  /* scene units that a unit of difference in colour is worth */
#define REACH 0.25  /* scene units, with colours, beyond which there is no match */

/** Points of one moment. */
typedef struct layer {
    adcgs_stereo_point *p;
    uint32_t n;
} layer;

static double distance2(const double x[3], const adcgs_stereo_point *q, const float rgb[3])
{
    double d = 0;
    for (int a = 0; a < 3; a++)
        d += pow(x[a] - q->x[a], 2) + pow(COLOUR * (double)(rgb[a] - q->rgb[a]), 2);
    return d;
}

/** The nearest of a layer to a moved point. *found: one that may be near, if it is less than to->n. */
static int nearest(const layer *to, const adcgs_stereo_point *p, const double move[3], uint32_t *found)
{
    const double x[3] = { p->x[0] + move[0], p->x[1] + move[1], p->x[2] + move[2] };
    double least = REACH * REACH;
    int any = 0;
    if (*found < to->n) { /* the bound that it sets saves most of the others */
        const double d = distance2(x, &to->p[*found], p->rgb);
        any = d < least;
        least = fmin(d, least);
    }
    for (uint32_t j = 0; j < to->n; j++) {
        const double across = x[0] - to->p[j].x[0];
        if (across * across >= least)
            continue;
        const double d = distance2(x, &to->p[j], p->rgb);
        if (d < least) {
            least = d;
            *found = j;
            any = 1;
        }
    }
    return any;
}

/** Neighbours of each point within its layer, itself first. */
static void find_neighbours(const layer *l, uint32_t (*near)[NEIGHBOURS])
{
    for (uint32_t i = 0; i < l->n; i++) {
        double best[NEIGHBOURS];
        int known = 0;
        for (uint32_t j = 0; j < l->n; j++) {
            const double across = l->p[i].x[0] - l->p[j].x[0];
            if (known == NEIGHBOURS && across * across >= best[NEIGHBOURS - 1])
                continue;
            const double d = distance2(l->p[i].x, &l->p[j], l->p[i].rgb);
            int k = known < NEIGHBOURS ? known++ : NEIGHBOURS;
            if (k == NEIGHBOURS && d >= best[NEIGHBOURS - 1])
                continue;
            for (k = ADCGS_MIN(k, NEIGHBOURS - 1); k > 0 && best[k - 1] > d; k--) {
                best[k] = best[k - 1];
                near[i][k] = near[i][k - 1];
            }
            best[k] = d;
            near[i][k] = j;
        }
        for (; known < NEIGHBOURS; known++)
            near[i][known] = i;
    }
}

/** Displacements of the points of one layer onto another: raw by the nearest, then the mean of neighbours, and again. */
static void lay(const layer *from, const layer *to, double (*move)[3], double (*raw)[3], uint8_t *known,
                uint32_t *match, uint32_t (*near)[NEIGHBOURS])
{
    memset(move, 0, from->n * sizeof *move);
    memset(match, 0xff, from->n * sizeof *match);
    for (int round = 0; round < ROUNDS; round++) {
        for (uint32_t i = 0; i < from->n; i++) {
            known[i] = (uint8_t)nearest(to, &from->p[i], move[i], &match[i]);
            for (int a = 0; a < 3; a++)
                raw[i][a] = known[i] ? to->p[match[i]].x[a] - from->p[i].x[a] : 0;
        }
        for (uint32_t i = 0; i < from->n; i++) {
            double sum[3] = { 0, 0, 0 };
            int n = 0;
            for (int k = 0; k < NEIGHBOURS; k++) {
                const uint32_t j = near[i][k];
                n += known[j];
                for (int a = 0; a < 3; a++)
                    sum[a] += raw[j][a];
            }
            for (int a = 0; a < 3; a++)
                move[i][a] = n ? sum[a] / n : 0;
        }
    }
}

static void add_velocity(layer *l, const double (*move)[3], const uint8_t *known, double span, uint8_t *times)
{
    for (uint32_t i = 0; i < l->n; i++) {
        if (!known[i])
            continue;
        for (int a = 0; a < 3; a++)
            l->p[i].velocity[a] += (float)(move[i][a] / span);
        times[i]++;
    }
}

typedef struct scratch {
    double (*move)[3], (*raw)[3];
    uint8_t *known, *times;
    uint32_t *match, (*near)[NEIGHBOURS];
} scratch;

static void follow_layer(layer *l, const layer *before, const layer *after, const scratch *s)
{
    memset(s->times, 0, l->n);
    find_neighbours(l, s->near);
    const layer *const others[] = { before, after };
    for (int k = 0; k < 2; k++)
        if (others[k] && others[k]->n) {
            lay(l, others[k], s->move, s->raw, s->known, s->match, s->near);
            add_velocity(l, (const double(*)[3])s->move, s->known, (double)(others[k]->p[0].t - l->p[0].t), s->times);
        }
    for (uint32_t i = 0; i < l->n; i++)
        for (int a = 0; a < 3; a++)
            l->p[i].velocity[a] /= (float)ADCGS_MAX(s->times[i], 1);
}

adcgs_status adcgs_stereo_follow(adcgs_stereo_point *points, uint32_t n, adcgs_error *error)
{
    scratch s = { adcgs_alloc(NULL, n, sizeof *s.move, error),  adcgs_alloc(NULL, n, sizeof *s.raw, error),
                  adcgs_alloc(NULL, n, 1, error),               adcgs_alloc(NULL, n, 1, error),
                  adcgs_alloc(NULL, n, sizeof *s.match, error), adcgs_alloc(NULL, n, sizeof *s.near, error) };
    const int good = s.move && s.raw && s.known && s.times && s.match && s.near;
    layer before = { NULL, 0 };
    for (uint32_t begin = 0, end; good && begin < n; begin = end) {
        uint32_t next;
        for (end = begin; end < n && points[end].t <= points[begin].t; end++)
            ;
        for (next = end; next < n && points[next].t <= points[end].t; next++)
            ;
        layer here = { points + begin, end - begin };
        const layer after = { points + end, next - end };
        follow_layer(&here, before.n ? &before : NULL, &after, &s);
        before = here;
    }
    adcgs_free(NULL, s.move);
    adcgs_free(NULL, s.raw);
    adcgs_free(NULL, s.known);
    adcgs_free(NULL, s.times);
    adcgs_free(NULL, s.match);
    adcgs_free(NULL, s.near);
    return good ? ADCGS_OK : adcgs_alloc_status(error);
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Velocities of points. */
#include "init/velocities.h"

#include <math.h>
#include <stdlib.h>

/* Chosen by hand, not measured; 24 neighbours stay within the variance of seeds on rods (doc/log/matching.md). */
enum {
    ROUNDS = 6,    /* of smoothing */
    NEIGHBOURS = 8 /* points of a mean */
};
#define COLOUR 0.5 /* scene units per unit of colour difference */
#define REACH 0.25 /* scene units, including the colour term: maximum distance of a match */

/** A point in a sorted list. */
typedef struct place {
    double x[3];
    float rgb[3];
    uint32_t i;
} place;

/** Points of one frame. */
typedef struct layer {
    adcgs_stereo_point *p;
    place *sorted; /* [n] ascending in x, so that a search can stop early */
    uint32_t n;
} layer;

static double distance2(const double x[3], const float rgb[3], const double y[3], const float other[3])
{
    double d = 0;
    for (int a = 0; a < 3; a++)
        d += pow(x[a] - y[a], 2) + pow(COLOUR * (double)(rgb[a] - other[a]), 2);
    return d;
}

static int by_x(const void *a, const void *b)
{
    const place *p = a, *q = b;
    return p->x[0] != q->x[0] ? (p->x[0] > q->x[0] ? 1 : -1) : (p->i > q->i) - (p->i < q->i);
}

static void sort_layer(layer *l)
{
    for (uint32_t i = 0; i < l->n; i++) {
        l->sorted[i].i = i;
        memcpy(l->sorted[i].x, l->p[i].x, sizeof l->sorted[i].x);
        memcpy(l->sorted[i].rgb, l->p[i].rgb, sizeof l->sorted[i].rgb);
    }
    qsort(l->sorted, l->n, sizeof *l->sorted, by_x);
}

/** Iterator outwards from a position along x, to both sides. */
typedef struct walk {
    const layer *l;
    double x;
    uint32_t below, above; /* sorted[0..below-1] and sorted[above..n-1] are not visited yet */
} walk;

static walk walk_from(const layer *l, double x)
{
    uint32_t low = 0, high = l->n;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (l->sorted[middle].x[0] < x)
            low = middle + 1;
        else
            high = middle;
    }
    return (walk){l, x, low, low};
}

/** The next point along x, or NULL if none is nearer than sqrt(least). */
static const place *walk_on(walk *w, double least)
{
    const place *low = w->below > 0 ? &w->l->sorted[w->below - 1] : NULL;
    const place *high = w->above < w->l->n ? &w->l->sorted[w->above] : NULL;
    if (!low && !high)
        return NULL;
    const double down = low ? w->x - low->x[0] : HUGE_VAL, up = high ? high->x[0] - w->x : HUGE_VAL;
    if (up < down) {
        w->above++;
        return up * up < least ? high : NULL;
    }
    w->below--;
    return down * down < least ? low : NULL;
}

/** Nearest point of a layer to a displaced point. *found: a candidate if less than to->n. */
static int nearest(const layer *to, const adcgs_stereo_point *p, const double move[3], uint32_t *found)
{
    const double x[3] = {p->x[0] + move[0], p->x[1] + move[1], p->x[2] + move[2]};
    double least = REACH * REACH;
    int any = 0;
    if (*found < to->n) { /* the candidate's distance prunes most others */
        const double d = distance2(x, p->rgb, to->p[*found].x, to->p[*found].rgb);
        any = d < least;
        least = fmin(d, least);
    }
    walk w = walk_from(to, x[0]);
    for (const place *q; (q = walk_on(&w, least));) {
        const double d = distance2(x, p->rgb, q->x, q->rgb);
        if (d < least) {
            least = d;
            *found = q->i;
            any = 1;
        }
    }
    return any;
}

/** Neighbours of each point in its layer, the point itself first. */
static void find_neighbours(const layer *l, uint32_t (*near)[NEIGHBOURS])
{
    for (uint32_t i = 0; i < l->n; i++) {
        const adcgs_stereo_point *p = &l->p[i];
        double best[NEIGHBOURS];
        int known = 0;
        walk w = walk_from(l, p->x[0]);
        for (const place *q; (q = walk_on(&w, known == NEIGHBOURS ? best[NEIGHBOURS - 1] : HUGE_VAL));) {
            const double d = distance2(p->x, p->rgb, q->x, q->rgb);
            int k = known < NEIGHBOURS ? known++ : NEIGHBOURS;
            if (k == NEIGHBOURS && d >= best[NEIGHBOURS - 1])
                continue;
            for (k = ADCGS_MIN(k, NEIGHBOURS - 1); k > 0 && best[k - 1] > d; k--) {
                best[k] = best[k - 1];
                near[i][k] = near[i][k - 1];
            }
            best[k] = d;
            near[i][k] = q->i;
        }
        for (; known < NEIGHBOURS; known++)
            near[i][known] = i;
    }
}

/**
 * Displacements of one layer's points onto another layer, iterated: nearest match of each point, then the mean over its
 * neighbours.
 */
static void lay(const layer *from, const layer *to, double (*move)[3], double (*raw)[3], uint8_t *known, uint32_t *match,
                uint32_t (*near)[NEIGHBOURS])
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
            double sum[3] = {0, 0, 0};
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
    place *sorted;
} scratch;

static void follow_layer(layer *l, const layer *before, const layer *after, const scratch *s)
{
    memset(s->times, 0, l->n);
    find_neighbours(l, s->near);
    const layer *const others[] = {before, after};
    for (int k = 0; k < 2; k++)
        if (others[k] && others[k]->n) {
            lay(l, others[k], s->move, s->raw, s->known, s->match, s->near);
            add_velocity(l, (const double(*)[3])s->move, s->known, (double)(others[k]->p[0].t - l->p[0].t), s->times);
        }
    for (uint32_t i = 0; i < l->n; i++)
        for (int a = 0; a < 3; a++)
            l->p[i].velocity[a] /= (float)ADCGS_MAX(s->times[i], 1);
}

/** The layer that starts at `begin` and ends where t changes. */
static layer layer_at(adcgs_stereo_point *points, place *sorted, uint32_t n, uint32_t begin)
{
    uint32_t end = begin;
    while (end < n && points[end].t <= points[begin].t)
        end++;
    layer l = {points + begin, sorted + begin, end - begin};
    sort_layer(&l);
    return l;
}

adcgs_status adcgs_stereo_find_velocities(adcgs_stereo_point *points, uint32_t n, adcgs_error *error)
{
    scratch s = {adcgs_alloc(NULL, n, sizeof *s.move, error),
                 adcgs_alloc(NULL, n, sizeof *s.raw, error),
                 adcgs_alloc(NULL, n, 1, error),
                 adcgs_alloc(NULL, n, 1, error),
                 adcgs_alloc(NULL, n, sizeof *s.match, error),
                 adcgs_alloc(NULL, n, sizeof *s.near, error),
                 adcgs_alloc(NULL, n, sizeof *s.sorted, error)};
    const int good = s.move && s.raw && s.known && s.times && s.match && s.near && s.sorted;
    layer before = {.n = 0}, here = {.n = 0};
    if (good && n)
        here = layer_at(points, s.sorted, n, 0);
    for (uint32_t end = here.n; here.n; end += here.n) {
        const layer after = layer_at(points, s.sorted, n, end);
        follow_layer(&here, before.n ? &before : NULL, &after, &s);
        before = here;
        here = after;
    }
    adcgs_free(NULL, s.move);
    adcgs_free(NULL, s.raw);
    adcgs_free(NULL, s.known);
    adcgs_free(NULL, s.times);
    adcgs_free(NULL, s.match);
    adcgs_free(NULL, s.near);
    adcgs_free(NULL, s.sorted);
    return good ? ADCGS_OK : adcgs_alloc_status(error);
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A hashed grid of points. */
#include "init/cloud.h"

#include "geometry/vector.h"
#include "init/rigid/rigid.h"

#include <math.h>

/* Origin: chosen by hand, not measured. */
enum {
    AROUND = 64,     /* maximum number of neighbours */
    NORMAL_LEAST = 6 /* minimum number of points for a normal */
};

static uint32_t number_of(const adcgs_cloud *c, const int64_t cell[3])
{
    const uint64_t h = (uint64_t)cell[0] * 73856093u ^ (uint64_t)cell[1] * 19349663u ^ (uint64_t)cell[2] * 83492791u;
    return (uint32_t)(h ^ h >> 32) & c->mask;
}

static int64_t cell_along(const adcgs_cloud *c, double x)
{
    return (int64_t)floor(x / c->edge);
}

static uint32_t cell_of(const adcgs_cloud *c, const double x[3])
{
    return number_of(c, (const int64_t[]){cell_along(c, x[0]), cell_along(c, x[1]), cell_along(c, x[2])});
}

static adcgs_cloud_place place_of(const adcgs_stereo_point *points, uint32_t i)
{
    const double *x = points[i].x;
    return (adcgs_cloud_place){{x[0], x[1], x[2]}, i};
}

adcgs_status adcgs_cloud_init(adcgs_cloud *c, const adcgs_stereo_point *points, uint32_t n, uint32_t stride, double edge,
                              adcgs_error *error)
{
    *c = (adcgs_cloud){.p = points, .n = n, .used = (n + stride - 1) / stride, .edge = edge, .mask = 63};
    while (c->mask < c->used)
        c->mask = 2 * c->mask + 1;
    c->first = adcgs_alloc(NULL, (size_t)c->mask + 2, sizeof *c->first, error);
    c->at = adcgs_alloc(NULL, c->used, sizeof *c->at, error);
    if (!c->first || !c->at)
        return adcgs_alloc_status(error);
    for (uint32_t i = 0; i < n; i += stride)
        c->first[cell_of(c, points[i].x) + 1]++;
    for (uint32_t k = 0; k <= c->mask; k++)
        c->first[k + 1] += c->first[k];
    for (uint32_t i = c->used; i-- > 0;) /* backwards, so that each cell's points stay in order as first[] is decremented */
        c->at[--c->first[cell_of(c, points[i * stride].x) + 1]] = place_of(points, i * stride);
    for (uint32_t k = 0; k <= c->mask; k++)
        c->first[k] = c->first[k + 1];
    c->first[c->mask + 1] = c->used;
    return ADCGS_OK;
}

void adcgs_cloud_clear(adcgs_cloud *c)
{
    adcgs_free(NULL, c->first);
    adcgs_free(NULL, c->at);
    *c = (adcgs_cloud){.p = NULL};
}

/** Iterator over the cells around a position. */
typedef struct walk {
    int64_t low[3], high[3], cell[3];
} walk;

static walk walk_about(const adcgs_cloud *c, const double x[3], double reach)
{
    walk w;
    for (int a = 0; a < 3; a++) {
        w.low[a] = w.cell[a] = cell_along(c, x[a] - reach);
        w.high[a] = cell_along(c, x[a] + reach);
    }
    return w;
}

static int walk_on(walk *w)
{
    for (int a = 0; a < 3; a++) {
        if (++w->cell[a] <= w->high[a])
            return 1;
        w->cell[a] = w->low[a];
    }
    return 0;
}

static double distance2(const double x[3], const adcgs_cloud_place *place)
{
    const double d[3] = {x[0] - place->x[0], x[1] - place->x[1], x[2] - place->x[2]};
    return adcgs_v3_dot(d, d);
}

/** A query and its best match so far. */
typedef struct query {
    const double *x;
    const float *rgb;
    double tint, most; /* colour weight; bound of the squared distance in space */
    double least;      /* squared distance with colour; negative: no match yet */
    uint32_t found;
} query;

static void look_in_cell(const adcgs_cloud *c, const int64_t cell[3], query *q)
{
    const uint32_t k = number_of(c, cell);
    for (uint32_t i = c->first[k]; i < c->first[k + 1]; i++) {
        double far = distance2(q->x, &c->at[i]);
        if (far > q->most)
            continue;
        const adcgs_stereo_point *p = &c->p[c->at[i].i];
        for (int a = 0; a < 3; a++) {
            const double off = q->tint * (double)(q->rgb[a] - p->rgb[a]);
            far += off * off;
        }
        if ((q->least < 0 || far < q->least) && !p->body) {
            q->least = far;
            q->most = far < q->most ? far : q->most;
            q->found = c->at[i].i;
        }
    }
}

/**
 * Squared distance from a position to a cell along one axis. Slightly reduced, because points are assigned to cells with
 * rounding.
 */
static double gap2(const adcgs_cloud *c, double x, int64_t cell)
{
    const double low = (double)cell * c->edge - x, high = x - (double)(cell + 1) * c->edge;
    const double gap = (low > high ? low : high) - 1e-9 * c->edge;
    return gap > 0 ? gap * gap : 0;
}

double adcgs_cloud_nearest(const adcgs_cloud *c, const double x[3], const float rgb[3], double reach, double tint,
                           uint32_t *found)
{
    query q = {.x = x, .rgb = rgb, .tint = tint, .most = reach * reach, .least = -1};
    const walk w = walk_about(c, x, reach);
    const int64_t own[3] = {cell_along(c, x[0]), cell_along(c, x[1]), cell_along(c, x[2])};
    int64_t cell[3];
    look_in_cell(c, own, &q); /* its best match prunes most other cells */
    for (cell[2] = w.low[2]; cell[2] <= w.high[2]; cell[2]++) {
        const double gap_z = gap2(c, x[2], cell[2]);
        for (cell[1] = w.low[1]; cell[1] <= w.high[1] && gap_z <= q.most; cell[1]++) {
            const double gap_y = gap_z + gap2(c, x[1], cell[1]);
            for (cell[0] = w.low[0]; cell[0] <= w.high[0] && gap_y <= q.most; cell[0]++)
                if (gap_y + gap2(c, x[0], cell[0]) <= q.most && memcmp(cell, own, sizeof cell) != 0)
                    look_in_cell(c, cell, &q);
        }
    }
    if (q.least >= 0)
        *found = q.found;
    return q.least;
}

uint32_t adcgs_cloud_within(const adcgs_cloud *c, const double x[3], double reach, uint32_t *found, uint32_t most)
{
    uint32_t n = 0;
    walk w = walk_about(c, x, reach);
    do {
        const uint32_t k = number_of(c, w.cell);
        for (uint32_t i = c->first[k]; i < c->first[k + 1] && n < most; i++) {
            if (distance2(x, &c->at[i]) <= reach * reach)
                found[n++] = c->at[i].i;
        }
    } while (walk_on(&w));
    return n;
}

/** Direction of least variance of the points. */
static void find_normal(const adcgs_cloud *c, const uint32_t *near, uint32_t n, double out[3])
{
    double mean[3] = {0, 0, 0}, spread[9] = {0}, v[9];
    for (uint32_t i = 0; i < n; i++)
        for (int a = 0; a < 3; a++)
            mean[a] += c->p[near[i]].x[a] / n;
    for (uint32_t i = 0; i < n; i++)
        for (int k = 0; k < 9; k++)
            spread[k] += (c->p[near[i]].x[k / 3] - mean[k / 3]) * (c->p[near[i]].x[k % 3] - mean[k % 3]);
    adcgs_symmetric_eigen(spread, v, 3);
    int least = 0;
    for (int a = 1; a < 3; a++)
        if (spread[4 * a] < spread[4 * least])
            least = a;
    for (int a = 0; a < 3; a++)
        out[a] = v[3 * a + least];
}

void adcgs_cloud_normals(const adcgs_cloud *c, double reach, const adcgs_stereo_rig *rig, float (*normal)[3])
{
    uint32_t near[AROUND];
    for (uint32_t i = 0; i < c->n; i++) {
        const uint32_t n = adcgs_cloud_within(c, c->p[i].x, reach, near, AROUND);
        double out[3] = {0, 0, 0}, faces = 0;
        if (n >= NORMAL_LEAST)
            find_normal(c, near, n, out);
        for (int k = 0; k < rig->n_cameras; k++) {
            const double *at = rig->camera[k].view.centre;
            double to[3] = {at[0] - c->p[i].x[0], at[1] - c->p[i].x[1], at[2] - c->p[i].x[2]};
            if (!rig->camera[k].background)
                continue;
            adcgs_v3_normalise(to);
            faces += adcgs_v3_dot(to, out);
        }
        for (int a = 0; a < 3; a++)
            normal[i][a] = (float)(faces < 0 ? -out[a] : out[a]);
    }
}

adcgs_status adcgs_cloud_parts(const adcgs_cloud *c, double reach, const uint8_t *mark, uint32_t *part, uint32_t *n_parts,
                               adcgs_error *error)
{
    uint32_t near[AROUND], *next = adcgs_alloc(NULL, c->n, sizeof *next, error);
    *n_parts = 0;
    if (!next)
        return adcgs_alloc_status(error);
    memset(part, 0, c->n * sizeof *part);
    for (uint32_t seed = 0; seed < c->n; seed++) {
        uint32_t n = 0;
        if (part[seed] || mark[seed] || c->p[seed].body)
            continue;
        part[seed] = ++*n_parts;
        for (next[n++] = seed; n > 0;) {
            const uint32_t i = next[--n], m = adcgs_cloud_within(c, c->p[i].x, reach, near, AROUND);
            for (uint32_t k = 0; k < m; k++)
                if (!part[near[k]] && !mark[near[k]] && !c->p[near[k]].body) {
                    part[near[k]] = *n_parts;
                    next[n++] = near[k];
                }
        }
    }
    adcgs_free(NULL, next);
    return ADCGS_OK;
}

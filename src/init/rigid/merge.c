/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Grid cells in the rest pose. */
#include "init/rigid/merge.h"

#include "geometry/vector.h"
#include "grad/random.h"

#include <math.h>
#include <stdlib.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
enum {
    LEAST = 60,  /* minimum number of points of a merged model */
    AROUND = 48, /* maximum number of neighbours */
    MEET = 6     /* minimum number of points for smoothing */
};
#define EDGE 1.2           /* pixels: size of a cell */
#define SMOOTH 2.5         /* pixels: radius of smoothing */
#define NORMALS_ALIKE 0.7f /* cosine: minimum between normals of points that are smoothed together */

/** A frame's point, transformed to the rest pose. */
typedef struct entry {
    uint64_t cell;
    int frame;
    double x[3];
    float rgb[3], normal[3], size;
} entry;

static int by_cell(const void *a, const void *b)
{
    const entry *p = a, *q = b;
    if (p->cell != q->cell)
        return p->cell < q->cell ? -1 : 1;
    if (p->frame != q->frame)
        return p->frame - q->frame;
    for (int k = 0; k < 3; k++)
        if (p->x[k] < q->x[k] || p->x[k] > q->x[k])
            return p->x[k] < q->x[k] ? -1 : 1;
    return 0;
}

/** Transforms a frame's point to the rest pose. Returns 1 if the body has a similar point there. */
static int set_entry(entry *e, const adcgs_track *t, const adcgs_layers *l, const adcgs_cloud *own, int frame, uint32_t i,
                     const adcgs_rigid *back)
{
    const adcgs_stereo_point *p = &l->all[frame].p[i];
    const float *n = l->normal[l->begin[frame] + i];
    double normal[3];
    uint32_t near;
    if (p->body)
        return 0;
    adcgs_rigid_apply(back, p->x, e->x);
    adcgs_rigid_turn(back, (const double[]){(double)n[0], (double)n[1], (double)n[2]}, normal);
    e->frame = frame;
    e->size = p->size;
    e->cell = 0;
    for (int a = 0; a < 3; a++)
        e->normal[a] = (float)normal[a];
    const float *gain = t->place[frame].gain[adcgs_body_side(e->normal)];
    for (int a = 0; a < 3; a++) {
        e->rgb[a] = p->rgb[a] / gain[a];
        e->cell = adcgs_mix64(e->cell ^ (uint64_t)(int64_t)floor(e->x[a] / (EDGE * t->model.pixel)));
    }
    return adcgs_body_near(&t->model, own, e->x, e->rgb, &near);
}

/** Mean of a cell's entries. Returns 0 if they are all of one frame. */
static int mean_of(const entry *e, uint32_t n, adcgs_stereo_point *p, float normal[3])
{
    *p = (adcgs_stereo_point){.t = 0.5f, .moves = 1};
    memset(normal, 0, 3 * sizeof *normal);
    for (uint32_t i = 0; i < n; i++) {
        p->size += e[i].size / (float)n;
        for (int a = 0; a < 3; a++) {
            p->x[a] += e[i].x[a] / n;
            p->rgb[a] += e[i].rgb[a] / (float)n;
            normal[a] += e[i].normal[a];
        }
    }
    const float length = sqrtf(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    for (int a = 0; a < 3 && length > 0; a++)
        normal[a] /= length;
    return e[0].frame != e[n - 1].frame;
}

static adcgs_status gather(const entry *e, uint32_t n, adcgs_body_model *to, adcgs_error *error)
{
    for (uint32_t i = 0, end; i < n; i = end) {
        adcgs_stereo_point p;
        float normal[3];
        for (end = i + 1; end < n && e[end].cell == e[i].cell; end++)
            ;
        if (mean_of(e + i, end - i, &p, normal))
            ADCGS_TRY(adcgs_body_add(to, &p, normal, error));
    }
    return ADCGS_OK;
}

/** Moves a point along its normal to the mean of its neighbours with similar normals. */
static void smooth_point(const adcgs_body_model *m, const adcgs_cloud *own, uint32_t i, double out[3])
{
    uint32_t near[AROUND], met = 0;
    const uint32_t n = adcgs_cloud_within(own, m->p[i].x, SMOOTH * m->pixel, near, AROUND);
    const float *normal = m->more[i].normal;
    double off = 0;
    memcpy(out, m->p[i].x, 3 * sizeof *out);
    for (uint32_t k = 0; k < n; k++) {
        const float *other = m->more[near[k]].normal;
        if (normal[0] * other[0] + normal[1] * other[1] + normal[2] * other[2] < NORMALS_ALIKE)
            continue;
        met++;
        for (int a = 0; a < 3; a++)
            off += (double)normal[a] * (m->p[near[k]].x[a] - m->p[i].x[a]);
    }
    for (int a = 0; a < 3 && met >= MEET; a++)
        out[a] += (double)normal[a] * off / met;
}

static adcgs_status smooth(adcgs_body_model *m, adcgs_error *error)
{
    adcgs_cloud own = {.p = NULL};
    double(*to)[3] = adcgs_alloc(NULL, m->n, sizeof *to, error);
    adcgs_status status = to ? adcgs_cloud_init(&own, m->p, m->n, 1, SMOOTH * m->pixel, error) : adcgs_alloc_status(error);
    for (uint32_t i = 0; i < m->n && status == ADCGS_OK; i++)
        smooth_point(m, &own, i, to[i]);
    for (uint32_t i = 0; i < m->n && status == ADCGS_OK; i++)
        memcpy(m->p[i].x, to[i], sizeof to[i]);
    adcgs_cloud_clear(&own);
    adcgs_free(NULL, to);
    return status;
}

adcgs_status adcgs_track_merge(adcgs_track *t, const adcgs_layers *l, adcgs_error *error)
{
    adcgs_cloud own = {.p = NULL};
    adcgs_body_model merged = {.pixel = t->model.pixel};
    uint32_t n = 0;
    entry *e = adcgs_alloc(NULL, l->begin[l->n], sizeof *e, error);
    adcgs_status status =
        e ? adcgs_cloud_init(&own, t->model.p, t->model.n, 1, 2 * t->model.pixel, error) : adcgs_alloc_status(error);
    for (int m = 0; m < l->n && status == ADCGS_OK; m++) {
        adcgs_rigid back;
        adcgs_rigid_inverse(&t->place[m].at, &back);
        for (uint32_t i = 0; t->known[m] && i < l->all[m].n; i++)
            n += (uint32_t)set_entry(&e[n], t, l, &own, m, i, &back);
    }
    if (status == ADCGS_OK) {
        qsort(e, n, sizeof *e, by_cell);
        status = gather(e, n, &merged, error);
    }
    if (status == ADCGS_OK && merged.n >= LEAST) {
        status = smooth(&merged, error);
        const adcgs_body_model swap = t->model;
        t->model = merged;
        merged = swap;
    }
    adcgs_body_clear(&merged);
    adcgs_cloud_clear(&own);
    adcgs_free(NULL, e);
    return status;
}

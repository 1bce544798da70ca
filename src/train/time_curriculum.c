/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Curriculum over time. */
#include "train/time_curriculum.h"

#include "grad/random.h"

#include <math.h>
#include <stdlib.h>

static int earlier(const void *a, const void *b)
{
    const adcgs_curriculum_view *v = a, *w = b;
    return v->t != w->t ? (v->t > w->t) - (v->t < w->t) : (v->index > w->index) - (v->index < w->index);
}

static int nearer_the_middle(const void *a, const void *b)
{
    const adcgs_curriculum_view *v = a, *w = b;
    const float d = fabsf(v->t - 0.5f), e = fabsf(w->t - 0.5f);
    return d != e ? (d > e) - (d < e) : (v->index > w->index) - (v->index < w->index);
}

adcgs_status adcgs_curriculum_create(adcgs_curriculum *w, const float *t, uint32_t n_views, int forward, adcgs_error *error)
{
    w->views = adcgs_alloc(NULL, n_views, sizeof *w->views, error);
    if (!w->views)
        return adcgs_alloc_status(error);
    w->n_views = n_views;
    w->n = 0;
    w->forward = forward;
    for (uint32_t i = 0; i < n_views; i++)
        w->views[i] = (adcgs_curriculum_view){t[i], i};
    qsort(w->views, n_views, sizeof *w->views, forward ? earlier : nearer_the_middle);
    return ADCGS_OK;
}

void adcgs_curriculum_clear(adcgs_curriculum *w)
{
    adcgs_free(NULL, w->views);
    w->views = NULL;
}

void adcgs_curriculum_walk(adcgs_checkpoint_walk *walk, adcgs_curriculum *w)
{
    adcgs_checkpoint_visit(walk, &w->n, sizeof w->n);
    adcgs_checkpoint_visit(walk, &w->first, sizeof w->first);
    adcgs_checkpoint_visit(walk, &w->last, sizeof w->last);
}

static void copy_row(adcgs_fmodel *f, int to, int from)
{
    const size_t width = f->params.time_width, columns = (size_t)adcgs_fmodel_time_columns(&f->params);
    float *z = f->param[ADCGS_P_TIME].p;
    memcpy(z + (size_t)to * columns, z + (size_t)from * columns, width * sizeof *z); /* poses are known or constant */
}

/** Extrapolates the poses of bodies linearly from the two previous rows, unless they are known. */
static void go_on(adcgs_fmodel *f, int to, unsigned known)
{
    const size_t columns = (size_t)adcgs_fmodel_time_columns(&f->params);
    for (int b = 0; b < f->params.bodies; b++) {
        float *z = f->param[ADCGS_P_TIME].p + (size_t)to * columns + adcgs_pose_at(&f->params, b + 1);
        for (size_t i = 0; !(known >> b & 1) && i < ADCGS_POSE_N; i++)
            z[i] = 2 * z[i - columns] - z[i - 2 * columns];
    }
}

void adcgs_curriculum_grow(adcgs_curriculum *w, double fraction, adcgs_fmodel *f)
{
    const uint32_t n = (uint32_t)ADCGS_MIN(ADCGS_MAX(ceil(fraction * w->n_views), 1), w->n_views);
    const int rows = f->params.time_rows;
    if (n <= w->n)
        return;
    if (!w->n)
        w->first = w->last = w->forward ? ADCGS_MIN(1, rows - 1) : rows / 2;
    const int begun = w->n > 0;
    for (uint32_t i = w->n; rows > 0 && i < n; i++) {
        const float u = w->views[i].t * (float)(rows - 1);
        for (const int first = (int)floorf(u); w->first > first; w->first--)
            if (begun)
                copy_row(f, w->first - 1, w->first);
        for (const int last = (int)ceilf(u); w->last < last; w->last++) {
            if (begun || w->forward)
                copy_row(f, w->last + 1, w->last);
            if (w->forward)
                go_on(f, w->last + 1, w->known);
        }
    }
    w->n = n;
}

uint32_t adcgs_curriculum_pick(const adcgs_curriculum *w, uint64_t seed, uint32_t look)
{
    const uint32_t late = (w->n + 3) / 4, from = look % 2 ? w->n - late : 0;
    return w->views[from + (uint32_t)(adcgs_random64(seed, 2100, look) % (w->n - from))].index;
}

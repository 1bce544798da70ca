/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Pictures of a camera that are another's, of the moment before: files that were mixed up, frames that came twice. */
#include "config.h"

#include "data/faults.h"

#include <math.h>
#include <stdlib.h>

#define SAME 0.1     /* of what a copy is off its camera's other pictures; written anew it is off the other a little */
#define OTHER 0.5    /* of that, which the pictures of both cameras around differ by at least: else they see the same */
#define CONTRAST 0.25 /* of the camera's others, that a copy has at least: what is dark is dark before all cameras */
#define FEW 3        /* pictures of a camera of which nothing can be said */

/** A view in the order of time. */
typedef struct shot {
    double time;
    uint32_t view, camera;
    uint32_t near[2]; /* the views of its camera before and behind it; where it is the first or the last, twice the same */
} shot;

static int by_time(const void *a, const void *b)
{
    const shot *const x = a, *const y = b;
    if (x->time < y->time || x->time > y->time)
        return x->time < y->time ? -1 : 1;
    return x->view < y->view ? -1 : x->view > y->view;
}

/** Mean distance of cells from their mean. */
static double contrast(const adcgs_glance *glance)
{
    double sum = 0.0, distance = 0.0;
    int n = 0;
    for (int i = 0; i < ADCGS_GLANCE_CELLS; i++)
        if (!isnan(glance->cells[i])) {
            sum += (double)glance->cells[i];
            n++;
        }
    for (int i = 0; i < ADCGS_GLANCE_CELLS; i++)
        if (!isnan(glance->cells[i]))
            distance += fabs((double)glance->cells[i] - sum / n);
    return n ? distance / n : 0.0;
}

/** Whether b is a copy of a. Comparisons are such that what is not known says no. */
static int is_copy(const adcgs_glance *glances, const shot *a, const shot *b)
{
    const adcgs_glance *const it = &glances[b->view];
    const double off = fmin(adcgs_glance_difference(it, &glances[b->near[0]]), adcgs_glance_difference(it, &glances[b->near[1]]));
    if (!(off > 0.0 && adcgs_glance_difference(&glances[a->view], it) <= SAME * off))
        return 0;
    for (int i = 0; i < 2; i++)
        if (!(adcgs_glance_difference(&glances[a->near[i]], &glances[b->near[i]]) >= OTHER * off &&
              contrast(it) >= CONTRAST * contrast(&glances[b->near[i]])))
            return 0;
    return 1;
}

/** Those of cameras that took enough. */
static uint32_t take_shots(shot *shots, adcgs_fault *f, const adcgs_scene_view *views, const adcgs_tracks *tracks)
{
    uint32_t count = 0;
    for (uint32_t c = 0; c < tracks->n; c++) {
        const uint32_t *const order = tracks->order + tracks->begin[c], n = tracks->begin[c + 1] - tracks->begin[c];
        f->of += n >= FEW;
        for (uint32_t i = 0; n >= FEW && i < n; i++)
            shots[count++] = (shot){.time = views[order[i]].time, .view = order[i], .camera = c,
                                    .near = {order[i ? i - 1 : 1], order[i + 1 < n ? i + 1 : n - 2]}};
    }
    qsort(shots, count, sizeof *shots, by_time);
    return count;
}

/** counts: [cameras] 0. */
static void look(adcgs_fault *f, const adcgs_scene_view *views, const shot *shots, uint32_t n, const adcgs_glance *glances,
                 uint32_t *counts)
{
    for (uint32_t i = 1; i < n; i++) {
        if (shots[i].camera == shots[i - 1].camera || !is_copy(glances, &shots[i - 1], &shots[i]))
            continue;
        if (!f->size++) {
            f->path = views[shots[i].view].path;
            f->from = f->to = shots[i].time;
        }
        f->cameras += !counts[shots[i].camera]++;
        f->count = ADCGS_MAX(f->count, counts[shots[i].camera]);
    }
}

adcgs_status adcgs_fault_copied(adcgs_fault *fault, const adcgs_scene_view *views, const adcgs_tracks *tracks,
                                const adcgs_glance *glances, adcgs_error *error)
{
    *fault = (adcgs_fault){.cameras = 0};
    if (tracks->n < 2)
        return ADCGS_OK;
    shot *const shots = adcgs_alloc(NULL, tracks->begin[tracks->n], sizeof *shots, error);
    uint32_t *const counts = adcgs_alloc(NULL, tracks->n, sizeof *counts, error);
    const adcgs_status status = shots && counts ? ADCGS_OK : adcgs_alloc_status(error);
    if (status == ADCGS_OK)
        look(fault, views, shots, take_shots(shots, fault, views, tracks), glances, counts);
    adcgs_free(NULL, shots);
    adcgs_free(NULL, counts);
    return status;
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Images that repeat another camera's image of the time before: files that were mixed up, or frames delivered twice.
 */
#include "config.h"

#include "check/faults.h"

#include <math.h>
#include <stdlib.h>

/*
 * Origin: chosen by hand, and checked on 46 generated scenes and six others without faults, and on faults of known strength
 * (doc/log/stability.md, "Warnings about footage").
 */
#define SAME 0.1      /* largest share of the copy's change from its camera's other images; re-encoding alters a copy slightly */
#define OTHER 0.5     /* least share of that change by which the cameras' other images differ: else both see the same */
#define CONTRAST 0.25 /* least contrast, as a share of the camera's other images: dark images look alike in all cameras */
#define FEW 3         /* least number of images of a camera; fewer are not judged */

/** A view in the order of time. */
typedef struct capture {
    double time;
    uint32_t view, camera;
    uint32_t near[2]; /* the camera's previous and next view; for its first and last view, the only neighbour twice */
} capture;

static int by_time(const void *a, const void *b)
{
    const capture *const x = a, *const y = b;
    if (x->time < y->time || x->time > y->time)
        return x->time < y->time ? -1 : 1;
    return x->view < y->view ? -1 : x->view > y->view;
}

/** Mean absolute distance of the cells from their mean. */
static double contrast(const adcgs_thumbnail *thumbnail)
{
    double sum = 0.0, distance = 0.0;
    int n = 0;
    for (int i = 0; i < ADCGS_THUMBNAIL_CELLS; i++)
        if (!isnan(thumbnail->cells[i])) {
            sum += (double)thumbnail->cells[i];
            n++;
        }
    for (int i = 0; i < ADCGS_THUMBNAIL_CELLS; i++)
        if (!isnan(thumbnail->cells[i]))
            distance += fabs((double)thumbnail->cells[i] - sum / n);
    return n ? distance / n : 0.0;
}

/** True if b is a copy of a. The comparisons are written so that unknown values (NaN) yield false. */
static int is_copy(const adcgs_thumbnail *thumbnails, const capture *a, const capture *b)
{
    const adcgs_thumbnail *const it = &thumbnails[b->view];
    const double off =
        fmin(adcgs_thumbnail_difference(it, &thumbnails[b->near[0]]), adcgs_thumbnail_difference(it, &thumbnails[b->near[1]]));
    if (!(off > 0.0 && adcgs_thumbnail_difference(&thumbnails[a->view], it) <= SAME * off))
        return 0;
    for (int i = 0; i < 2; i++)
        if (!(adcgs_thumbnail_difference(&thumbnails[a->near[i]], &thumbnails[b->near[i]]) >= OTHER * off &&
              contrast(it) >= CONTRAST * contrast(&thumbnails[b->near[i]])))
            return 0;
    return 1;
}

/** Lists the views of cameras with enough images, and returns their number. */
static uint32_t list_captures(capture *captures, adcgs_fault *f, const adcgs_scene_view *views, const adcgs_camera_order *tracks)
{
    uint32_t count = 0;
    for (uint32_t c = 0; c < tracks->n; c++) {
        const uint32_t *const order = tracks->order + tracks->begin[c], n = tracks->begin[c + 1] - tracks->begin[c];
        f->of += n >= FEW;
        for (uint32_t i = 0; n >= FEW && i < n; i++)
            captures[count++] = (capture){.time = views[order[i]].time,
                                          .view = order[i],
                                          .camera = c,
                                          .near = {order[i ? i - 1 : 1], order[i + 1 < n ? i + 1 : n - 2]}};
    }
    qsort(captures, count, sizeof *captures, by_time);
    return count;
}

/** counts: [cameras], zero on entry. */
static void find_copies(adcgs_fault *f, const adcgs_scene_view *views, const capture *captures, uint32_t n,
                        const adcgs_thumbnail *thumbnails, uint32_t *counts)
{
    for (uint32_t i = 1; i < n; i++) {
        if (captures[i].camera == captures[i - 1].camera || !is_copy(thumbnails, &captures[i - 1], &captures[i]))
            continue;
        if (!f->size++) {
            f->path = views[captures[i].view].path;
            f->from = f->to = captures[i].time;
        }
        f->cameras += !counts[captures[i].camera]++;
        f->count = ADCGS_MAX(f->count, counts[captures[i].camera]);
    }
}

adcgs_status adcgs_fault_copied(adcgs_fault *fault, const adcgs_scene_view *views, const adcgs_camera_order *tracks,
                                const adcgs_thumbnail *thumbnails, adcgs_error *error)
{
    *fault = (adcgs_fault){.cameras = 0};
    if (tracks->n < 2)
        return ADCGS_OK;
    capture *const captures = adcgs_alloc(NULL, tracks->begin[tracks->n], sizeof *captures, error);
    uint32_t *const counts = adcgs_alloc(NULL, tracks->n, sizeof *counts, error);
    const adcgs_status status = captures && counts ? ADCGS_OK : adcgs_alloc_status(error);
    if (status == ADCGS_OK)
        find_copies(fault, views, captures, list_captures(captures, fault, views, tracks), thumbnails, counts);
    adcgs_free(NULL, captures);
    adcgs_free(NULL, counts);
    return status;
}

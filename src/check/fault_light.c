/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Steps in brightness or colour. Constant differences between cameras are no steps: cameras see different content, and training
 * fits their gains.
 */
#include "config.h"

#include "check/faults.h"

#include <math.h>

/*
 * Origin: chosen by hand, and checked on 46 generated scenes and six others without faults, and on faults of known strength
 * (doc/log/stability.md, "Warnings about footage").
 */
#define STEP 0.077       /* least step: the logarithm of 1.08 */
#define ALONE (1.0 / 3)  /* largest change before and after, as a share of the step: beyond it the light changes all the time */
#define SPREAD (1.0 / 3) /* largest median deviation of an image's cells, as a share of the step: beyond it the content changes */
#define FEW 6            /* least number of images of a camera; fewer are not judged */

typedef struct step {
    double from, to; /* times before and after the step */
    double size;     /* logarithm of the factor; 0: none */
    uint32_t count;  /* number of steps of this camera */
    uint32_t view;   /* the first view after the step */
} step;

/** The step of light from one image to the next, 0 if the change is no such step; *any is the change in any case. */
static double step_between(const adcgs_thumbnail *a, const adcgs_thumbnail *b, adcgs_thumbnail_light light, double *any)
{
    double spread;
    *any = adcgs_thumbnail_compare(a, b, light, &spread);
    return fabs(*any) >= STEP && spread <= SPREAD * fabs(*any) ? *any : 0.0;
}

/** The largest step of one camera. A flash is a step and a step back. behind: [views], views behind a step become 1; or NULL. */
static step find_step(const adcgs_scene_view *views, const adcgs_thumbnail *thumbnails, const uint32_t *order, uint32_t n,
                      adcgs_thumbnail_light light, uint8_t *behind)
{
    step out = {.size = 0.0};
    double before = 0.0, at = 0.0, after = 0.0, next;
    (void)step_between(&thumbnails[order[0]], &thumbnails[order[1]], light, &before);
    double size = step_between(&thumbnails[order[1]], &thumbnails[order[2]], light, &at);
    for (uint32_t i = 1; i + 2 < n; i++, before = at, at = after, size = next) {
        next = step_between(&thumbnails[order[i + 1]], &thumbnails[order[i + 2]], light, &after);
        const double back = fmin(fabs(after), fabs(after + at));
        if (!(fabs(size) > 0.0 && fabs(before) <= ALONE * fabs(size) && back <= ALONE * fabs(size)))
            continue;
        out.count++;
        if (behind) {
            behind[order[i + 1]] = 1;
            behind[order[i + 2]] |= fabs(after) > back; /* the step back of a flash */
        }
        if (fabs(size) > fabs(out.size)) {
            out.size = size;
            out.view = order[i + 1];
            out.from = views[order[i]].time;
            out.to = views[order[i + 1]].time;
        }
    }
    return out;
}

/** Number of cameras with a step of the same sign in the same interval as the given one. */
static uint32_t count_like(const step *steps, uint32_t n, const step *one)
{
    uint32_t count = 0;
    for (uint32_t c = 0; c < n; c++)
        count += steps[c].size * one->size > 0.0 && steps[c].from < one->to && steps[c].to > one->from;
    return count;
}

/** The step that most cameras share, and the largest of these; its size is still a logarithm. */
static void judge(adcgs_fault *f, const adcgs_scene_view *views, const step *steps, uint32_t n)
{
    for (uint32_t c = 0; c < n; c++) {
        const uint32_t like = fabs(steps[c].size) > 0.0 ? count_like(steps, n, &steps[c]) : 0;
        if (like < f->cameras || !like || (like == f->cameras && fabs(steps[c].size) <= fabs(f->size)))
            continue;
        f->cameras = like;
        f->path = views[steps[c].view].path;
        f->count = steps[c].count;
        f->from = steps[c].from;
        f->to = steps[c].to;
        f->size = steps[c].size;
    }
}

adcgs_status adcgs_fault_light(adcgs_fault *fault, uint8_t *behind, const adcgs_scene_view *views,
                               const adcgs_camera_order *tracks, const adcgs_thumbnail *thumbnails, adcgs_error *error)
{
    step *const steps = adcgs_alloc(NULL, (size_t)tracks->n + 1, sizeof *steps, error);
    *fault = (adcgs_fault){.cameras = 0};
    if (!steps)
        return adcgs_alloc_status(error);
    for (int light = 0; light < ADCGS_LIGHTS; light++) { /* the largest step decides: redder images may also be brighter */
        adcgs_fault found = {.light = (adcgs_thumbnail_light)light};
        for (uint32_t c = 0; c < tracks->n; c++) {
            const uint32_t n = tracks->begin[c + 1] - tracks->begin[c];
            if (n >= FEW)
                steps[found.of++] = find_step(views, thumbnails, tracks->order + tracks->begin[c], n, found.light, behind);
        }
        judge(&found, views, steps, found.of);
        if (!light || fabs(found.size) > fabs(fault->size))
            *fault = found;
    }
    fault->size = exp(fault->size);
    adcgs_free(NULL, steps);
    return ADCGS_OK;
}

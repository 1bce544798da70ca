/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Consistency of depths between views. */
#include "init/fuse.h"

#include <math.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
enum {
    AGREE_STRONG = 2, /* other views that must confirm a strong depth */
    AGREE_WEAK = 3    /* other views that must confirm a weak depth */
};
#define SAME 1.0   /* planes: maximum difference of equal depths */
#define BEHIND 3.0 /* planes: minimum difference of different depths */

adcgs_status adcgs_stereo_list_add(adcgs_stereo_list *list, const adcgs_stereo_point *point, adcgs_error *error)
{
    if (list->n == list->capacity) {
        const size_t capacity = list->capacity ? 2 * list->capacity : 4096;
        adcgs_stereo_point *more = adcgs_alloc(NULL, capacity, sizeof *more, error);
        if (!more)
            return adcgs_alloc_status(error);
        if (list->n)
            memcpy(more, list->point, list->n * sizeof *more);
        adcgs_free(NULL, list->point);
        list->point = more;
        list->capacity = capacity;
    }
    list->point[list->n++] = *point;
    return ADCGS_OK;
}

void adcgs_stereo_list_clear(adcgs_stereo_list *list)
{
    adcgs_free(NULL, list->point);
    *list = (adcgs_stereo_list){0, 0, NULL};
}

adcgs_verdict adcgs_depths_judge(const adcgs_depths *d, const double x[3], double there[3])
{
    double at[2], depth;
    if (!adcgs_stereo_rig_project(d->view, x, at, &depth))
        return ADCGS_VERDICT_UNKNOWN;
    const int px = (int)at[0] - d->x, py = (int)at[1] - d->y;
    if (px < 0 || py < 0 || px >= d->w || py >= d->h || d->quality[py * d->w + px] == ADCGS_DEPTH_NONE)
        return ADCGS_VERDICT_UNKNOWN;
    const double inverse = (double)d->inverse[py * d->w + px], off = 1 / depth - inverse;
    if (off > BEHIND * d->step)
        return ADCGS_VERDICT_BEHIND;
    if (off < -BEHIND * d->step)
        return ADCGS_VERDICT_HIDDEN;
    if (fabs(off) > SAME * d->step)
        return ADCGS_VERDICT_UNKNOWN;
    for (int a = 0; a < 3; a++)
        there[a] = d->view->centre[a] + (x[a] - d->view->centre[a]) / (inverse * depth);
    return ADCGS_VERDICT_SAME;
}

float adcgs_stereo_detail(const adcgs_stereo_view *v, int px, int py)
{
    float least = 3, most = 0;
    for (int y = ADCGS_MAX(py - 1, 0); y <= ADCGS_MIN(py + 1, v->h - 1); y++)
        for (int x = ADCGS_MAX(px - 1, 0); x <= ADCGS_MIN(px + 1, v->w - 1); x++) {
            const float *p = v->pixels + 4 * ((size_t)y * (size_t)v->w + (size_t)x), sum = p[0] + p[1] + p[2];
            least = fminf(least, sum);
            most = fmaxf(most, sum);
        }
    return (most - least) / 3;
}

/** Sets the point of a pixel of depths[own] to the mean over the confirming views. Returns 0 if there are too few. */
static int confirm(adcgs_stereo_point *p, const adcgs_depths *depths, int n, int own, int px, int py)
{
    const adcgs_depths *d = &depths[own];
    const uint8_t quality = d->quality[py * d->w + px];
    const double depth = 1 / (double)d->inverse[py * d->w + px];
    const int need = ADCGS_MIN(quality == ADCGS_DEPTH_STRONG ? AGREE_STRONG : AGREE_WEAK, n - 1);
    double x[3], there[3], sum[3];
    int same = 0, behind = 0;
    if (quality == ADCGS_DEPTH_NONE || n < 2)
        return 0;
    adcgs_stereo_rig_lift(d->view, px + d->x, py + d->y, depth, x);
    memcpy(sum, x, sizeof sum);
    for (int i = 0; i < n; i++) {
        const adcgs_verdict verdict = i == own ? ADCGS_VERDICT_UNKNOWN : adcgs_depths_judge(&depths[i], x, there);
        behind += verdict == ADCGS_VERDICT_BEHIND;
        for (int a = 0; verdict == ADCGS_VERDICT_SAME && a < 3; a++)
            sum[a] += there[a];
        same += verdict == ADCGS_VERDICT_SAME;
    }
    if (same < need || behind > same)
        return 0;
    const float *pixel = d->view->pixels + 4 * ((size_t)(py + d->y) * (size_t)d->view->w + (size_t)(px + d->x));
    for (int a = 0; a < 3; a++) {
        p->x[a] = sum[a] / (same + 1);
        p->rgb[a] = pixel[a];
    }
    p->size = (float)(depth / d->view->fx);
    p->detail = adcgs_stereo_detail(d->view, px + d->x, py + d->y);
    return 1;
}

/** Fuses one view. good: [h][w] receives the quality of its depths. */
static adcgs_status fuse_one(adcgs_stereo_list *list, const adcgs_depths *depths, int n, int own, const uint8_t *wanted,
                             const adcgs_stereo_point *like, uint8_t *good, adcgs_error *error)
{
    const adcgs_depths *d = &depths[own];
    for (int y = 0; y < d->h; y++)
        for (int x = 0; x < d->w; x++) {
            adcgs_stereo_point p = *like;
            const int sure = confirm(&p, depths, n, own, x, y);
            good[y * d->w + x] = sure ? ADCGS_DEPTH_STRONG : ADCGS_DEPTH_NONE;
            if (sure && (!wanted || wanted[(size_t)(y + d->y) * (size_t)d->view->w + (size_t)(x + d->x)]))
                ADCGS_TRY(adcgs_stereo_list_add(list, &p, error));
        }
    return ADCGS_OK;
}

adcgs_status adcgs_fuse(adcgs_stereo_list *list, adcgs_depths *depths, int n, const uint8_t *const *wanted,
                        const adcgs_stereo_point *like, adcgs_error *error)
{
    uint8_t *good[ADCGS_STEREO_CAMERAS] = {NULL};
    adcgs_status status = ADCGS_OK;
    for (int i = 0; i < n && status == ADCGS_OK; i++) {
        good[i] = adcgs_alloc(NULL, (size_t)depths[i].w * (size_t)depths[i].h, 1, error);
        status = good[i] ? fuse_one(list, depths, n, i, wanted[i], like, good[i], error) : adcgs_alloc_status(error);
    }
    for (int i = 0; i < n; i++) {                    /* after all views, so that no result depends on their order */
        if (status == ADCGS_OK && depths[i].quality) /* views without matching have no quality map */
            memcpy(depths[i].quality, good[i], (size_t)depths[i].w * (size_t)depths[i].h);
        adcgs_free(NULL, good[i]);
    }
    return status;
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Views sorted by camera. */
#include "config.h"

#include "scene/group_views.h"

#include <stdlib.h>

typedef struct item {
    const adcgs_scene_view *view;
    uint32_t index;
    uint32_t first; /* index of the first view of the same camera */
} item;

int adcgs_camera_compare(const adcgs_camera *a, const adcgs_camera *b)
{
    const double lens_a[4] = {a->fx, a->fy, a->cx, a->cy}, lens_b[4] = {b->fx, b->fy, b->cx, b->cy};
    if (a->width != b->width)
        return a->width < b->width ? -1 : 1;
    if (a->height != b->height)
        return a->height < b->height ? -1 : 1;
    const int lens = memcmp(lens_a, lens_b, sizeof lens_a);
    return lens ? lens : memcmp(a->cam_to_world, b->cam_to_world, sizeof a->cam_to_world);
}

static int compare_index(const item *a, const item *b)
{
    return a->index < b->index ? -1 : a->index > b->index;
}

static int by_camera(const void *a, const void *b)
{
    const item *x = a, *y = b;
    const int order = adcgs_camera_compare(&x->view->camera, &y->view->camera);
    return order ? order : compare_index(x, y);
}

static int by_first_and_time(const void *a, const void *b)
{
    const item *x = a, *y = b;
    if (x->first != y->first)
        return x->first < y->first ? -1 : 1;
    if (x->view->time < y->view->time || x->view->time > y->view->time)
        return x->view->time < y->view->time ? -1 : 1;
    return compare_index(x, y);
}

adcgs_status adcgs_group_views(const adcgs_scene_view *views, uint32_t n, uint32_t *of, uint32_t *order, uint32_t *n_cameras,
                               adcgs_error *error)
{
    item *items = adcgs_alloc(NULL, n, sizeof *items, error);
    if (!items)
        return adcgs_alloc_status(error);
    for (uint32_t i = 0; i < n; i++)
        items[i] = (item){.view = &views[i], .index = i};
    qsort(items, n, sizeof *items, by_camera);
    for (uint32_t i = 0; i < n; i++) {
        const int same = i && !adcgs_camera_compare(&items[i - 1].view->camera, &items[i].view->camera);
        items[i].first = same ? items[i - 1].first : items[i].index;
    }
    qsort(items, n, sizeof *items, by_first_and_time);
    *n_cameras = 0;
    for (uint32_t i = 0; i < n; i++) {
        *n_cameras += !i || items[i].first != items[i - 1].first;
        of[items[i].index] = *n_cameras - 1;
        if (order)
            order[i] = items[i].index;
    }
    adcgs_free(NULL, items);
    return ADCGS_OK;
}

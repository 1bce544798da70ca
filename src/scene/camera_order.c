/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The views of each camera, in ascending time. */
#include "config.h"

#include "scene/camera_order.h"

#include "scene/group_views.h"

#include <stdlib.h>

/* Least mean number of views per camera: with fewer, equal cameras are chance; chosen by hand, not measured. */
#define STAY 3

typedef struct item {
    double time;
    uint32_t index;
} item;

static int by_time(const void *a, const void *b)
{
    const item *const x = a, *const y = b;
    if (x->time < y->time || x->time > y->time)
        return x->time < y->time ? -1 : 1;
    return x->index < y->index ? -1 : x->index > y->index;
}

/** All views as one track, if no two have the same time. */
static adcgs_status find_moving(adcgs_camera_order *tracks, const adcgs_scene_view *views, uint32_t n, adcgs_error *error)
{
    item *const items = adcgs_alloc(NULL, n, sizeof *items, error);
    if (!items)
        return adcgs_alloc_status(error);
    for (uint32_t i = 0; i < n; i++)
        items[i] = (item){views[i].time, i};
    qsort(items, n, sizeof *items, by_time);
    int distinct = 1;
    for (uint32_t i = 0; i < n; i++) {
        distinct &= !i || items[i].time > items[i - 1].time;
        tracks->order[i] = items[i].index;
    }
    adcgs_free(NULL, items);
    tracks->moves = distinct;
    tracks->n = (uint32_t)distinct;
    tracks->begin[distinct] = distinct ? n : 0;
    return ADCGS_OK;
}

static adcgs_status find(adcgs_camera_order *tracks, const adcgs_scene_view *views, uint32_t n, uint32_t *of, adcgs_error *error)
{
    uint32_t cameras;
    ADCGS_TRY(adcgs_group_views(views, n, of, tracks->order, &cameras, error));
    if (cameras > 1 && n < STAY * cameras)
        return find_moving(tracks, views, n, error);
    tracks->n = cameras;
    for (uint32_t i = 0; i < n; i++)
        tracks->begin[of[tracks->order[i]] + 1] = i + 1;
    return ADCGS_OK;
}

adcgs_status adcgs_camera_order_find(adcgs_camera_order *tracks, const adcgs_scene_view *views, uint32_t n, adcgs_error *error)
{
    uint32_t *const of = adcgs_alloc(NULL, n + 1, sizeof *of, error);
    *tracks = (adcgs_camera_order){.begin = adcgs_alloc(NULL, (size_t)n + 2, sizeof *tracks->begin, error),
                                   .order = adcgs_alloc(NULL, (size_t)n + 1, sizeof *tracks->order, error)};
    adcgs_status status = of && tracks->begin && tracks->order ? ADCGS_OK : adcgs_alloc_status(error);
    if (status == ADCGS_OK && n)
        status = find(tracks, views, n, of, error);
    adcgs_free(NULL, of);
    if (status != ADCGS_OK)
        adcgs_camera_order_clear(tracks);
    return status;
}

void adcgs_camera_order_clear(adcgs_camera_order *tracks)
{
    adcgs_free(NULL, tracks->begin);
    adcgs_free(NULL, tracks->order);
    *tracks = (adcgs_camera_order){.n = 0};
}

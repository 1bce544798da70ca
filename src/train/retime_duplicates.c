/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Duplicated images get the timestamp of their content. */
#include "config.h"

#include "train/retime_duplicates.h"

#include "check/faults.h"

adcgs_status adcgs_retime_duplicates(adcgs_trainer *t, const adcgs_thumbnail *thumbnails, adcgs_error *error)
{
    const adcgs_scene_view *const views = t->scene->views[ADCGS_SPLIT_TRAIN];
    adcgs_camera_order tracks;
    adcgs_fault found;
    uint32_t *shows = adcgs_alloc(NULL, t->views.n, sizeof *shows, error);
    if (!shows)
        return adcgs_alloc_status(error);
    for (uint32_t i = 0; i < t->views.n; i++)
        shows[i] = i;
    const adcgs_status status = adcgs_camera_order_find(&tracks, views, t->views.n, error);
    if (status == ADCGS_OK) {
        adcgs_fault_duplicates(&found, shows, views, &tracks, thumbnails);
        adcgs_camera_order_clear(&tracks);
    }
    for (uint32_t i = 0; status == ADCGS_OK && i < t->views.n; i++)
        t->views.list[i].t = adcgs_trainer_time(t, views[shows[i]].time);
    adcgs_free(NULL, shows);
    return status;
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Pictures of a camera that come twice. */
#include "config.h"

#include "data/faults.h"

#include "data/tracks.h"

#include <math.h>

#define SAME 0.1   /* of the change before and behind: noise alone is more, and what stops for a moment comes to it slowly */
#define ONWARDS 0.5 /* of these changes, that pictures around differ by: what goes to and fro, or comes and goes, may rest in between */
#define COPIES 3   /* that one picture may have: what rests for longer rests */
#define FEW 6      /* pictures of a camera of which nothing can be said */

/** Of one camera: how many of its pictures are the one before, and the first of them. */
static uint32_t count_copies(const adcgs_glance *glances, const uint32_t *order, uint32_t n, uint32_t *first)
{
    uint32_t count = 0;
    for (uint32_t i = 1; i + 2 < n; i++) { /* order[i] and its copies, between two others */
        const adcgs_glance *const before = &glances[order[i - 1]], *const it = &glances[order[i]];
        const double change = adcgs_glance_difference(before, it);
        uint32_t copies = 0;
        while (copies < COPIES && i + copies + 2 < n &&
               adcgs_glance_difference(it, &glances[order[i + copies + 1]]) <= SAME * change)
            copies++;
        const adcgs_glance *const behind = &glances[order[i + copies + 1]];
        const double next = adcgs_glance_difference(&glances[order[i + copies]], behind);
        double inside = 0.0;
        for (uint32_t k = 0; k < copies; k++)
            inside = fmax(inside, adcgs_glance_difference(&glances[order[i + k]], &glances[order[i + k + 1]]));
        if (!copies || !(change > 0.0 && inside <= SAME * next) ||
            !(adcgs_glance_difference(before, behind) >= ONWARDS * fmax(change, next)))
            continue;
        *first = count ? *first : order[i + 1];
        count += copies;
        i += copies;
    }
    return count;
}

adcgs_status adcgs_fault_doubled(adcgs_fault *fault, const adcgs_scene *scene, const adcgs_glance *glances, adcgs_error *error)
{
    const adcgs_scene_view *const views = scene->views[ADCGS_SPLIT_TRAIN];
    adcgs_tracks tracks;
    *fault = (adcgs_fault){.cameras = 0};
    ADCGS_TRY(adcgs_tracks_find(&tracks, views, scene->n_views[ADCGS_SPLIT_TRAIN], error));
    for (uint32_t c = 0; c < tracks.n; c++) {
        const uint32_t n = tracks.begin[c + 1] - tracks.begin[c];
        uint32_t first = 0;
        if (n < FEW)
            continue;
        const uint32_t count = count_copies(glances, tracks.order + tracks.begin[c], n, &first);
        fault->of++;
        fault->cameras += count > 0;
        fault->size += count;
        if (count > fault->count) {
            fault->count = count;
            fault->path = views[first].path;
            fault->from = fault->to = views[first].time;
        }
    }
    adcgs_tracks_clear(&tracks);
    return ADCGS_OK;
}

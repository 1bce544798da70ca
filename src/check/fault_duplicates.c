/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Duplicate frames of a camera. */
#include "config.h"

#include "check/faults.h"

#include <math.h>

/*
 * Origin: chosen by hand, and checked on 46 generated scenes and six others without faults, and on faults of known strength
 * (doc/log/stability.md, "Warnings about footage").
 */
#define SAME 0.1    /* largest share of the changes before and after: noise alone exceeds it, and objects stop gradually */
#define ONWARDS 0.5 /* least share of these changes by which the images around differ: oscillating objects may pause */
#define COPIES 2    /* most duplicates of one image: a longer pause is a real pause, or the object is hidden */
#define PICTURES 2  /* least number of images with duplicates in a camera: one may be a moving object that is hidden briefly */
#define FEW 6       /* least number of images of a camera; fewer are not judged */

/** Number of duplicates of image i > 0, up to the next image that differs; 0 if there are none or motion only pauses. */
static uint32_t copies_of(const adcgs_thumbnail *thumbnails, const uint32_t *order, uint32_t n, uint32_t i)
{
    const adcgs_thumbnail *const before = &thumbnails[order[i - 1]], *const it = &thumbnails[order[i]];
    const double change = adcgs_thumbnail_difference(before, it);
    double inside = 0.0, next = 0.0;
    uint32_t copies = 0;
    for (; i + copies + 1 < n && copies <= COPIES; copies++) {
        next = adcgs_thumbnail_difference(&thumbnails[order[i + copies]], &thumbnails[order[i + copies + 1]]);
        if (!(next <= SAME * change))
            break;
        inside = fmax(inside, next);
    }
    if (!copies || copies > COPIES || i + copies + 1 >= n || !(change > 0.0 && inside <= SAME * next))
        return 0;
    return adcgs_thumbnail_difference(before, &thumbnails[order[i + copies + 1]]) >= ONWARDS * fmax(change, next) ? copies : 0;
}

/** Number of duplicates of one camera; *first becomes the first of them. shows: as in adcgs_fault_duplicates(). */
static uint32_t count_copies(const adcgs_thumbnail *thumbnails, const uint32_t *order, uint32_t n, uint32_t *first,
                             uint32_t *shows)
{
    uint32_t count = 0, pictures = 0;
    for (uint32_t i = 1; i + 2 < n; i++) {
        const uint32_t copies = copies_of(thumbnails, order, n, i);
        *first = copies && !count ? order[i + 1] : *first;
        pictures += copies > 0;
        for (uint32_t k = 1; shows && k <= copies; k++)
            shows[order[i + k]] = order[i];
        count += copies;
        i += copies;
    }
    return pictures >= PICTURES ? count : 0;
}

void adcgs_fault_duplicates(adcgs_fault *fault, uint32_t *shows, const adcgs_scene_view *views, const adcgs_camera_order *tracks,
                            const adcgs_thumbnail *thumbnails)
{
    *fault = (adcgs_fault){.cameras = 0};
    for (uint32_t c = 0; c < tracks->n; c++) {
        const uint32_t n = tracks->begin[c + 1] - tracks->begin[c];
        uint32_t first = 0;
        if (n < FEW)
            continue;
        const uint32_t *const order = tracks->order + tracks->begin[c];
        const uint32_t count = count_copies(thumbnails, order, n, &first, NULL);
        if (count && shows)
            count_copies(thumbnails, order, n, &first, shows);
        fault->of++;
        fault->cameras += count > 0;
        fault->size += count;
        if (count > fault->count) {
            fault->count = count;
            fault->path = views[first].path;
            fault->from = fault->to = views[first].time;
        }
    }
}

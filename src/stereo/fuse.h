/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * From the depths that several views found to points: a place is kept where others found the same and few look through it.
 */
#ifndef ADCGS_STEREO_FUSE_H
#define ADCGS_STEREO_FUSE_H

#include "stereo/smooth.h"

/** A growing list of points. Zero-initialise before use. */
typedef struct adcgs_stereo_list {
    size_t n, capacity;
    adcgs_stereo_point *point;
} adcgs_stereo_list;

adcgs_status adcgs_stereo_list_add(adcgs_stereo_list *list, const adcgs_stereo_point *point, adcgs_error *error);
void adcgs_stereo_list_clear(adcgs_stereo_list *list);

/** What a view's depths say of a place. */
typedef enum adcgs_verdict {
    ADCGS_VERDICT_UNKNOWN,
    ADCGS_VERDICT_SAME,
    ADCGS_VERDICT_BEHIND, /**< the view sees through it, to something behind */
    ADCGS_VERDICT_HIDDEN  /**< the view sees something before it */
} adcgs_verdict;

/** *there: the place on the view's own ray, if it is the same. */
adcgs_verdict adcgs_depths_judge(const adcgs_depths *depths, const double x[3], double there[3]);

/**
 * Add the points of n views. wanted: for each view [picture's h][w], 1 where its pixels count; a NULL: everywhere. like: what all
 * points are but place, colour, size and detail. Depths that others do not confirm are set to ADCGS_DEPTH_NONE.
 */
adcgs_status adcgs_fuse(adcgs_stereo_list *list, adcgs_depths *depths, int n, const uint8_t *const *wanted,
                        const adcgs_stereo_point *like, adcgs_error *error);

/** The greatest difference of brightness about a pixel, 0..1. */
float adcgs_stereo_detail(const adcgs_stereo_view *view, int px, int py);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Fusion of the depths of several views into points. A point is kept if other views found it too and few views see through it.
 */
#ifndef ADCGS_INIT_FUSE_H
#define ADCGS_INIT_FUSE_H

#include "init/smooth.h"

/** A growing list of points. Zero-initialise before use. */
typedef struct adcgs_stereo_list {
    size_t n, capacity;
    adcgs_stereo_point *point;
} adcgs_stereo_list;

adcgs_status adcgs_stereo_list_add(adcgs_stereo_list *list, const adcgs_stereo_point *point, adcgs_error *error);
void adcgs_stereo_list_clear(adcgs_stereo_list *list);

/** Result of comparing a position with the depths of a view. */
typedef enum adcgs_verdict {
    ADCGS_VERDICT_UNKNOWN,
    ADCGS_VERDICT_SAME,
    ADCGS_VERDICT_BEHIND, /**< the view sees a surface behind the position */
    ADCGS_VERDICT_HIDDEN  /**< the view sees a surface in front of the position */
} adcgs_verdict;

/** *there: the position on the view's surface, set for ADCGS_VERDICT_SAME. */
adcgs_verdict adcgs_depths_judge(const adcgs_depths *depths, const double x[3], double there[3]);

/**
 * Adds the points of n views. wanted: for each view [h][w] of the image, 1 at the pixels to use; NULL: all. like: all point
 * members except position, colour, size and detail. Unconfirmed depths are set to ADCGS_DEPTH_NONE.
 */
adcgs_status adcgs_fuse(adcgs_stereo_list *list, adcgs_depths *depths, int n, const uint8_t *const *wanted,
                        const adcgs_stereo_point *like, adcgs_error *error);

/** Range of brightness in the 3x3 window of a pixel, 0..1. */
float adcgs_stereo_detail(const adcgs_stereo_view *view, int px, int py);

#endif

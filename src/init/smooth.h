/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * From costs to one depth per pixel: adjacent pixels prefer adjacent planes (semi-global matching, Hirschmueller 2008, Stereo
 * processing by semiglobal matching and mutual information, IEEE TPAMI 30), and the best depth is refined between planes.
 */
#ifndef ADCGS_INIT_SMOOTH_H
#define ADCGS_INIT_SMOOTH_H

#include "init/plane_sweep.h"

enum { ADCGS_DEPTH_NONE, ADCGS_DEPTH_WEAK, ADCGS_DEPTH_STRONG };

/** Depths of a part of a view's image. Zero-initialise before use. */
typedef struct adcgs_depths {
    const adcgs_stereo_view *view;
    int x, y, w, h;   /**< of the part */
    double step;      /**< of inverse depth, between planes */
    float *inverse;   /**< [h][w] inverse depth */
    uint8_t *quality; /**< [h][w] ADCGS_DEPTH_... */
} adcgs_depths;

/** Matches a part and chooses its depths. */
adcgs_status adcgs_depths_find(adcgs_depths *depths, const adcgs_sweep *sweep, adcgs_error *error);
void adcgs_depths_clear(adcgs_depths *depths);

#endif

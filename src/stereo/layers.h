/* SPDX-License-Identifier: BSD-2-Clause */
/** \file What moves, moment by moment, as bodies are looked for in it: in cells, with normals. */
#ifndef ADCGS_STEREO_LAYERS_H
#define ADCGS_STEREO_LAYERS_H

#include "stereo/register.h"

typedef struct adcgs_layers {
    const adcgs_stereo_rig *rig;
    int n;
    double pixel, reach;      /**< scene units: of a pixel, or more if points are sparse; ten of them are about as near */
    uint32_t begin[ADCGS_STEREO_MOMENTS + 1];
    adcgs_cloud all[ADCGS_STEREO_MOMENTS], few[ADCGS_STEREO_MOMENTS];
    adcgs_moment_views views[ADCGS_STEREO_MOMENTS];
    adcgs_stereo_point *p;    /**< [begin[n]] with colours of the softened pictures */
    float (*normal)[3];       /**< [begin[n]] */
} adcgs_layers;

/** Of the moving points; rig: softened. To be cleared in any case. */
adcgs_status adcgs_layers_init(adcgs_layers *layers, const adcgs_stereo *stereo, const adcgs_stereo_rig *rig, adcgs_error *error);
void adcgs_layers_clear(adcgs_layers *layers);

#endif

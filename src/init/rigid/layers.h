/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Moving points per frame, in grids and with normals, for the detection of rigid bodies. */
#ifndef ADCGS_INIT_RIGID_LAYERS_H
#define ADCGS_INIT_RIGID_LAYERS_H

#include "init/register.h"

typedef struct adcgs_layers {
    const adcgs_stereo_rig *rig;
    int n;
    double pixel, reach; /**< scene units: pixel size, larger if points are sparse; radius with ten points on average */
    uint32_t begin[ADCGS_MATCHING_FRAMES_MAX + 1];
    adcgs_cloud all[ADCGS_MATCHING_FRAMES_MAX], few[ADCGS_MATCHING_FRAMES_MAX];
    adcgs_frame_views views[ADCGS_MATCHING_FRAMES_MAX];
    adcgs_stereo_point *p; /**< [begin[n]] with colours of the softened images */
    float (*normal)[3];    /**< [begin[n]] */
} adcgs_layers;

/** Builds the layers of the moving points. rig: softened. The caller clears the layers, after a failure too. */
adcgs_status adcgs_layers_init(adcgs_layers *layers, const adcgs_stereo *stereo, const adcgs_stereo_rig *rig, adcgs_error *error);
void adcgs_layers_clear(adcgs_layers *layers);

#endif

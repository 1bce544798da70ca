/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Visibility of points: how many training views show a point, and in which colour. */
#ifndef ADCGS_TRAIN_DENSITY_VISIBILITY_H
#define ADCGS_TRAIN_DENSITY_VISIBILITY_H

#include "scene/scene.h"

/** Maximum number of views sampled; chosen by hand, not measured. */
enum { ADCGS_VISIBILITY_VIEWS = 64 };

typedef struct adcgs_visibility {
    const adcgs_scene *scene;
    double origin[3], scale;
    uint32_t n;                         /* views sampled */
    float *rgb[ADCGS_VISIBILITY_VIEWS]; /* their images, reduced */
    adcgs_camera camera[ADCGS_VISIBILITY_VIEWS];
} adcgs_visibility;

typedef struct adcgs_point_visibility {
    int seen;      /* views whose image contains the point */
    int covered;   /* of these, views whose pixel is not background */
    double rgb[3]; /* mean colour over the covered views */
} adcgs_point_visibility;

/** Loads reduced images of some training views. The caller clears it; after a failure there is nothing to clear. */
adcgs_status adcgs_visibility_init(adcgs_visibility *s, const adcgs_scene *scene, adcgs_error *error);
void adcgs_visibility_clear(adcgs_visibility *s);
/** Looks at a point in scene units in all of these views. */
adcgs_point_visibility adcgs_visibility_of(const adcgs_visibility *s, const double x[3]);

#endif

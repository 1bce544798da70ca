/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Visibility of points: how many training views show a point, and in which colour. */
#ifndef ADCGS_TRAIN_SIGHT_H
#define ADCGS_TRAIN_SIGHT_H

#include "data/scene.h"

/** Maximum number of views sampled. */
enum { ADCGS_SIGHTS = 64 };

typedef struct adcgs_sight {
    const adcgs_scene *scene;
    double origin[3], scale;
    uint32_t n;               /* views sampled */
    float *rgb[ADCGS_SIGHTS]; /* their images, reduced */
    adcgs_camera camera[ADCGS_SIGHTS];
} adcgs_sight;

typedef struct adcgs_glimpse {
    int seen;      /* views whose image contains the point */
    int covered;   /* of these, views whose pixel is not background */
    double rgb[3]; /* mean colour over the covered views */
} adcgs_glimpse;

/** Loads reduced images of some training views. The caller clears it; after a failure there is nothing to clear. */
adcgs_status adcgs_sight_init(adcgs_sight *s, const adcgs_scene *scene, adcgs_error *error);
void adcgs_sight_clear(adcgs_sight *s);
/** Looks at a point in scene units in all of these views. */
adcgs_glimpse adcgs_sight_observe(const adcgs_sight *s, const double x[3]);

#endif

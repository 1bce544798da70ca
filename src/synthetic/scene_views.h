/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Camera and time of each image of a scene. */
#ifndef ADCGS_SYNTHETIC_SCENE_VIEWS_H
#define ADCGS_SYNTHETIC_SCENE_VIEWS_H

#include "scene/scene.h"
#include "synthetic/table.h"

#define ADCGS_SCENES_ARC 0.39 /**< turns of the arc of training cameras; chosen by hand */

typedef struct adcgs_scenes_view {
    adcgs_trace_camera camera;
    double time;
    int number; /**< of its camera, for a training view */
} adcgs_scenes_view;

/** Number of images of a split. */
int adcgs_scenes_split_size(const adcgs_scenes_entry *scene, int split);

/** View i of a split, for images of a width. */
adcgs_scenes_view adcgs_scenes_view_at(const adcgs_scenes_entry *scene, int split, int i, int width);

/** A camera that looks at the scene's target: azimuth from -y and elevation in turns. */
void adcgs_scenes_place(adcgs_trace_camera *camera, const adcgs_scenes_entry *scene, double azimuth, double elevation, int width);

/** Exposure of a training camera, in stops; the mean over all of them is 0. */
double adcgs_scenes_stops(const adcgs_scenes_entry *scene, int camera);

#endif

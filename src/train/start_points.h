/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Where anchors begin: the scene's own points, and what matched pictures (stereo/stereo.h) say of what moves; or all that they
 * give, and random points inside the cameras' common volume where they give nothing. Only training views are looked at.
 */
#ifndef ADCGS_TRAIN_START_POINTS_H
#define ADCGS_TRAIN_START_POINTS_H

#include "stereo/stereo.h"
#include "train/config.h"

/** Fewer points say nothing of a scene. */
enum { ADCGS_POINTS_LEAST = 16 };

typedef struct adcgs_start_points {
    uint32_t n;
    double (*x)[3];   /**< scene units */
    double (*rgb)[3];
    const adcgs_stereo_point **matched; /**< what matching says of a point; NULL: another one */
} adcgs_start_points;

/**
 * Match images where that is to be done: found receives the points, and config as many anchors to start from as is good where
 * points are known, and no lifetimes where matching found nothing that moves. known: found is the result of another such call,
 * for the same scene, which is used again.
 */
adcgs_status adcgs_start_match(adcgs_stereo *found, int known, const adcgs_scene *scene, adcgs_train_config *config,
                               adcgs_pool *pool, adcgs_error *error);
/** How long, of all time, what moves by itself lives before its moment, and behind. */
float adcgs_half_life(const adcgs_train_config *config, const adcgs_stereo *found);
/** At most config->start_anchors points; found, which may be empty, has to outlive them. Clear them, whatever this returns. */
adcgs_status adcgs_start_points_find(adcgs_start_points *points, const adcgs_scene *scene, const adcgs_train_config *config,
                                     const adcgs_stereo *found, adcgs_error *error);
void adcgs_start_points_clear(adcgs_start_points *points);

#endif

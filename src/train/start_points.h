/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Initial points of anchors: the scene's points, with moving points from matching (init/stereo.h). A scene without points uses
 * all matched points, and random points in the cameras' common volume where matching found nothing. Only training views are used.
 */
#ifndef ADCGS_TRAIN_START_POINTS_H
#define ADCGS_TRAIN_START_POINTS_H

#include "init/stereo.h"
#include "train/train_config.h"

/** Minimum number of points that count as a scene's points; chosen by hand, not measured. */
enum { ADCGS_POINTS_LEAST = 16 };

typedef struct adcgs_start_points {
    uint32_t n;
    double (*x)[3]; /**< scene units */
    double (*rgb)[3];
    const adcgs_stereo_point **matched; /**< result of matching for a point; NULL: from another source */
} adcgs_start_points;

/* Flags of adcgs_start_match(); definition. */
enum {
    ADCGS_START_KNOWN = 1, /**< found is the result of an earlier call for the same scene and is used again */
    ADCGS_START_JUDGES = 2 /**< report pose errors */
};

/**
 * Matches images where needed. found receives the points. config is resolved: start_anchors by known points, lifetimes and bodies
 * by the result of matching. how: bits of ADCGS_START_*.
 */
adcgs_status adcgs_start_match(adcgs_stereo *found, unsigned how, const adcgs_scene *scene, adcgs_train_config *config,
                               adcgs_pool *pool, adcgs_error *error);
/** Half lifetime of independently moving points, 1: whole duration. */
float adcgs_half_lifetime(const adcgs_train_config *config, const adcgs_stereo *found);
/**
 * Finds at most config->start_anchors points. found, which may be empty, must outlive them. The caller clears them, after a
 * failure too.
 */
adcgs_status adcgs_start_points_find(adcgs_start_points *points, const adcgs_scene *scene, const adcgs_train_config *config,
                                     const adcgs_stereo *found, adcgs_error *error);
void adcgs_start_points_clear(adcgs_start_points *points);

#endif

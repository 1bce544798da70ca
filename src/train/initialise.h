/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The first anchors (paper section 3.2). */
#ifndef ADCGS_TRAIN_INITIALISE_H
#define ADCGS_TRAIN_INITIALISE_H

#include "data/scene.h"
#include "stereo/stereo.h"
#include "train/schedule.h"

/**
 * The first anchors, one per voxel, at the points of start_points.h; found: what matching found, or nothing. Where anchors have
 * spans, those of moving points live at their moments, and those of still ones do not move.
 */
adcgs_status adcgs_initialise(adcgs_fmodel **out, const adcgs_scene *scene, const adcgs_train_config *config,
                              const adcgs_stereo *found, adcgs_error *error);
/** Let bodies go as they were followed; those that were not stay as they are. */
void adcgs_set_poses(adcgs_fmodel *f, const adcgs_stereo *found);
/** Let an anchor live about a point's moment, for `half` of all time before it and behind, and move as the point does. */
void adcgs_set_span(adcgs_fmodel *f, uint32_t anchor, const adcgs_stereo_point *point);

#endif

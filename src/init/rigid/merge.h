/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Rebuilds a body's points from all frames with a known pose. Points of several frames at the same rest position become their
 * mean, and surfaces are smoothed (Levin 2004, Mesh-independent surface interpolation, with planes).
 */
#ifndef ADCGS_INIT_RIGID_MERGE_H
#define ADCGS_INIT_RIGID_MERGE_H

#include "init/rigid/track.h"

/** Replaces the track's model. The model is unchanged if too few points are found in two frames. */
adcgs_status adcgs_track_merge(adcgs_track *track, const adcgs_layers *layers, adcgs_error *error);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A body's points anew, from all moments at which it is known: what several moments have at the same place at rest is one point,
 * in their mean, and surfaces are smoothed (Levin 2004, Mesh-independent surface interpolation, with planes).
 */
#ifndef ADCGS_STEREO_MERGE_H
#define ADCGS_STEREO_MERGE_H

#include "stereo/track.h"

/** Replace the track's model. Without enough points that two moments have it stays as it is. */
adcgs_status adcgs_track_merge(adcgs_track *track, const adcgs_layers *layers, adcgs_error *error);

#endif

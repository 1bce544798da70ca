/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Membership of points in a tracked body. Connected points join the body; points that do not follow its motion leave it.
 */
#ifndef ADCGS_INIT_RIGID_MEMBERS_H
#define ADCGS_INIT_RIGID_MEMBERS_H

#include "init/rigid/track.h"

/** Drops points that have not followed the motion so far, then adds points connected to the body in a frame with a known pose. */
adcgs_status adcgs_members_grow(adcgs_track *track, const adcgs_layers *layers, int frame, adcgs_error *error);

/** Drops points that seldom match. */
void adcgs_members_clean(adcgs_track *track, const adcgs_layers *layers);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Which points are part of a body that is followed: what hangs together with it joins, and leaves again if it proves not to go
 * along.
 */
#ifndef ADCGS_STEREO_MEMBERS_H
#define ADCGS_STEREO_MEMBERS_H

#include "stereo/track.h"

/** Drop what did not go along so far, then add what hangs together with the body at a moment at which it is known. */
adcgs_status adcgs_members_grow(adcgs_track *track, const adcgs_layers *layers, int moment, adcgs_error *error);

/** Drop points that are seldom where they should be. */
void adcgs_members_clean(adcgs_track *track, const adcgs_layers *layers);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Whether matching found motion that lifetimes need. Anchors with a lifetime are seen in a part of the images only, so they cost
 * quality where an anchor could be trained in all of them.
 */
#ifndef ADCGS_INIT_MOTION_CHECK_H
#define ADCGS_INIT_MOTION_CHECK_H

#include "init/stereo.h"

/**
 * *moves: 1 if points move that do not lie on static surfaces. In a scene of one moving camera without bodies they also have to
 * move far, and their velocities have to predict where later frames have moving points. ADCGS_ERR_MEMORY is the only failure.
 */
adcgs_status adcgs_stereo_check_motion(int *moves, const adcgs_stereo *found, adcgs_error *error);

#endif

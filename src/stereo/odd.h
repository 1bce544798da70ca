/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Cameras whose poses cannot be right, though most are: points whose places the others know lie elsewhere in their pictures. What
 * tells them from cameras that only see little is that their pictures fit well to another pose.
 */
#ifndef ADCGS_STEREO_ODD_H
#define ADCGS_STEREO_ODD_H

#include "stereo/rig.h"
#include "stereo/smooth.h"

/**
 * depths: what is still, as the cameras of the rig that show anything found it, one after the other. Sets out->odd and
 * out->n_odd.
 */
adcgs_status adcgs_stereo_find_odd(adcgs_stereo *out, const adcgs_stereo_rig *rig, const adcgs_depths *depths, adcgs_pool *pool,
                                   adcgs_error *error);

#endif

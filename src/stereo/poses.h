/* SPDX-License-Identifier: BSD-2-Clause */
/** \file How far poses are off, by pictures alone, before anything is learnt from them. */
#ifndef ADCGS_STEREO_POSES_H
#define ADCGS_STEREO_POSES_H

#include "stereo/rig.h"

/** Each camera is compared with the two nearest that look its way. out->pixels is left as it is. */
adcgs_status adcgs_stereo_poses_off(const adcgs_stereo_rig *rig, adcgs_stereo_off *out, adcgs_pool *pool, adcgs_error *error);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The result of tracking a rigid body. */
#ifndef ADCGS_INIT_RIGID_BODY_RESULT_H
#define ADCGS_INIT_RIGID_BODY_RESULT_H

#include "init/rigid/track.h"

/**
 * Sets body `number`, from 1, of out by its track: its pivot, and its poses relative to the known one nearest to the middle of
 * time. Marks its points in out and in the layers.
 */
adcgs_status adcgs_body_write(adcgs_stereo *out, const adcgs_track *t, adcgs_layers *l, uint8_t number, adcgs_error *error);

#endif

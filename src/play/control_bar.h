/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The look of the controls. */
#ifndef ADCGS_PLAY_CONTROL_BAR_H
#define ADCGS_PLAY_CONTROL_BAR_H

#include "play/controls.h"

/** Renders the controls, with a label at the one under the pointer. */
void adcgs_control_bar_draw(adcgs_drawing *drawing, const adcgs_controls *controls, const adcgs_play_state *state);

#endif

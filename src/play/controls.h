/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The controls at the bottom of the window: their places, the one under the pointer, and the effect of a press. In the upper row
 * is the time slider. In the lower row are play and the time, on the right the stored cameras, help and full screen. All sizes
 * follow the size of text. A small window has fewer controls.
 */
#ifndef ADCGS_PLAY_CONTROLS_H
#define ADCGS_PLAY_CONTROLS_H

#include "play/drawing.h"
#include "play/play_state.h"

typedef struct adcgs_controls {
    int size;                              /**< of text */
    adcgs_rect back;                       /**< the area behind the controls; width 0: hidden */
    adcgs_rect place[ADCGS_CONTROL_COUNT]; /**< width 0: this window has no such control */
} adcgs_controls;

/** Size of text in the window: it follows the window, and is never too small for the screen. */
int adcgs_text_size(const adcgs_play_state *state);
/** Places the controls. Hidden controls have no place. */
void adcgs_controls_place(adcgs_controls *out, const adcgs_play_state *state);
/** The control at a position of the window. */
adcgs_play_control adcgs_controls_at(const adcgs_controls *controls, double x, double y);
/** The fraction of the duration that belongs to a position along the slider, 0 to 1. */
double adcgs_controls_part(const adcgs_controls *controls, double x);
/** The key with the same effect as a press of the control; 0: none. */
int adcgs_controls_key(adcgs_play_control control);

#endif

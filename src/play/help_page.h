/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The list of keys and uses of the mouse, over the window. */
#ifndef ADCGS_PLAY_HELP_PAGE_H
#define ADCGS_PLAY_HELP_PAGE_H

#include "play/drawing.h"
#include "play/play_state.h"

/** Renders it in the middle of the window, in one to three columns and the largest size that fits. */
void adcgs_help_page_draw(adcgs_drawing *drawing, const adcgs_play_state *state);

#endif

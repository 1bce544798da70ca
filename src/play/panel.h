/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Drawing on panels: rectangles and text. */
#ifndef ADCGS_PLAY_PANEL_H
#define ADCGS_PLAY_PANEL_H

#include "play/font.h"
#include "play/window.h"

/** A panel of this size, all of one colour (0xRRGGBBAA). On failure the panel has width 0 and shows nothing. */
void adcgs_panel_init(adcgs_panel *panel, int width, int height, uint32_t colour);
void adcgs_panel_free(adcgs_panel *panel);

/** Fill a rectangle, as far as it is on the panel. */
void adcgs_panel_fill(adcgs_panel *panel, int x, int y, int width, int height, uint32_t colour);
/** Lines of text from (x, y), each pixel of a letter as a square of size pixels; what does not fit is cut off. */
void adcgs_panel_text(adcgs_panel *panel, int x, int y, int size, const char *text, uint32_t colour);
/** Columns of the longest line, and lines. */
void adcgs_text_size(const char *text, int *columns, int *lines);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Panels: rectangles and text. */
#ifndef ADCGS_PLAY_PANEL_H
#define ADCGS_PLAY_PANEL_H

#include "play/font.h"
#include "play/window.h"

/** Makes a panel of this size, in one colour (0xRRGGBBAA). On failure the panel has width 0 and shows nothing. */
void adcgs_panel_init(adcgs_panel *panel, int width, int height, uint32_t colour);
void adcgs_panel_free(adcgs_panel *panel);

/** Fills a rectangle, clipped to the panel. */
void adcgs_panel_fill(adcgs_panel *panel, int x, int y, int width, int height, uint32_t colour);
/** Writes lines of text from (x, y). Each pixel of a letter is a square of size pixels. Text is clipped to the panel. */
void adcgs_panel_text(adcgs_panel *panel, int x, int y, int size, const char *text, uint32_t colour);
/** Returns the columns of the longest line, and the number of lines. */
void adcgs_text_size(const char *text, int *columns, int *lines);

#endif

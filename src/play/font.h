/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A font of our own, and how much room its letters take. */
#ifndef ADCGS_PLAY_FONT_H
#define ADCGS_PLAY_FONT_H

#include <stdint.h>

#define ADCGS_GLYPH_WIDTH 5
#define ADCGS_GLYPH_HEIGHT 9 /**< two of it below the line */
/* What a letter takes up with the space around it. */
#define ADCGS_CELL_WIDTH 6
#define ADCGS_CELL_HEIGHT 11

/** Rows of a letter, from the top, 0x10 being the leftmost pixel. What ASCII cannot print gives a question mark. */
const uint8_t *adcgs_glyph(char letter);

#endif

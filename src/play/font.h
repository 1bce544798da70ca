/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A built-in font, and the space that its letters take. */
#ifndef ADCGS_PLAY_FONT_H
#define ADCGS_PLAY_FONT_H

#include <stdint.h>

#define ADCGS_GLYPH_WIDTH 5
#define ADCGS_GLYPH_HEIGHT 9 /**< two rows lie below the line */
/* Size of a letter with the space around it. */
#define ADCGS_CELL_WIDTH 6
#define ADCGS_CELL_HEIGHT 11

/** Rows of a letter, from the top; 0x10 is the leftmost pixel. A character that ASCII cannot print gives a question mark. */
const uint8_t *adcgs_glyph(char letter);

#endif

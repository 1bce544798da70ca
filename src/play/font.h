/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A built-in font, for windows without a font library or a font, and the space that its letters take. */
#ifndef ADCGS_PLAY_FONT_H
#define ADCGS_PLAY_FONT_H

#include "play/drawing.h"

/* Pixels, by definition of the glyphs in font.c. */
#define ADCGS_GLYPH_WIDTH 5
#define ADCGS_GLYPH_HEIGHT 9 /**< two rows lie below the line */
#define ADCGS_CELL_WIDTH 6   /**< with the space between letters */

/** Rows of a letter, from the top; 0x10 is the leftmost pixel. A character that ASCII cannot print gives a question mark. */
const uint8_t *adcgs_glyph(char letter);
/** Pixels of the window per pixel of a letter, for text of this size. */
int adcgs_glyph_scale(int size);
/** Width of a line of UTF-8. */
int adcgs_glyph_width(int size, const char *text);

/** The same width, for drawings. */
extern const adcgs_type adcgs_glyph_type;

#endif

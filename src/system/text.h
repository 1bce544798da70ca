/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Output of text from others, such as names of cameras and files, to a
 * terminal, to a table, or as UTF-8.
 *
 * Streams and file systems hold bytes; invalid UTF-8 is no character.
 * Characters that a terminal, an editor or a spreadsheet might interpret
 * instead of showing are escaped: control characters (C0, DEL, C1), those that
 * change the direction of text, separators of lines and paragraphs, other
 * invisible formatting.
 */
#ifndef ADCGS_SYSTEM_TEXT_H
#define ADCGS_SYSTEM_TEXT_H

#include "base/base.h"

#include <stdio.h>

/** Length of the UTF-8 character at text, and its code point; 0 at the end and at an invalid byte. */
int adcgs_utf8_next(const char *text, uint32_t *code);

/** True if programs show a character instead of interpreting it. */
int adcgs_text_is_shown(uint32_t code);

/** The text as UTF-8, to be freed by free(); U+FFFD replaces each invalid byte. NULL on allocation failure. */
char *adcgs_text_utf8(const char *text);

/**
 * Print text for people: invalid bytes as \xHH; characters that might be interpreted as \xHH below U+0080, else as \u{H...}.
 * \return the number of characters printed.
 */
int adcgs_text_show(FILE *file, const char *text);
/** The same, padded with spaces to a column of that width. */
void adcgs_text_column(FILE *file, const char *text, int width);

/**
 * The same as a cell of a table in CSV (RFC 4180), quoted if necessary. A cell that a spreadsheet would take for a formula (it
 * starts with = + - or @) gets a leading apostrophe, which marks it as text.
 */
void adcgs_text_cell(FILE *file, const char *text);

/** The ending of a plural: "%u frame%s". */
static inline const char *adcgs_s(uint64_t n)
{
    return n == 1 ? "" : "s";
}

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Text that somebody else wrote, as names of cameras and files, on its way
 * out: to a terminal, to a table, to what has to be UTF-8.
 *
 * Streams and file systems hold bytes; what is not UTF-8 is no character. What a terminal, an editor or a spreadsheet might obey
 * rather than show is shown as an escape: control characters (C0, DEL, C1), those that change the direction of text, separators
 * of lines and paragraphs, other invisible formatting.
 */
#ifndef ADCGS_CLI_TEXT_H
#define ADCGS_CLI_TEXT_H

#include "base/base.h"

#include <stdio.h>

/** Bytes of the UTF-8 character at text and its number; 0 at the end and where there is no character. */
int adcgs_utf8_next(const char *text, uint32_t *code);

/** The text as UTF-8, free() it; U+FFFD stands for each byte that belongs to no character. NULL without memory. */
char *adcgs_text_utf8(const char *text);

/**
 * Print text for people: bytes that belong to no character as \xHH, characters that are not to be obeyed as \xHH below U+0080,
 * else as \u{H...}. \return how many characters came out.
 */
int adcgs_text_show(FILE *file, const char *text);
/** The same with as many spaces behind it as a column of that width takes. */
void adcgs_text_column(FILE *file, const char *text, int width);

/**
 * The same as a cell of a table in CSV (RFC 4180), in quotes where it needs them. What a spreadsheet would take for a formula
 * (it starts with = + - or @) gets an apostrophe before it, which spreadsheets take for "this is text".
 */
void adcgs_text_cell(FILE *file, const char *text);

/** The ending of a plural: "%u frame%s". */
static inline const char *adcgs_s(uint64_t n)
{
    return n == 1 ? "" : "s";
}

#endif

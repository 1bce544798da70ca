/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Texts and bytes in a page: nothing in them is markup, script, or the end of an element. */
#ifndef ADCGS_TOOLS_SHARE_TEXT_H
#define ADCGS_TOOLS_SHARE_TEXT_H

#include "base/base.h"

#include <stdio.h>

/** Writes text between tags or within double quotes, with ? for control characters. */
void adcgs_share_html(FILE *file, const char *text);
/** Writes text as a JSON string with its quotes, for an element of scripts or data: <, > and & are escaped. */
void adcgs_share_json(FILE *file, const char *text);
/** Writes base64, in lines of 76 letters (RFC 2045) if lines is not 0. */
void adcgs_share_base64(FILE *file, const uint8_t *data, size_t bytes, int lines);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Texts in a page: nothing in them is markup, script, or the end of an element. */
#ifndef ADCGS_APPS_SHARE_SHARE_TEXT_H
#define ADCGS_APPS_SHARE_SHARE_TEXT_H

#include "base/base.h"

#include <stdio.h>

/** Writes text between tags or within double quotes, with ? for control characters. */
void adcgs_share_html(FILE *file, const char *text);
/** Writes text as a JSON string with its quotes, for an element of scripts or data: <, > and & are escaped. */
void adcgs_share_json(FILE *file, const char *text);

#endif

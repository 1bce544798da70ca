/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Rewrites HEAD of a grown stream, which does not know its end, so that the stream becomes an ordinary one. */
#ifndef ADCGS_ENCODE_SETTLE_H
#define ADCGS_ENCODE_SETTLE_H

#include "base/base.h"

#include <stdio.h>

/**
 * Copies a complete stream from its beginning, and replaces the payload of HEAD by one of the same length, wherever HEAD lies.
 * path is for messages. ADCGS_ERR_DATA if it is no such stream.
 */
adcgs_status adcgs_encode_replace_head(FILE *to, FILE *from, const uint8_t *head, size_t bytes, const char *path,
                                       adcgs_error *error);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A stream that grew, and whose HEAD knows nothing of its end, becomes one like any other. */
#ifndef ADCGS_ENCODE_SETTLE_H
#define ADCGS_ENCODE_SETTLE_H

#include "base/base.h"

#include <stdio.h>

/**
 * Copy a complete stream from its beginning, with another payload of HEAD, of the same length, wherever HEAD stands. path is for
 * messages. ADCGS_ERR_DATA if it is no such stream.
 */
adcgs_status adcgs_encode_settle(FILE *to, FILE *from, const uint8_t *head, size_t bytes, const char *path, adcgs_error *error);

#endif

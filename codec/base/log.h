/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Messages of a decoder to its caller. */
#ifndef ADCGS_BASE_LOG_H
#define ADCGS_BASE_LOG_H

#include "base/base.h"

#include <adcgs/types.h>

typedef struct adcgs_log {
    adcgs_log_fn fn; /**< NULL: messages are dropped */
    void *user;
} adcgs_log;

/** Log one line. Control characters, which outside text may contain, become question marks. */
void adcgs_log_say(const adcgs_log *log, adcgs_log_level level, const char *format, ...) ADCGS_PRINTF(3, 4);

#endif

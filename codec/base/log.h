/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Messages of a decoder to whoever wants them. */
#ifndef ADCGS_BASE_LOG_H
#define ADCGS_BASE_LOG_H

#include "base/base.h"

#include <adcgs/types.h>

typedef struct adcgs_log {
    adcgs_log_fn fn; /**< NULL: nobody listens */
    void *user;
} adcgs_log;

/** Say one line. Control characters, which names from outside may hold, become question marks. */
void adcgs_log_say(const adcgs_log *log, adcgs_log_level level, const char *format, ...) ADCGS_PRINTF(3, 4);

#endif

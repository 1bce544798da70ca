/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Clocks. */
#define _POSIX_C_SOURCE 200809L

#include "base/base.h"

#include <time.h>

static double read_clock(clockid_t clock)
{
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

double adcgs_seconds(void)
{
    return read_clock(CLOCK_MONOTONIC);
}

adcgs_time adcgs_time_now(void)
{
    return (adcgs_time){adcgs_seconds(), read_clock(CLOCK_PROCESS_CPUTIME_ID)};
}

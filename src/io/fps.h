/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Frames per second as exact ratios: 30000/1001 is no decimal fraction, and a film's length is counted in its frames. */
#ifndef ADCGS_IO_FPS_H
#define ADCGS_IO_FPS_H

#include "base/base.h"

#define ADCGS_FPS_MIN 1e-3
#define ADCGS_FPS_MAX 1e4

/** num / den frames per second, in lowest terms; den 0: not known. */
typedef struct adcgs_fps {
    uint32_t num, den;
} adcgs_fps;

/** The value; 0 if it is not known. */
double adcgs_fps_value(adcgs_fps rate);
/**
 * The ratio that a number stands for: whole rates as N/1, the family of 1000/1001 exactly (29.97 is 30000/1001), for any other
 * number > 0 the ratio of the least terms that is it but for rounding.
 */
adcgs_fps adcgs_fps_of(double value);
/** A rate divided by a whole number from 1 to 2^31; rounded if its terms become too large. */
adcgs_fps adcgs_fps_divide(adcgs_fps rate, int64_t by);
/** "30", "29.97", "30000/1001": 0, or -1 for anything else, and for what is not from ADCGS_FPS_MIN to ADCGS_FPS_MAX. */
int adcgs_fps_parse(const char *text, adcgs_fps *rate);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Frame rates as exact ratios: 30000/1001 is no decimal fraction, and a video's
 * length is counted in frames.
 */
#ifndef ADCGS_MEDIA_VIDEO_FPS_H
#define ADCGS_MEDIA_VIDEO_FPS_H

#include "base/base.h"

/* Origin, frames per second: chosen by hand, not measured. */
#define ADCGS_FPS_MIN 1e-3 /**< lowest rate that adcgs_fps_parse() accepts */
#define ADCGS_FPS_MAX 1e4  /**< highest rate that adcgs_fps_parse() accepts */

/** num / den frames per second, in lowest terms; den 0: unknown. */
typedef struct adcgs_fps {
    uint32_t num, den;
} adcgs_fps;

/** Frames per second; 0 if unknown. */
double adcgs_fps_value(adcgs_fps rate);
/**
 * The ratio that a number represents: whole rates as N/1, the family of 1000/1001 exactly (29.97 is 30000/1001). Any other number
 * > 0 gives the ratio with the smallest terms that equals it within rounding.
 */
adcgs_fps adcgs_fps_of(double value);
/** A rate divided by a whole number from 1 to 2^31; rounded if its terms become too large. */
adcgs_fps adcgs_fps_divide(adcgs_fps rate, int64_t by);
/** Parses "30", "29.97", "30000/1001". \return 0, or -1 for other text and for rates outside ADCGS_FPS_MIN to ADCGS_FPS_MAX */
int adcgs_fps_parse(const char *text, adcgs_fps *rate);
/** The same for the value of the option --fps; ADCGS_ERR_USAGE. */
adcgs_status adcgs_fps_read_option(adcgs_fps *rate, const char *text, adcgs_error *error);

#endif

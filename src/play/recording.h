/* SPDX-License-Identifier: BSD-2-Clause */
/**
 * \file
 * A video of what the player shows. Its frames have all of the resolution and all tiers, and each is a step of 1 / frame rate
 * after the one before: while one is being recorded, time goes by frames, never faster than the clock on the wall.
 */
#ifndef ADCGS_PLAY_RECORDING_H
#define ADCGS_PLAY_RECORDING_H

#include "io/sink.h"

#include <limits.h>

typedef struct adcgs_recording {
    adcgs_sink *sink;     /**< NULL: none is being made */
    char path[PATH_MAX];  /**< of the last one; set before it begins: wanted so */
    int width, height;    /**< of its frames */
    long frames;          /**< that it has */
    double step;          /**< seconds from one to the next */
    double base;          /**< the player's clock at the first */
    double due;           /**< the wall's at which the next may be drawn */
    double behind;        /**< how far the player's clock is behind the wall's */
    adcgs_status status;  /**< of the last one */
    adcgs_error error;
} adcgs_recording;

/** The player's clock: that on the wall, less what recording took longer. */
double adcgs_recording_now(const adcgs_recording *recording);
/** Whether the next frame may be drawn. */
int adcgs_recording_due(const adcgs_recording *recording);

/** Begin one, as MP4 or where that cannot be written as Y4M, named after the stream unless a name was set. */
adcgs_status adcgs_recording_begin(adcgs_recording *recording, const char *stream, int width, int height, double frame_rate);
/** A frame is being drawn for it. */
void adcgs_recording_posted(adcgs_recording *recording);
/** Complete the video. Harmless when none is being made. */
adcgs_status adcgs_recording_end(adcgs_recording *recording);
/** A frame could not be written: give up. */
void adcgs_recording_fail(adcgs_recording *recording, const adcgs_error *error);

#endif

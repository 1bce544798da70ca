/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A video of the player's images. Its frames have the full resolution and all tiers, and each is 1 / frame rate after the
 * previous one. During a recording, time follows the frames, and is never faster than the wall clock.
 */
#ifndef ADCGS_PLAY_RECORDING_H
#define ADCGS_PLAY_RECORDING_H

#include "media/sink.h"

#include <limits.h>

typedef struct adcgs_recording {
    adcgs_sink *sink;    /**< NULL: no recording */
    char path[PATH_MAX]; /**< of the last recording; the requested name if set before it begins */
    int width, height;   /**< of its frames */
    long frames;         /**< frames so far */
    double step;         /**< seconds between frames */
    double base;         /**< the player's clock at the first */
    double due;          /**< wall clock at which the next frame may be rendered */
    double behind;       /**< delay of the player's clock against the wall clock */
    adcgs_status status; /**< of the last recording */
    adcgs_error error;
} adcgs_recording;

/** The player's clock: the wall clock, less the delays of recordings. */
double adcgs_recording_now(const adcgs_recording *recording);
/** True if the next frame may be rendered. */
int adcgs_recording_due(const adcgs_recording *recording);

/** Begins a recording, as MP4, or as Y4M if that cannot be written. It is named after the stream unless a name was set. */
adcgs_status adcgs_recording_begin(adcgs_recording *recording, const char *stream, int width, int height, double frame_rate);
/** Notes that a frame is being rendered for the recording. */
void adcgs_recording_posted(adcgs_recording *recording);
/** Completes the video. No effect without a recording. */
adcgs_status adcgs_recording_end(adcgs_recording *recording);
/** Ends the recording after a frame could not be written. */
void adcgs_recording_fail(adcgs_recording *recording, const adcgs_error *error);

#endif

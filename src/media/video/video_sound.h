/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A sound file whose packets go into a video unchanged. */
#ifndef ADCGS_MEDIA_VIDEO_VIDEO_SOUND_H
#define ADCGS_MEDIA_VIDEO_VIDEO_SOUND_H

#include "media/video/video_input.h"

typedef struct adcgs_video_sound {
    adcgs_video_input input; /**< without a decoder */
    AVFormatContext *output;
    AVStream *stream; /**< of the output */
    AVPacket *packet;
    double start; /**< position in the file at the video's first frame, seconds */
    int pending;  /**< the packet waits for its time */
} adcgs_video_sound;

/**
 * Opens a file (Ogg, WebM, MP4, MP3, FLAC, WAV), and adds a stream to an output whose header is not written yet. target: its
 * path, for messages. ADCGS_ERR_UNSUPPORTED if the container stores no such sound. Call adcgs_video_sound_close() after failure,
 * too.
 */
adcgs_status adcgs_video_sound_open(adcgs_video_sound *sound, const char *path, double start, AVFormatContext *output,
                                    const char *target, adcgs_error *error);
void adcgs_video_sound_close(adcgs_video_sound *sound);
/** Writes the packets that begin before a time of the video, seconds. Returns a code of FFmpeg. */
int adcgs_video_sound_write(adcgs_video_sound *sound, double until);

#endif

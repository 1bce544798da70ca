/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The packets of a video in decoding order, and its frames in presentation order. */
#ifndef ADCGS_MEDIA_VIDEO_VIDEO_INDEX_H
#define ADCGS_MEDIA_VIDEO_VIDEO_INDEX_H

#include "media/video/video_input.h"

typedef struct adcgs_video_packet {
    int64_t pts; /**< presentation timestamp */
    uint8_t key; /**< decoding can begin here */
    uint8_t bad; /**< it cannot be decoded */
} adcgs_video_packet;

typedef struct adcgs_video_index {
    int timed;                  /**< each packet is one frame with its own timestamp; else only the number of frames is known */
    int64_t duration;           /**< the shortest duration of a packet; 0: no packet has one */
    int64_t frames;             /**< including frames that the file lists but does not contain */
    uint32_t n;                 /**< packets */
    uint32_t sure;              /**< number of frames with a certain index: in a truncated file, those before the first gap;
                                     timed only */
    adcgs_video_packet *packet; /**< [n] in decoding order; timed only */
    uint32_t *shown;            /**< [n] packet of each frame; timed only */
} adcgs_video_index;

/**
 * Read all packets of the input, which is left at its end. Without timestamps, or if packets may not be frames, decodes all
 * packets and counts the frames. ADCGS_ERR_DATA if there is no frame.
 */
adcgs_status adcgs_video_index_make(adcgs_video_index *index, adcgs_video_input *input, adcgs_error *error);
void adcgs_video_index_clear(adcgs_video_index *index);
/** The frame with a timestamp, or -1; timed only. */
int64_t adcgs_video_index_find(const adcgs_video_index *index, int64_t pts);
/** The last packet where decoding can begin so that a frame is decoded intact; timed only. */
uint32_t adcgs_video_index_key(const adcgs_video_index *index, int64_t frame);
/** The first bad packet among those that a frame may depend on; -1 if none is known; timed only. */
int64_t adcgs_video_index_bad(const adcgs_video_index *index, int64_t frame);

/** True if FFmpeg reported an error in a decoded frame. */
int adcgs_video_frame_bad(const AVFrame *frame);

#endif

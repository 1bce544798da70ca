/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The packets of a video in the order in which they are decoded, and the frames
 * they hold in the order in which they are shown.
 */
#ifndef ADCGS_IO_VIDEO_INDEX_H
#define ADCGS_IO_VIDEO_INDEX_H

#include "io/video_input.h"

typedef struct adcgs_video_packet {
    int64_t pts;   /**< when it is shown */
    uint8_t key;   /**< decoding can begin here */
    uint8_t bad;   /**< it cannot be decoded */
} adcgs_video_packet;

typedef struct adcgs_video_index {
    int timed;                  /**< each packet is one frame with a time of its own; else nothing but frames is known */
    int64_t duration;           /**< the shortest that a packet tells; 0: none does */
    int64_t frames;             /**< with those that the file lists and does not hold */
    uint32_t n;                 /**< packets */
    uint32_t sure;              /**< frames whose index is certain: of a file cut off, those before the first gap; timed only */
    adcgs_video_packet *packet; /**< [n] as decoded; timed only */
    uint32_t *shown;            /**< [n] packet of each frame; timed only */
} adcgs_video_index;

/**
 * Read all packets of the input, which is left at its end. Where they have no times, or where packets may not be frames, all is
 * decoded and counted. ADCGS_ERR_DATA if there is no frame.
 */
adcgs_status adcgs_video_index_make(adcgs_video_index *index, adcgs_video_input *input, adcgs_error *error);
void adcgs_video_index_clear(adcgs_video_index *index);
/** The frame shown at a time, or -1; timed only. */
int64_t adcgs_video_index_find(const adcgs_video_index *index, int64_t pts);
/** The packet where decoding must begin at the latest to get a frame whole; timed only. */
uint32_t adcgs_video_index_key(const adcgs_video_index *index, int64_t frame);
/** The first packet that is bad among those that a frame may be made of; -1 if none is known to be; timed only. */
int64_t adcgs_video_index_bad(const adcgs_video_index *index, int64_t frame);

/** Whether FFmpeg found fault with a decoded frame. */
int adcgs_video_frame_bad(const AVFrame *frame);

#endif

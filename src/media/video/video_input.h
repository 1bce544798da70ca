/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A video file opened by FFmpeg: one stream of packets and its decoder. FFmpeg
 * reads from our file alone: formats that refer to other files or addresses
 * (playlists, lists to concatenate) are disabled.
 */
#ifndef ADCGS_MEDIA_VIDEO_VIDEO_INPUT_H
#define ADCGS_MEDIA_VIDEO_VIDEO_INPUT_H

#include "media/image/image.h"

#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>

typedef struct adcgs_video_input {
    int fd;           /**< the caller's */
    const char *path; /**< for messages */
    AVIOContext *io;
    AVFormatContext *format;
    AVStream *stream; /**< the one to decode; others are ignored */
    AVCodecContext *codec;
} adcgs_video_input;

/**
 * Opens the container alone, of one of these formats of FFmpeg, at the file's beginning, and describes its streams. kind: "a
 * video", for messages. input->fd and path must be set. Call adcgs_video_input_close() after failure, too.
 */
adcgs_status adcgs_video_input_attach(adcgs_video_input *input, const char *formats, const char *kind, adcgs_error *error);
/** Open from the file's beginning. input->fd and path must be set. Call adcgs_video_input_close() after failure, too. */
adcgs_status adcgs_video_input_open(adcgs_video_input *input, adcgs_error *error);
void adcgs_video_input_close(adcgs_video_input *input);
/** The stream's next packet; AVERROR_EOF at the end, or another negative code of FFmpeg's. Empty packets are skipped. */
int adcgs_video_input_next(adcgs_video_input *input, AVPacket *packet);
/** True if the file is shorter than its header declares (Matroska, WebM, AVI). Truncation of others is detected while reading. */
int adcgs_video_input_cut(const adcgs_video_input *input);
/** The matrix that turns the image, nine numbers as in ISO 14496-12; NULL if there is none. */
const int32_t *adcgs_video_input_matrix(const adcgs_video_input *input);
/** FFmpeg's name of a panorama's projection; NULL for an ordinary lens. */
const char *adcgs_video_input_projection(const adcgs_video_input *input);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The packets and frames of a video. */
#include "config.h"

#include "media/video/video_index.h"

#include <math.h>
#include <stdlib.h>

#define FRAMES_MAX (1u << 24) /* three days at 60 frames per second; chosen by hand, not measured */

/** True for codecs with exactly one frame per packet. Others have hidden frames, or join several. */
static int is_frame_each(enum AVCodecID codec)
{
    const AVCodecDescriptor *descriptor = avcodec_descriptor_get(codec);
    return codec == AV_CODEC_ID_H264 || codec == AV_CODEC_ID_HEVC || codec == AV_CODEC_ID_VP9 || codec == AV_CODEC_ID_AV1 ||
           codec == AV_CODEC_ID_MPEG4 || (descriptor && (descriptor->props & AV_CODEC_PROP_INTRA_ONLY));
}

int adcgs_video_frame_bad(const AVFrame *frame)
{
    return frame->decode_error_flags || (frame->flags & AV_FRAME_FLAG_CORRUPT);
}

/* ---- Packets ---- */

static adcgs_status append(adcgs_video_index *index, uint32_t *room, const AVPacket *packet, const char *path, adcgs_error *error)
{
    if (index->n == FRAMES_MAX)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: more than %u frames", path, FRAMES_MAX);
    if (index->n == *room) {
        *room = *room ? 2 * *room : 256;
        adcgs_video_packet *grown = realloc(index->packet, *room * sizeof *grown);
        if (!grown)
            return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for the list of frames", path);
        index->packet = grown;
    }
    if (packet->duration > 0 && (!index->duration || packet->duration < index->duration))
        index->duration = packet->duration;
    index->packet[index->n++] = (adcgs_video_packet){.pts = packet->pts,
                                                     .key = (packet->flags & AV_PKT_FLAG_KEY) != 0,
                                                     .bad = (packet->flags & AV_PKT_FLAG_CORRUPT) != 0};
    return ADCGS_OK;
}

/**
 * Number of packets that the container lists in addition to those read, which means a truncated file. Only complete lists count.
 */
static int64_t missing_packets(const adcgs_video_input *input, int64_t read, int failed)
{
#if LIBAVFORMAT_VERSION_MAJOR < 59
    const int64_t listed = input->stream->nb_index_entries;
#else
    const int64_t listed = avformat_index_get_entries_count(input->stream);
#endif
    return listed > read ? listed - read : failed;
}

static adcgs_status read_packets(adcgs_video_index *index, adcgs_video_input *input, AVPacket *packet, adcgs_error *error)
{
    uint32_t room = 0;
    int64_t left_out = 0;
    adcgs_status status = ADCGS_OK;
    int code = 0;
    while (status == ADCGS_OK && (code = adcgs_video_input_next(input, packet)) >= 0) {
        if (packet->flags & AV_PKT_FLAG_DISCARD) /* decoded, but not shown */
            left_out++;
        else
            status = append(index, &room, packet, input->path, error);
        av_packet_unref(packet);
    }
    const int cut = code != AVERROR_EOF || input->io->error < 0 || adcgs_video_input_cut(input);
    index->frames = index->n + missing_packets(input, index->n + left_out, cut);
    return status;
}

/* ---- Order ---- */

typedef struct timed {
    int64_t pts;
    uint32_t packet;
} timed;

static int shown_earlier(const void *a, const void *b)
{
    const int64_t x = ((const timed *)a)->pts, y = ((const timed *)b)->pts;
    return (x > y) - (x < y);
}

/** Fill index->shown; index->timed stays 0 if timestamps are missing or not distinct. */
static adcgs_status sort_frames(adcgs_video_index *index, const char *path, adcgs_error *error)
{
    timed *all = malloc(index->n * sizeof *all);
    index->shown = malloc(index->n * sizeof *index->shown);
    if (!all || !index->shown) {
        free(all);
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for the list of frames", path);
    }
    for (uint32_t i = 0; i < index->n; i++)
        all[i] = (timed){index->packet[i].pts, i};
    qsort(all, index->n, sizeof *all, shown_earlier);
    index->timed = all[0].pts != AV_NOPTS_VALUE; /* AV_NOPTS_VALUE is the smallest int64_t */
    for (uint32_t i = 0; i < index->n; i++) {
        index->shown[i] = all[i].packet;
        if (i && all[i].pts == all[i - 1].pts)
            index->timed = 0;
    }
    free(all);
    return ADCGS_OK;
}

/** Time since the previous frame; double, since timestamps from a file may have any value. */
static double distance(const adcgs_video_index *index, uint32_t frame)
{
    return (double)index->packet[index->shown[frame]].pts - (double)index->packet[index->shown[frame - 1]].pts;
}

/**
 * Number of frames before the first gap of more than one and a half times the usual distance. In a truncated file, the gap may be
 * a frame that is shown earlier but stored later. Two frames alone give no usual distance.
 */
static uint32_t count_sure(const adcgs_video_index *index)
{
    double least = index->duration ? (double)index->duration : index->n > 2 ? INFINITY : 0.0;
    for (uint32_t i = 1; i < index->n; i++)
        least = fmin(least, distance(index, i));
    for (uint32_t i = 1; i < index->n; i++)
        if (distance(index, i) > 1.5 * least)
            return i;
    return index->n;
}

int64_t adcgs_video_index_find(const adcgs_video_index *index, int64_t pts)
{
    uint32_t from = 0, to = index->n;
    while (from < to) {
        const uint32_t middle = from + (to - from) / 2;
        if (index->packet[index->shown[middle]].pts < pts)
            from = middle + 1;
        else
            to = middle;
    }
    return from < index->n && index->packet[index->shown[from]].pts == pts ? (int64_t)from : -1;
}

/*
 * A key frame shown after the frame is not suitable: frames decoded after it but shown before it may depend on earlier packets.
 */
uint32_t adcgs_video_index_key(const adcgs_video_index *index, int64_t frame)
{
    uint32_t i = index->shown[frame];
    const int64_t pts = index->packet[i].pts;
    while (i && !(index->packet[i].key && index->packet[i].pts <= pts))
        i--;
    return i;
}

int64_t adcgs_video_index_bad(const adcgs_video_index *index, int64_t frame)
{
    const uint32_t end = index->shown[frame];
    for (uint32_t i = adcgs_video_index_key(index, frame); i <= end; i++)
        if (index->packet[i].bad)
            return i;
    return -1;
}

/* ---- Counting by decoding ---- */

/** Take all frames that the decoder has ready. \return their number, or -1 at a damaged one */
static int64_t take_frames(adcgs_video_input *input, AVFrame *frame)
{
    int64_t n = 0;
    for (;;) {
        const int code = avcodec_receive_frame(input->codec, frame);
        if (code == AVERROR(EAGAIN) || code == AVERROR_EOF)
            return n;
        const int bad = code < 0 || adcgs_video_frame_bad(frame);
        av_frame_unref(frame);
        if (bad)
            return -1;
        n++;
    }
}

/** Number of frames up to the first damaged one, which is included. The input must be at its beginning. */
static int64_t count_frames(adcgs_video_input *input, AVPacket *packet, AVFrame *frame)
{
    int64_t n = 0;
    for (int end = 0; !end && n < FRAMES_MAX;) {
        const int code = adcgs_video_input_next(input, packet);
        end = code < 0;
        const int sent = avcodec_send_packet(input->codec, end ? NULL : packet);
        if (!end)
            av_packet_unref(packet);
        const int64_t more = take_frames(input, frame);
        if (sent < 0 || more < 0 || (end && code != AVERROR_EOF))
            return n + ADCGS_MAX(more, 0) + 1;
        n += more;
    }
    return n;
}

static adcgs_status count(adcgs_video_index *index, adcgs_video_input *input, AVPacket *packet, adcgs_error *error)
{
    AVFrame *frame = av_frame_alloc();
    if (!frame)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", input->path);
    adcgs_video_input_close(input);
    const adcgs_status status = adcgs_video_input_open(input, error);
    if (status == ADCGS_OK)
        index->frames = count_frames(input, packet, frame);
    av_frame_free(&frame);
    return status;
}

adcgs_status adcgs_video_index_make(adcgs_video_index *index, adcgs_video_input *input, adcgs_error *error)
{
    AVPacket *packet = av_packet_alloc();
    if (!packet)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", input->path);
    adcgs_status status = read_packets(index, input, packet, error);
    if (status == ADCGS_OK && !index->n)
        status = adcgs_fail(error, ADCGS_ERR_DATA, "%s: no frame in it, or the file is cut off before the first", input->path);
    if (status == ADCGS_OK)
        status = sort_frames(index, input->path, error);
    if (status == ADCGS_OK && !is_frame_each(input->stream->codecpar->codec_id))
        index->timed = 0;
    index->sure = status == ADCGS_OK && index->timed && index->frames > index->n ? count_sure(index) : index->n;
    if (status == ADCGS_OK && !index->timed)
        status = count(index, input, packet, error);
    av_packet_free(&packet);
    return status;
}

void adcgs_video_index_clear(adcgs_video_index *index)
{
    free(index->packet);
    free(index->shown);
    *index = (adcgs_video_index){0};
}

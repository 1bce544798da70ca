/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Frames of a video by their index. Reading ahead is cheap; going back, or far
 * ahead, restarts decoding at a key frame. Decoded frames are identified by
 * their timestamps.
 */
#include "config.h"

#include "media/video/video_ffmpeg.h"
#include "media/video/video_index.h"
#include "media/video/video_picture.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define AHEAD 8         /* key frames at most this many packets ahead are reached by decoding, not by seeking */
#define DEFAULT_RATE 25 /* frames per second of a file without a rate */

struct adcgs_video_reader {
    adcgs_video_input input;
    adcgs_video_index index;
    char *path, *name; /* name: of a frame, for messages */
    size_t name_size;
    int width, height; /* of the first frame, as shown; 0 before it */
    AVPacket *packet;
    AVFrame *frame; /* the last decoded frame */
    int64_t last;   /* its index; -1: none */
    int64_t place;  /* number of the last packet sent to the decoder, -1 before the first */
    int64_t begun;  /* number of the key packet where decoding began, -1 for the file's beginning */
    int known;      /* decoding can continue from here */
    int pending;    /* the packet has been read, but not decoded */
    int at_end;     /* all packets have been read */
    int code;       /* FFmpeg's code of the last fault */
};

/* ---- Place ---- */

/** Reopen at the file's beginning, in a state without any previous seek. */
static adcgs_status rewind_input(adcgs_video_reader *r, adcgs_error *error)
{
    av_packet_unref(r->packet);
    av_frame_unref(r->frame);
    adcgs_video_input_close(&r->input);
    r->last = r->place = r->begun = -1;
    r->known = r->pending = r->at_end = r->code = 0;
    ADCGS_TRY(adcgs_video_input_open(&r->input, error));
    r->known = 1;
    return ADCGS_OK;
}

static void read_packet(adcgs_video_reader *r)
{
    av_packet_unref(r->packet);
    r->at_end = adcgs_video_input_next(&r->input, r->packet) < 0;
    r->pending = !r->at_end;
}

/** Number of the current packet; -1 if it is not shown, or the index is not timed. */
static int64_t packet_number(const adcgs_video_reader *r)
{
    const int64_t frame = r->index.timed ? adcgs_video_index_find(&r->index, r->packet->pts) : -1;
    return frame < 0 ? -1 : (int64_t)r->index.shown[frame];
}

/** Seek to a key packet, or to an earlier one, which is the current packet then. \return 0 if the container cannot seek there */
static int seek(adcgs_video_reader *r, uint32_t key)
{
    av_frame_unref(r->frame);
    avcodec_flush_buffers(r->input.codec);
    r->last = -1;
    r->known = 0;
    if (av_seek_frame(r->input.format, r->input.stream->index, r->index.packet[key].pts, AVSEEK_FLAG_BACKWARD) < 0)
        return 0;
    for (;;) {
        read_packet(r);
        const int64_t number = r->at_end ? -1 : packet_number(r);
        if (r->at_end || number > (int64_t)key)
            return 0;
        if (number >= 0 && r->index.packet[number].key) {
            r->place = number - 1;
            r->begun = number;
            r->known = 1;
            return 1;
        }
    }
}

/* ---- Decoding ---- */

/** Decode up to the next frame. \return 0, AVERROR_EOF, or a fault of the packet at r->place. */
static int decode(adcgs_video_reader *r)
{
    for (;;) {
        av_frame_unref(r->frame);
        int code = avcodec_receive_frame(r->input.codec, r->frame);
        if (code != AVERROR(EAGAIN))
            return code;
        if (!r->pending)
            read_packet(r);
        const int64_t number = r->at_end ? -1 : packet_number(r);
        r->place = number >= 0 ? number : r->place;
        r->pending = 0;
        code = avcodec_send_packet(r->input.codec, r->at_end ? NULL : r->packet);
        if (code < 0)
            return code;
    }
}

/**
 * Record a fault in a packet. If decoding began at a key frame, the packet is not marked as bad. It may belong to a frame shown
 * before that key frame, or the key frame may need earlier packets. \return true to stop the search for the frame
 */
static int take_fault(adcgs_video_reader *r, int64_t packet, int code, int64_t frame)
{
    r->code = code;
    if (packet < 0)
        return 1;
    if (r->begun >= 0)
        return r->index.packet[packet].pts >= r->index.packet[r->begun].pts;
    r->index.packet[packet].bad = 1;
    return adcgs_video_index_bad(&r->index, frame) >= 0;
}

/** Decode up to the frame. \return true if it was decoded intact */
static int find_timed(adcgs_video_reader *r, int64_t frame)
{
    for (;;) {
        const int code = decode(r);
        if (code == AVERROR_EOF || (code < 0 && r->at_end))
            return 0;
        if (code < 0) {
            if (take_fault(r, r->place, code, frame))
                return 0;
            continue;
        }
        const int64_t pts = r->frame->pts != AV_NOPTS_VALUE ? r->frame->pts : r->frame->best_effort_timestamp;
        const int64_t found = adcgs_video_index_find(&r->index, pts);
        if (found < 0 || (r->begun >= 0 && pts < r->index.packet[r->begun].pts))
            continue;
        if (adcgs_video_frame_bad(r->frame) && take_fault(r, r->index.shown[found], AVERROR_INVALIDDATA, frame))
            return 0;
        r->last = found;
        if (found >= frame)
            return found == frame;
    }
}

static int find_counted(adcgs_video_reader *r, int64_t frame)
{
    while (r->last < frame) {
        r->code = decode(r);
        if (r->code < 0 || adcgs_video_frame_bad(r->frame))
            return 0;
        r->last++;
    }
    return 1;
}

static adcgs_status fail_frame(adcgs_video_reader *r, adcgs_error *error)
{
    r->known = 0;
    r->last = -1;
    if (r->code == AVERROR(ENOMEM))
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", r->name);
    if (r->code == AVERROR(ENOSYS) || r->code == AVERROR_PATCHWELCOME)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: this build of FFmpeg cannot decode this kind of %s", r->name,
                          avcodec_get_name(r->input.stream->codecpar->codec_id));
    return adcgs_fail(error, ADCGS_ERR_DATA, "%s: damaged, or predicted from a damaged frame", r->name);
}

/** Decode the frame into r->frame. */
static adcgs_status go_timed(adcgs_video_reader *r, int64_t frame, adcgs_error *error)
{
    if (frame >= r->index.sure)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: missing: the file ends early", r->name);
    if (adcgs_video_index_bad(&r->index, frame) >= 0)
        return fail_frame(r, error);
    const uint32_t key = adcgs_video_index_key(&r->index, frame);
    const int near = r->known && r->last < frame && (int64_t)key <= r->place + AHEAD;
    if (!near && (!key || !seek(r, key)))
        ADCGS_TRY(rewind_input(r, error));
    if (find_timed(r, frame))
        return ADCGS_OK;
    if (r->begun < 0)
        return fail_frame(r, error);
    ADCGS_TRY(rewind_input(r, error));
    return find_timed(r, frame) ? ADCGS_OK : fail_frame(r, error);
}

static adcgs_status go_counted(adcgs_video_reader *r, int64_t frame, adcgs_error *error)
{
    if (!r->known || frame < r->last)
        ADCGS_TRY(rewind_input(r, error));
    return find_counted(r, frame) ? ADCGS_OK : fail_frame(r, error);
}

adcgs_status adcgs_video_reader_read(adcgs_video_reader *r, int64_t frame, adcgs_image *out, adcgs_error *error)
{
    *out = (adcgs_image){0};
    snprintf(r->name, r->name_size, "%s: frame %lld", r->path, (long long)frame);
    if (frame < 0 || frame >= r->index.frames)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: does not exist, the last is %lld", r->name, (long long)r->index.frames - 1);
    if (frame != r->last || !r->known)
        ADCGS_TRY(r->index.timed ? go_timed(r, frame, error) : go_counted(r, frame, error));
    const adcgs_video_view view = {.aspect = av_guess_sample_aspect_ratio(r->input.format, r->input.stream, r->frame),
                                   .matrix = adcgs_video_input_matrix(&r->input)};
    ADCGS_TRY(adcgs_video_picture(out, r->frame, &view, r->name, error));
    if (!r->width || (out->width == r->width && out->height == r->height))
        return ADCGS_OK;
    const int width = out->width, height = out->height;
    adcgs_image_free(out);
    return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %dx%d pixels, expected %dx%d as in the first", r->name, width, height, r->width,
                      r->height);
}

double adcgs_video_reader_time(const adcgs_video_reader *r, int64_t frame)
{
    if (!r->index.timed || frame < 0 || frame >= r->index.n)
        return NAN;
    const double first = (double)r->index.packet[r->index.shown[0]].pts, at = (double)r->index.packet[r->index.shown[frame]].pts;
    return (at - first) * av_q2d(r->input.stream->time_base);
}

/* ---- Opening ---- */

static adcgs_fps mean_rate(const adcgs_video_reader *r)
{
    static const adcgs_fps unknown = {DEFAULT_RATE, 1};
    const AVRational mean = r->input.stream->avg_frame_rate, tick = r->input.stream->time_base;
    const adcgs_video_index *index = &r->index;
    int num, den;
    if (mean.num > 0 && mean.den > 0) {
        av_reduce(&num, &den, mean.num, mean.den, INT_MAX);
        return (adcgs_fps){(uint32_t)num, (uint32_t)den};
    }
    if (!index->timed || index->n < 2 || tick.num <= 0 || tick.den <= 0)
        return unknown;
    const int64_t first = index->packet[index->shown[0]].pts, last = index->packet[index->shown[index->n - 1]].pts;
    const double ticks = (double)last - (double)first, intervals = (double)index->n - 1;
    if (!(ticks >= 1 && ticks * tick.num < 0x1p62 && intervals * tick.den < 0x1p62))
        return unknown;
    av_reduce(&num, &den, ((int64_t)index->n - 1) * tick.den, (last - first) * tick.num, INT_MAX);
    return num > 0 && den > 0 ? (adcgs_fps){(uint32_t)num, (uint32_t)den} : unknown;
}

static void describe(const adcgs_video_reader *r, adcgs_fps rate, adcgs_video_info *info)
{
    const AVFormatContext *const format = r->input.format;
    *info = (adcgs_video_info){.width = r->width,
                               .height = r->height,
                               .frames = r->index.frames,
                               .rate = rate,
                               .hdr = adcgs_hdr_name(adcgs_video_hdr(r->frame)),
                               .round = adcgs_video_input_projection(&r->input)};
    for (unsigned i = 0; i < format->nb_streams; i++)
        info->has_sound |= format->streams[i]->codecpar->codec_type == AVMEDIA_TYPE_AUDIO;
    if (r->index.timed)
        info->start = (double)r->index.packet[r->index.shown[0]].pts * av_q2d(r->input.stream->time_base);
}

static adcgs_status open_file(adcgs_video_reader *r, adcgs_error *error)
{
    struct stat status;
    r->input.path = r->path;
    r->input.fd = open(r->path, O_RDONLY | O_CLOEXEC | O_NONBLOCK); /* opening a pipe without a writer must not block */
    if (r->input.fd < 0 || fstat(r->input.fd, &status))
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot open: %s", r->path, strerror(errno));
    if (!S_ISREG(status.st_mode))
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: not a regular file, as a video must be", r->path);
    return status.st_size ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_DATA, "%s: empty, expected a video", r->path);
}

/** List the frames, then decode the first: its size is the video's. */
static adcgs_status open_reader(adcgs_video_reader *r, adcgs_video_info *info, adcgs_error *error)
{
    adcgs_image first;
    ADCGS_TRY(open_file(r, error));
    ADCGS_TRY(adcgs_video_input_open(&r->input, error));
    ADCGS_TRY(adcgs_video_index_make(&r->index, &r->input, error));
    const adcgs_fps rate = mean_rate(r);
    ADCGS_TRY(rewind_input(r, error));
    ADCGS_TRY(adcgs_video_reader_read(r, 0, &first, error));
    r->width = first.width;
    r->height = first.height;
    adcgs_image_free(&first);
    describe(r, rate, info);
    return ADCGS_OK;
}

adcgs_status adcgs_video_reader_open(adcgs_video_reader **out, adcgs_video_info *info, const char *path, adcgs_error *error)
{
    *out = NULL;
    av_log_set_level(AV_LOG_QUIET); /* our own messages report FFmpeg's errors */
    adcgs_video_reader *r = calloc(1, sizeof *r);
    if (!r)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    r->input.fd = -1;
    r->name_size = strlen(path) + 40;
    r->path = strdup(path);
    r->name = malloc(r->name_size);
    r->packet = av_packet_alloc();
    r->frame = av_frame_alloc();
    const adcgs_status status = r->path && r->name && r->packet && r->frame
                                    ? open_reader(r, info, error)
                                    : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    if (status != ADCGS_OK)
        adcgs_video_reader_close(&r);
    *out = r;
    return status;
}

void adcgs_video_reader_close(adcgs_video_reader **reader)
{
    adcgs_video_reader *r = *reader;
    if (!r)
        return;
    av_packet_free(&r->packet);
    av_frame_free(&r->frame);
    adcgs_video_input_close(&r->input);
    adcgs_video_index_clear(&r->index);
    if (r->input.fd >= 0)
        close(r->input.fd);
    free(r->path);
    free(r->name);
    free(r);
    *reader = NULL;
}

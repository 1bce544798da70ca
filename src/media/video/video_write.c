/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Writing videos. The same frames give the same bytes, except with a codec
 * chosen by the user.
 */
#include "config.h"

#include "media/video/video_codec.h"
#include "media/video/video_planes.h"
#include "media/video/video_sound.h"
#include "system/extension.h"

#include <errno.h>
#include <libavformat/avformat.h>
#include <libavutil/pixdesc.h>
#include <stdlib.h>
#include <strings.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define IO_BYTES 65536     /* of the buffer for FFmpeg */
#define THREADS 4          /* fixed, since the encoders' output depends on it */
#define KEY_SECONDS 2      /* between key frames, at most KEY_FRAMES_MAX frames */
#define KEY_FRAMES_MAX 250 /* frames from one key frame to the next */

struct adcgs_video_encoder {
    adcgs_video_target target;
    AVIOContext *io;
    AVFormatContext *format;
    AVCodecContext *codec;
    AVStream *stream;
    AVFrame *frame;
    AVPacket *packet;
    adcgs_video_sound sound; /* open if its output is set */
    int64_t frames;
    int reason; /* errno of the first write that failed */
};

/* ---- The file ---- */

#if LIBAVFORMAT_VERSION_MAJOR < 61
static int write_bytes(void *opaque, uint8_t *buffer, int size)
#else
static int write_bytes(void *opaque, const uint8_t *buffer, int size)
#endif
{
    adcgs_video_encoder *e = opaque;
    errno = 0;
    if (fwrite(buffer, 1, (size_t)size, e->target.file) == (size_t)size)
        return size;
    e->reason = e->reason ? e->reason : errno ? errno : EIO;
    return AVERROR(e->reason);
}

static int64_t seek_bytes(void *opaque, int64_t offset, int whence)
{
    adcgs_video_encoder *e = opaque;
    if (whence & AVSEEK_SIZE)
        return AVERROR(ENOSYS);
    if (fseeko(e->target.file, (off_t)offset, whence & ~AVSEEK_FORCE)) { /* flushes stdio's buffer */
        e->reason = e->reason ? e->reason : errno;
        return AVERROR(errno);
    }
    return (int64_t)ftello(e->target.file);
}

static adcgs_status fail(const adcgs_video_encoder *e, int code, const char *what, adcgs_error *error)
{
    if (e->reason)
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot write: %s", e->target.path, strerror(e->reason));
    if (code == AVERROR(ENOMEM))
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", e->target.path);
    return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: cannot %s: %s", e->target.path, what, av_err2str(code));
}

static adcgs_status open_io(adcgs_video_encoder *e, adcgs_error *error)
{
    if (fseeko(e->target.file, 0, SEEK_SET))
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: a video is written to files only: %s", e->target.path, strerror(errno));
    uint8_t *buffer = av_malloc(IO_BYTES);
    e->io = buffer ? avio_alloc_context(buffer, IO_BYTES, 1, e, NULL, write_bytes, seek_bytes) : NULL;
    if (!e->io)
        av_free(buffer);
    return e->io ? ADCGS_OK : fail(e, AVERROR(ENOMEM), "", error);
}

/* ---- Codec and container ---- */

static void set_codec(adcgs_video_encoder *e, const adcgs_video_codec *chosen)
{
    AVCodecContext *c = e->codec;
    const int is_rgb = (av_pix_fmt_desc_get(chosen->format)->flags & AV_PIX_FMT_FLAG_RGB) != 0;
    const int *rate = e->target.rate;
    c->width = chosen->even ? (e->target.width + 1) & ~1 : e->target.width;
    c->height = chosen->even ? (e->target.height + 1) & ~1 : e->target.height;
    c->pix_fmt = chosen->format;
    c->sample_aspect_ratio = (AVRational){1, 1};
    c->framerate = (AVRational){rate[0], rate[1]};
    c->time_base = av_inv_q(c->framerate);
    c->color_range = is_rgb ? AVCOL_RANGE_JPEG : AVCOL_RANGE_MPEG;
    c->colorspace = is_rgb ? AVCOL_SPC_RGB : AVCOL_SPC_BT709;
    c->color_primaries = AVCOL_PRI_BT709;
    c->color_trc = AVCOL_TRC_IEC61966_2_1; /* images are sRGB, and so are renders trained on them */
    c->chroma_sample_location = is_rgb ? AVCHROMA_LOC_UNSPECIFIED : AVCHROMA_LOC_LEFT;
    c->gop_size = ADCGS_MIN(ADCGS_MAX((int)(KEY_SECONDS * (int64_t)rate[0] / rate[1]), 1), KEY_FRAMES_MAX);
    c->max_b_frames = strcasecmp(adcgs_extension(e->target.path), "avi") ? c->max_b_frames : 0; /* AVI's packets have no
                                                                                                   timestamps */
    c->thread_count = THREADS;
    c->flags |= AV_CODEC_FLAG_BITEXACT;
    if (e->format->oformat->flags & AVFMT_GLOBALHEADER)
        c->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    if (chosen->bit_rate)
        c->bit_rate = chosen->bit_rate;
}

static adcgs_status open_codec(adcgs_video_encoder *e, adcgs_video_codec *chosen, adcgs_error *error)
{
    e->codec = avcodec_alloc_context3(chosen->encoder);
    e->frame = av_frame_alloc();
    e->packet = av_packet_alloc();
    if (!e->codec || !e->frame || !e->packet)
        return fail(e, AVERROR(ENOMEM), "", error);
    set_codec(e, chosen);
    const int code = avcodec_open2(e->codec, chosen->encoder, &chosen->options);
    if (code < 0)
        return fail(e, code,
                    e->target.style.options || e->target.style.has_crf ? "encode with these options"
                                                                       : "encode frames of this size",
                    error);
    const AVDictionaryEntry *const unknown = av_dict_get(chosen->options, "", NULL, AV_DICT_IGNORE_SUFFIX);
    if (unknown)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: the encoder %s has no option %s", e->target.path, chosen->encoder->name,
                          unknown->key);
    return ADCGS_OK;
}

static int open_frame(adcgs_video_encoder *e)
{
    const AVCodecContext *c = e->codec;
    e->frame->format = c->pix_fmt;
    e->frame->width = c->width;
    e->frame->height = c->height;
    e->frame->color_range = c->color_range;
    e->frame->colorspace = c->colorspace;
    e->frame->color_primaries = c->color_primaries;
    e->frame->color_trc = c->color_trc;
    e->frame->chroma_location = c->chroma_sample_location;
    e->frame->quality = c->global_quality;
    return av_frame_get_buffer(e->frame, 0);
}

static int open_stream(adcgs_video_encoder *e)
{
    e->stream = avformat_new_stream(e->format, NULL);
    if (!e->stream)
        return AVERROR(ENOMEM);
    e->stream->time_base = e->codec->time_base;
    e->stream->avg_frame_rate = e->codec->framerate;
    e->stream->sample_aspect_ratio = e->codec->sample_aspect_ratio;
    if (e->target.style.has_alpha) /* WebM stores alpha separately and must declare it */
        av_dict_set(&e->stream->metadata, "alpha_mode", "1", 0);
    return avcodec_parameters_from_context(e->stream->codecpar, e->codec);
}

static adcgs_status begin_with(adcgs_video_encoder *e, adcgs_video_codec *chosen, adcgs_error *error)
{
    ADCGS_TRY(open_io(e, error));
    int code = avformat_alloc_output_context2(&e->format, NULL, chosen->container, NULL);
    if (code < 0)
        return fail(e, code, "write this container", error);
    e->format->pb = e->io;
    e->format->flags |= AVFMT_FLAG_CUSTOM_IO | AVFMT_FLAG_BITEXACT;
    ADCGS_TRY(open_codec(e, chosen, error));
    code = open_frame(e);
    if (code < 0)
        return fail(e, code, "encode frames of this size", error);
    code = open_stream(e);
    const adcgs_video_style *const style = &e->target.style;
    if (code >= 0 && style->sound)
        ADCGS_TRY(adcgs_video_sound_open(&e->sound, style->sound, style->sound_start, e->format, e->target.path, error));
    if (code >= 0)
        code = avformat_write_header(e->format, NULL);
    return code < 0 ? fail(e, code, "start the file", error) : ADCGS_OK;
}

static adcgs_status begin(adcgs_video_encoder *e, adcgs_error *error)
{
    adcgs_video_codec chosen;
    if (e->target.width < 1 || e->target.height < 1 || e->target.width > ADCGS_IMAGE_MAX || e->target.height > ADCGS_IMAGE_MAX)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: %dx%d pixels, expected at most %dx%d", e->target.path, e->target.width,
                          e->target.height, ADCGS_IMAGE_MAX, ADCGS_IMAGE_MAX);
    adcgs_status status = adcgs_video_choose(&chosen, &e->target, error);
    if (status == ADCGS_OK)
        status = begin_with(e, &chosen, error);
    adcgs_video_codec_clear(&chosen);
    return status;
}

adcgs_status adcgs_video_encoder_begin(adcgs_video_encoder **out, int stored[2], const adcgs_video_target *target,
                                       adcgs_error *error)
{
    *out = NULL;
    av_log_set_level(AV_LOG_QUIET); /* our own messages report FFmpeg's errors */
    adcgs_video_encoder *e = calloc(1, sizeof *e);
    if (!e)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", target->path);
    e->target = *target;
    const adcgs_status status = begin(e, error);
    if (status == ADCGS_OK) {
        stored[0] = e->codec->width;
        stored[1] = e->codec->height;
    } else
        adcgs_video_encoder_free(&e);
    *out = e;
    return status;
}

void adcgs_video_encoder_free(adcgs_video_encoder **encoder)
{
    adcgs_video_encoder *e = *encoder;
    if (!e)
        return;
    adcgs_video_sound_close(&e->sound);
    av_frame_free(&e->frame);
    av_packet_free(&e->packet);
    avcodec_free_context(&e->codec);
    avformat_free_context(e->format);
    if (e->io)
        av_freep(&e->io->buffer);
    avio_context_free(&e->io);
    free(e);
    *encoder = NULL;
}

/* ---- Frames ---- */

/** Writes the sound up to the end of the frames so far. */
static adcgs_status write_sound(adcgs_video_encoder *e, adcgs_error *error)
{
    const double end = (double)e->frames * e->target.rate[1] / e->target.rate[0];
    const int code = e->sound.output ? adcgs_video_sound_write(&e->sound, end) : 0;
    return code < 0 ? fail(e, code, "copy the sound", error) : ADCGS_OK;
}

/** Encode a frame, or with NULL the delayed ones, and write the packets. */
static adcgs_status encode(adcgs_video_encoder *e, const AVFrame *frame, adcgs_error *error)
{
    int code = avcodec_send_frame(e->codec, frame);
    while (code >= 0) {
        code = avcodec_receive_packet(e->codec, e->packet);
        if (code == AVERROR(EAGAIN) || code == AVERROR_EOF)
            return ADCGS_OK;
        if (code < 0)
            break;
        if (!e->packet->duration)
            e->packet->duration = 1;
        av_packet_rescale_ts(e->packet, e->codec->time_base, e->stream->time_base);
        e->packet->stream_index = e->stream->index;
        code = av_interleaved_write_frame(e->format, e->packet);
        if (code >= 0 && e->io->error < 0)
            code = e->io->error;
    }
    return fail(e, code, "encode", error);
}

adcgs_status adcgs_video_encoder_add(adcgs_video_encoder *e, const adcgs_frame *frame, const float *alpha, adcgs_error *error)
{
    if (frame->width != e->target.width || frame->height != e->target.height)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: a frame of %dx%d pixels, expected %dx%d", e->target.path, frame->width,
                          frame->height, e->target.width, e->target.height);
    const int code = av_frame_make_writable(e->frame); /* the encoder may still hold the previous frame */
    if (code < 0)
        return fail(e, code, "encode", error);
    ADCGS_TRY(adcgs_video_planes(e->frame, frame, alpha, error));
    e->frame->pts = e->frames++;
    ADCGS_TRY(encode(e, e->frame, error));
    return write_sound(e, error);
}

adcgs_status adcgs_video_encoder_end(adcgs_video_encoder *e, adcgs_error *error)
{
    if (!e->frames)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: a video without a frame", e->target.path);
    ADCGS_TRY(encode(e, NULL, error));
    const int code = av_write_trailer(e->format);
    return code < 0 || e->io->error < 0 ? fail(e, code < 0 ? code : e->io->error, "end the file", error) : ADCGS_OK;
}

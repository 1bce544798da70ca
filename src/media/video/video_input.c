/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A video file opened by FFmpeg. */
#include "config.h"

#include "media/video/video_input.h"

#include <libavutil/spherical.h>

#include <errno.h>
#include <stddef.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

#define IO_BYTES 65536 /* of the buffer for FFmpeg; chosen by hand, not measured */

/* Containers and bare streams that contain the images themselves. */
static const char formats[] = "mov,matroska,avi,mpegts,mpeg,mpegvideo,flv,ogg,asf,mxf,nut,ivf,h264,hevc,obu,av1,m4v,yuv4mpegpipe";

static int read_bytes(void *opaque, uint8_t *buffer, int size)
{
    const adcgs_video_input *input = opaque;
    ssize_t n;
    do
        n = read(input->fd, buffer, (size_t)size);
    while (n < 0 && errno == EINTR);
    return n > 0 ? (int)n : n ? AVERROR(errno) : AVERROR_EOF;
}

static int64_t seek_bytes(void *opaque, int64_t offset, int whence)
{
    const adcgs_video_input *input = opaque;
    struct stat status;
    if (whence & AVSEEK_SIZE)
        return fstat(input->fd, &status) ? AVERROR(errno) : (int64_t)status.st_size;
    const off_t at = lseek(input->fd, (off_t)offset, whence & ~AVSEEK_FORCE);
    return at < 0 ? AVERROR(errno) : (int64_t)at;
}

/** Prevents FFmpeg from opening other files. */
static int refuse_other(AVFormatContext *format, AVIOContext **io, const char *url, int flags, AVDictionary **options)
{
    return AVERROR(EPERM);
}

static adcgs_status no_memory(const adcgs_video_input *input, adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", input->path);
}

static adcgs_status open_io(adcgs_video_input *input, adcgs_error *error)
{
    if (lseek(input->fd, 0, SEEK_SET) < 0)
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot read: %s", input->path, strerror(errno));
    uint8_t *buffer = av_malloc(IO_BYTES);
    input->io = buffer ? avio_alloc_context(buffer, IO_BYTES, 0, input, read_bytes, NULL, seek_bytes) : NULL;
    if (!input->io)
        av_free(buffer);
    return input->io ? ADCGS_OK : no_memory(input, error);
}

static adcgs_status open_format(adcgs_video_input *input, const char *allowed, const char *kind, adcgs_error *error)
{
    AVDictionary *options = NULL;
    input->format = avformat_alloc_context();
    if (!input->format || av_dict_set(&options, "format_whitelist", allowed, 0) < 0) {
        av_dict_free(&options);
        return no_memory(input, error);
    }
    input->format->pb = input->io;
    input->format->io_open = refuse_other;
    const int code = avformat_open_input(&input->format, input->path, NULL, &options); /* frees the format on failure */
    av_dict_free(&options);
    if (code == AVERROR(ENOMEM))
        return no_memory(input, error);
    if (code < 0)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: not %s, or its beginning is damaged: %s", input->path, kind,
                          av_err2str(code));
    return ADCGS_OK;
}

/** Read the headers of all streams, and their first packets if the container does not describe them. */
static adcgs_status find_streams(adcgs_video_input *input, const char *kind, adcgs_error *error)
{
    const unsigned n = input->format->nb_streams;
    AVDictionary **options = av_calloc((size_t)n + 1, sizeof *options);
    int code = options ? 0 : AVERROR(ENOMEM);
    for (unsigned i = 0; code >= 0 && i < n; i++)
        if ((code = av_dict_set(&options[i], "threads", "1", 0)) >= 0)
            code = av_dict_set_int(&options[i], "max_pixels", (int64_t)ADCGS_IMAGE_MAX * ADCGS_IMAGE_MAX, 0);
    if (code >= 0)
        code = avformat_find_stream_info(input->format, options);
    for (unsigned i = 0; options && i < n; i++)
        av_dict_free(&options[i]);
    av_free(options);
    if (code == AVERROR(ENOMEM))
        return no_memory(input, error);
    return code < 0 ? adcgs_fail(error, ADCGS_ERR_DATA, "%s: not %s, or a damaged one: %s", input->path, kind, av_err2str(code))
                    : ADCGS_OK;
}

static adcgs_status choose_stream(adcgs_video_input *input, adcgs_error *error)
{
    const int index = av_find_best_stream(input->format, AVMEDIA_TYPE_VIDEO, -1, -1, NULL, 0);
    if (index < 0)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: no images in it, expected a video", input->path);
    for (unsigned i = 0; i < input->format->nb_streams; i++)
        if ((int)i != index)
            input->format->streams[i]->discard = AVDISCARD_ALL;
    input->stream = input->format->streams[index];
    const AVCodecParameters *par = input->stream->codecpar;
    if (par->width > ADCGS_IMAGE_MAX || par->height > ADCGS_IMAGE_MAX)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %dx%d pixels, expected at most %dx%d", input->path, par->width, par->height,
                          ADCGS_IMAGE_MAX, ADCGS_IMAGE_MAX);
    return ADCGS_OK;
}

/** Uses one thread, since callers have their own. Damage is an error and is not concealed. */
static adcgs_status open_codec(adcgs_video_input *input, adcgs_error *error)
{
    const AVCodecParameters *par = input->stream->codecpar;
    const AVCodec *decoder = avcodec_find_decoder(par->codec_id);
    if (par->codec_id == AV_CODEC_ID_NONE && !par->codec_tag)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: does not name the codec of its images: damaged or truncated", input->path);
    if (!decoder)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: this build of FFmpeg cannot decode %s", input->path,
                          avcodec_get_name(par->codec_id));
    input->codec = avcodec_alloc_context3(decoder);
    if (!input->codec)
        return no_memory(input, error);
    int code = avcodec_parameters_to_context(input->codec, par);
    input->codec->pkt_timebase = input->stream->time_base;
    input->codec->thread_count = 1;
    input->codec->max_pixels = (int64_t)ADCGS_IMAGE_MAX * ADCGS_IMAGE_MAX;
    input->codec->err_recognition = AV_EF_CRCCHECK | AV_EF_BITSTREAM | AV_EF_BUFFER | AV_EF_EXPLODE;
    input->codec->error_concealment = 0;
    if (code >= 0)
        code = avcodec_open2(input->codec, decoder, NULL);
    if (code == AVERROR(ENOMEM))
        return no_memory(input, error);
    return code < 0 ? adcgs_fail(error, ADCGS_ERR_DATA, "%s: cannot start to decode %s: %s", input->path,
                                 avcodec_get_name(par->codec_id), av_err2str(code))
                    : ADCGS_OK;
}

adcgs_status adcgs_video_input_attach(adcgs_video_input *input, const char *allowed, const char *kind, adcgs_error *error)
{
    ADCGS_TRY(open_io(input, error));
    ADCGS_TRY(open_format(input, allowed, kind, error));
    return find_streams(input, kind, error);
}

adcgs_status adcgs_video_input_open(adcgs_video_input *input, adcgs_error *error)
{
    ADCGS_TRY(adcgs_video_input_attach(input, formats, "a video", error));
    ADCGS_TRY(choose_stream(input, error));
    return open_codec(input, error);
}

void adcgs_video_input_close(adcgs_video_input *input)
{
    avcodec_free_context(&input->codec);
    avformat_close_input(&input->format);
    if (input->io)
        av_freep(&input->io->buffer);
    avio_context_free(&input->io);
    input->stream = NULL;
}

int adcgs_video_input_next(adcgs_video_input *input, AVPacket *packet)
{
    for (;;) {
        const int code = av_read_frame(input->format, packet);
        if (code < 0 || (packet->stream_index == input->stream->index && packet->size > 0))
            return code;
        av_packet_unref(packet);
    }
}

/** Data that the container attaches to the stream, at least `least` bytes; NULL if there is none. */
static const void *find_side_data(const adcgs_video_input *input, enum AVPacketSideDataType type, size_t least)
{
#if LIBAVCODEC_VERSION_INT >= AV_VERSION_INT(60, 31, 0) /* FFmpeg 6.1 moved it */
    const AVCodecParameters *par = input->stream->codecpar;
    const AVPacketSideData *side = av_packet_side_data_get(par->coded_side_data, par->nb_coded_side_data, type);
    return side && side->size >= least ? side->data : NULL;
#else
#if LIBAVFORMAT_VERSION_MAJOR < 59
    int size = 0;
#else
    size_t size = 0;
#endif
    const uint8_t *data = av_stream_get_side_data(input->stream, type, &size);
    return data && (size_t)size >= least ? data : NULL;
#endif
}

const int32_t *adcgs_video_input_matrix(const adcgs_video_input *input)
{
    return find_side_data(input, AV_PKT_DATA_DISPLAYMATRIX, 9 * sizeof(int32_t));
}

const char *adcgs_video_input_projection(const adcgs_video_input *input)
{
    const AVSphericalMapping *const mapping =
        find_side_data(input, AV_PKT_DATA_SPHERICAL, offsetof(AVSphericalMapping, projection) + sizeof mapping->projection);
    return mapping ? av_spherical_projection_name(mapping->projection) : NULL;
}

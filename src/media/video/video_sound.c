/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A sound file whose packets go into a video unchanged. */
#include "config.h"

#include "media/video/video_sound.h"

#include <errno.h>
#include <fcntl.h>
#include <unistd.h>

static const char formats[] = "ogg,matroska,mov,mp3,flac,wav,aac";

static adcgs_status add_stream(adcgs_video_sound *sound, const char *target, adcgs_error *error)
{
    const adcgs_video_input *input = &sound->input;
    const AVCodecParameters *par = input->stream->codecpar;
    if (avformat_query_codec(sound->output->oformat, par->codec_id, FF_COMPLIANCE_NORMAL) != 1)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: this container stores no %s, the sound of %.160s", target,
                          avcodec_get_name(par->codec_id), input->path);
    sound->stream = avformat_new_stream(sound->output, NULL);
    sound->packet = av_packet_alloc();
    if (!sound->stream || !sound->packet || avcodec_parameters_copy(sound->stream->codecpar, par) < 0)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", target);
    sound->stream->codecpar->codec_tag = 0; /* containers have their own */
    sound->stream->time_base = input->stream->time_base;
    return ADCGS_OK;
}

adcgs_status adcgs_video_sound_open(adcgs_video_sound *sound, const char *path, double start, AVFormatContext *output,
                                    const char *target, adcgs_error *error)
{
    *sound = (adcgs_video_sound){.input = {.fd = -1, .path = path}, .output = output, .start = start};
    sound->input.fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK); /* opening a pipe without a writer must not block */
    if (sound->input.fd < 0)
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot open: %s", path, strerror(errno));
    ADCGS_TRY(adcgs_video_input_attach(&sound->input, formats, "a sound", error));
    const int index = av_find_best_stream(sound->input.format, AVMEDIA_TYPE_AUDIO, -1, -1, NULL, 0);
    if (index < 0)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: no sound in it", path);
    sound->input.stream = sound->input.format->streams[index];
    return add_stream(sound, target, error);
}

void adcgs_video_sound_close(adcgs_video_sound *sound)
{
    if (sound->input.path && sound->input.fd >= 0)
        close(sound->input.fd);
    adcgs_video_input_close(&sound->input);
    av_packet_free(&sound->packet);
    *sound = (adcgs_video_sound){.pending = 0};
}

/** Reads the next packet that sounds after the video's begin. Its times become those of the video. */
static int read_packet(adcgs_video_sound *sound)
{
    AVPacket *const packet = sound->packet;
    const AVRational base = sound->input.stream->time_base;
    const int64_t shift = (int64_t)(sound->start / av_q2d(base) + (sound->start < 0 ? -0.5 : 0.5));
    for (;;) {
        const int code = adcgs_video_input_next(&sound->input, packet);
        if (code < 0)
            return code;
        if (packet->pts != AV_NOPTS_VALUE && packet->pts + packet->duration > shift)
            break;
        av_packet_unref(packet);
    }
    packet->pts -= shift;
    packet->dts = packet->pts;
    packet->pos = -1;
    sound->pending = 1;
    return 0;
}

int adcgs_video_sound_write(adcgs_video_sound *sound, double until)
{
    AVPacket *const packet = sound->packet;
    for (;;) {
        int code = sound->pending ? 0 : read_packet(sound);
        if (code == AVERROR_EOF)
            return 0;
        if (code < 0 || (double)packet->pts * av_q2d(sound->input.stream->time_base) >= until)
            return code;
        sound->pending = 0;
        av_packet_rescale_ts(packet, sound->input.stream->time_base, sound->stream->time_base);
        packet->stream_index = sound->stream->index;
        code = av_interleaved_write_frame(sound->output, packet);
        if (code < 0)
            return code;
    }
}

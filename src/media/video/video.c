/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Video files: the front of the module with FFmpeg. */
#include "config.h"

#include "media/video/video.h"

#include "media/video/video_ffmpeg.h"
#include "system/atomic.h"
#include "system/extension.h"

#include <math.h>
#include <stdlib.h>
#include <strings.h>

#define RATE_MAX 100000.0 /* frames per second; chosen by hand, not measured */

struct adcgs_video {
    const adcgs_ffmpeg *ffmpeg;
    adcgs_video_info info;
    adcgs_video_reader *reader;
};

struct adcgs_video_writer {
    const adcgs_ffmpeg *ffmpeg;
    adcgs_atomic atomic;
    adcgs_video_encoder *encoder;
    char *path;
    int stored[2];
};

#ifndef HAVE_FFMPEG

static adcgs_status get_ffmpeg(const adcgs_ffmpeg **ffmpeg, const char *path, adcgs_error *error)
{
    *ffmpeg = NULL;
    return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: videos need FFmpeg, which this build lacks", path);
}

#else

static ADCGS_MODULE_GET(get_ffmpeg, adcgs_ffmpeg, adcgs_ffmpeg_table, "adcgs_video.so", "videos need FFmpeg")

#endif

int adcgs_is_video(const char *path)
{
    static const char *const extensions[] = {"mp4", "m4v", "mov", "mkv", "webm", "avi", "mpg", "mpeg", "mts",  "m2ts",
                                             "ts",  "wmv", "flv", "ogv", "3gp",  "ivf", "mxf", "h264", "hevc", "obu"};
    const char *extension = adcgs_extension(path);
    for (size_t i = 0; i < ADCGS_COUNTOF(extensions); i++)
        if (!strcasecmp(extension, extensions[i]))
            return 1;
    return 0;
}

/* ---- Reading ---- */

adcgs_status adcgs_video_open(adcgs_video **out, const char *path, adcgs_error *error)
{
    const adcgs_ffmpeg *ffmpeg;
    *out = NULL;
    ADCGS_TRY(get_ffmpeg(&ffmpeg, path, error));
    adcgs_video *video = calloc(1, sizeof *video);
    if (!video)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    video->ffmpeg = ffmpeg;
    const adcgs_status status = ffmpeg->open(&video->reader, &video->info, path, error);
    if (status != ADCGS_OK)
        adcgs_video_close(&video);
    *out = video;
    return status;
}

void adcgs_video_close(adcgs_video **video)
{
    if (!*video)
        return;
    (*video)->ffmpeg->close(&(*video)->reader);
    free(*video);
    *video = NULL;
}

const adcgs_video_info *adcgs_video_get_info(const adcgs_video *video)
{
    return &video->info;
}

adcgs_status adcgs_video_read(adcgs_video *video, int64_t frame, adcgs_image *out, adcgs_error *error)
{
    return video->ffmpeg->read(video->reader, frame, out, error);
}

double adcgs_video_time(const adcgs_video *video, int64_t frame)
{
    const double time = video->ffmpeg->time(video->reader, frame);
    return isnan(time) ? (double)frame / adcgs_fps_value(video->info.rate) : time;
}

/* ---- Writing ---- */

static adcgs_status begin(adcgs_video_writer *w, int width, int height, double frame_rate, const adcgs_video_style *style,
                          adcgs_error *error)
{
    if (!(frame_rate >= 0.001 && frame_rate <= RATE_MAX))
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: %g frames per second, expected 0.001 to %g", w->path, frame_rate,
                          RATE_MAX);
    const adcgs_fps rate = adcgs_fps_of(frame_rate);
    ADCGS_TRY(adcgs_atomic_open(&w->atomic, w->path, error));
    const adcgs_video_target target = {.file = w->atomic.file,
                                       .path = w->path,
                                       .width = width,
                                       .height = height,
                                       .style = *style,
                                       .rate = {(int)rate.num, (int)rate.den}};
    return w->ffmpeg->begin(&w->encoder, w->stored, &target, error);
}

adcgs_status adcgs_video_write_open(adcgs_video_writer **out, const char *path, int width, int height, double frame_rate,
                                    const adcgs_video_style *style, adcgs_error *error)
{
    const adcgs_ffmpeg *ffmpeg;
    *out = NULL;
    ADCGS_TRY(get_ffmpeg(&ffmpeg, path, error));
    adcgs_video_writer *w = calloc(1, sizeof *w);
    if (!w)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    w->ffmpeg = ffmpeg;
    w->path = strdup(path);
    const adcgs_status status = w->path ? begin(w, width, height, frame_rate, style, error)
                                        : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    if (status != ADCGS_OK)
        adcgs_video_write_abort(&w);
    *out = w;
    return status;
}

void adcgs_video_write_size(const adcgs_video_writer *writer, int *width, int *height)
{
    *width = writer->stored[0];
    *height = writer->stored[1];
}

adcgs_status adcgs_video_write_frame(adcgs_video_writer *writer, const adcgs_frame *frame, const float *alpha, adcgs_error *error)
{
    return writer->ffmpeg->add(writer->encoder, frame, alpha, error);
}

adcgs_status adcgs_video_write_close(adcgs_video_writer **writer, adcgs_error *error)
{
    adcgs_video_writer *w = *writer;
    adcgs_status status = w->ffmpeg->end(w->encoder, error);
    if (status == ADCGS_OK)
        status = adcgs_atomic_commit(&w->atomic, error);
    adcgs_video_write_abort(writer);
    return status;
}

void adcgs_video_write_abort(adcgs_video_writer **writer)
{
    adcgs_video_writer *w = *writer;
    if (!w)
        return;
    w->ffmpeg->free(&w->encoder);
    adcgs_atomic_abort(&w->atomic);
    free(w->path);
    free(w);
    *writer = NULL;
}

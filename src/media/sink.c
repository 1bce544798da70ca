/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Output of rendered frames. Each kind of output is a row of a table. */
#include "config.h"

#include "media/sink.h"

#include "media/image/image.h"
#include "media/video/video.h"
#include "media/video/y4m.h"
#include "system/atomic.h"
#include "system/extension.h"
#include "system/flush.h"

#include <adcgs/frame.h>

#include <errno.h>
#include <stdlib.h>
#include <strings.h>

typedef struct kind {
    const char *name;
    int is_stream; /**< all frames go to one file */
    int has_float;
    void (*begin)(FILE *file, const adcgs_sink_config *config);
    adcgs_status (*write)(adcgs_sink *sink, const adcgs_frame *frame, int index, adcgs_error *error);
} kind;

struct adcgs_sink {
    adcgs_sink_config config;
    const kind *what;
    adcgs_sink_extras extras; /**< of the frame being written */
    FILE *file;               /**< of a stream: standard output or the atomic file */
    adcgs_atomic atomic;
    adcgs_video_writer *video;
};

static void y4m_begin(FILE *file, const adcgs_sink_config *config)
{
    adcgs_y4m_write_header(file, config->width, config->height, config->frame_rate);
}

static adcgs_status y4m_write(adcgs_sink *sink, const adcgs_frame *frame, int index, adcgs_error *error)
{
    return adcgs_y4m_write_frame(sink->file, frame, error);
}

/** RGB, interleaved: bytes, or binary32 in little-endian order. */
static adcgs_status raw_write(adcgs_sink *sink, const adcgs_frame *frame, int index, adcgs_error *error)
{
    const size_t n = (size_t)frame->width * (size_t)frame->height * 3;
    const size_t each = sink->config.depth == ADCGS_DEPTH_FLOAT ? 4 : 1;
    uint8_t *bytes = malloc(n * each);
    if (!bytes)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for a frame of %dx%d pixels", frame->width, frame->height);
    if (each == 1)
        adcgs_frame_to_u8(frame, bytes);
    else
        for (size_t i = 0; i < n; i++)
            adcgs_store_le32(bytes + 4 * i, adcgs_float_bits(frame->rgb[i]));
    fwrite(bytes, each, n, sink->file);
    free(bytes);
    return ADCGS_OK;
}

static adcgs_status null_write(adcgs_sink *sink, const adcgs_frame *frame, int index, adcgs_error *error)
{
    return ADCGS_OK;
}

/** Join colours and alpha to four channels. */
static adcgs_status join_alpha(adcgs_image *image, const adcgs_frame *frame, const float *alpha, const char *path,
                               adcgs_error *error)
{
    const size_t n = (size_t)frame->width * (size_t)frame->height;
    ADCGS_TRY(adcgs_image_alloc(image, frame->width, frame->height, 4, path, error));
    for (size_t i = 0; i < n; i++) {
        memcpy(image->data + 4 * i, frame->rgb + 3 * i, 3 * sizeof *frame->rgb);
        image->data[4 * i + 3] = alpha[i];
    }
    return ADCGS_OK;
}

static adcgs_status write_picture(const adcgs_sink *sink, const adcgs_frame *frame, const char *path, adcgs_error *error)
{
    const adcgs_sink_extras *extras = &sink->extras;
    const adcgs_depth depth = sink->config.depth;
    const adcgs_image_options options = {.format = sink->config.format,
                                         .half = depth != ADCGS_DEPTH_FLOAT,
                                         .linear = sink->config.linear,
                                         .bits = depth == ADCGS_DEPTH_16 ? 16 : 8,
                                         .premultiplied = 1,
                                         .depth = extras->depth,
                                         .camera = extras->camera,
                                         .time = extras->time};
    adcgs_image image = {frame->width, frame->height, 3, frame->rgb};
    if (!extras->alpha)
        return adcgs_image_write_as(&image, &options, path, error);
    ADCGS_TRY(join_alpha(&image, frame, extras->alpha, path, error));
    const adcgs_status status = adcgs_image_write_as(&image, &options, path, error);
    adcgs_image_free(&image);
    return status;
}

static adcgs_status image_write(adcgs_sink *sink, const adcgs_frame *frame, int index, adcgs_error *error)
{
    const size_t size = strlen(sink->config.target) + 128;
    char *path = malloc(size);
    if (!path)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", sink->config.target);
    adcgs_pattern_format(sink->config.target, index, path, size);
    const adcgs_status status = write_picture(sink, frame, path, error);
    free(path);
    return status;
}

static adcgs_status video_write(adcgs_sink *sink, const adcgs_frame *frame, int index, adcgs_error *error)
{
    return adcgs_video_write_frame(sink->video, frame, sink->extras.alpha, error);
}

static const kind kinds[] = {
    {"y4m", 1, 0, y4m_begin, y4m_write},
    {"raw", 1, 1, NULL, raw_write},
    {"null", 0, 1, NULL, null_write},
};
static const kind image_kind = {"image", 0, 0, NULL, image_write};
static const kind exr_kind = {"exr", 0, 1, NULL, image_write};
static const kind video_kind = {"video", 0, 0, NULL, video_write};

static const kind *find_kind(const char *format)
{
    char name[16];
    for (size_t i = 0; i < ADCGS_COUNTOF(kinds); i++)
        if (!strcasecmp(format, kinds[i].name))
            return &kinds[i];
    snprintf(name, sizeof name, "x.%s", format);
    if (adcgs_is_video(name))
        return &video_kind;
    return strcasecmp(format, "exr") ? &image_kind : &exr_kind;
}

int adcgs_pattern_format(const char *pattern, int index, char *out, size_t size)
{
    size_t used = 0;
    int places = 0;
    for (const char *c = pattern; *c; c++) {
        int n;
        if (*c != '%' || c[1] == '%') {
            n = snprintf(out + used, size - used, "%c", *c);
            c += *c == '%';
        } else {
            const int zero = *++c == '0';
            int width = 0;
            while (*c >= '0' && *c <= '9' && width < 100)
                width = 10 * width + (*c++ - '0');
            if (*c != 'd' || width > 20)
                return -1;
            places++;
            n = snprintf(out + used, size - used, zero ? "%0*d" : "%*d", width, index);
        }
        if (n < 0 || (size_t)n >= size - used)
            return -1;
        used += (size_t)n;
    }
    return places <= 1 ? 0 : -1;
}

int adcgs_pattern_places(const char *pattern)
{
    int places = 0;
    for (const char *c = strchr(pattern, '%'); c; c = strchr(c + 1, '%')) {
        if (*++c == '%')
            continue;
        while (*c >= '0' && *c <= '9')
            c++;
        if (*c != 'd')
            return -1;
        places++;
    }
    return places;
}

static adcgs_status check(const adcgs_sink_config *config, const kind *what, const char *format, adcgs_error *error)
{
    const int is_image = what == &image_kind || what == &exr_kind;
    const int places = is_image ? adcgs_pattern_places(config->target) : 0;
    if (config->depth == ADCGS_DEPTH_FLOAT && !what->has_float)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: float samples need EXR or raw", config->target);
    if (config->depth == ADCGS_DEPTH_HALF && what != &exr_kind)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: half samples need EXR", config->target);
    if (config->depth == ADCGS_DEPTH_16 && what != &image_kind)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: 16 bits need PNG, TIFF or PPM", config->target);
    const int flat = is_image ? !strcasecmp(format, "ppm") || !strcasecmp(format, "pgm") : what != &video_kind;
    if (config->has_alpha && flat)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: alpha needs EXR, PNG, TIFF or a video", config->target);
    if (config->video && what != &video_kind)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: codecs, their options and sounds are for videos", config->target);
    if (config->has_z && what != &exr_kind)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: depth needs EXR", config->target);
    if (config->linear && what != &exr_kind)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: linear light needs EXR", config->target);
    if (!is_image && what != &video_kind)
        return ADCGS_OK;
    if (!strcmp(config->target, "-"))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "standard output takes y4m or raw, not %s", format);
    const int names_it = is_image && config->format && *config->format;
    if (!names_it && (!*format || strcasecmp(adcgs_extension(config->target), format)))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: the name must end in .%s", config->target,
                          *format ? format : "ppm, .exr, .y4m, ...");
    if (!is_image)
        return ADCGS_OK;
    if (places < 0 || places > 1)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: expected one number like %%04d in the name", config->target);
    if (!places && config->frames > 1)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: %d frames need a number like %%04d in the name", config->target,
                          config->frames);
    return ADCGS_OK;
}

/** Open the sink's output: standard output, an atomic file, or a video, which is opened by name. */
static adcgs_status open_target(adcgs_sink *sink, adcgs_error *error)
{
    const adcgs_sink_config *config = &sink->config;
    if (sink->what == &video_kind) {
        adcgs_video_style style = config->video ? *config->video : (adcgs_video_style){0};
        style.has_alpha = config->has_alpha;
        return adcgs_video_write_open(&sink->video, config->target, config->width, config->height, config->frame_rate, &style,
                                      error);
    }
    if (!sink->what->is_stream)
        return ADCGS_OK;
    if (strcmp(config->target, "-"))
        ADCGS_TRY(adcgs_atomic_open(&sink->atomic, config->target, error));
    sink->file = sink->atomic.file ? sink->atomic.file : stdout;
    return ADCGS_OK;
}

adcgs_status adcgs_sink_open(adcgs_sink **out, const adcgs_sink_config *config, adcgs_error *error)
{
    *out = NULL;
    const int to_stdout = !strcmp(config->target, "-");
    const char *format = config->format ? config->format : to_stdout ? "y4m" : adcgs_extension(config->target);
    const kind *what = find_kind(format);
    ADCGS_TRY(check(config, what, format, error));
    adcgs_sink *sink = calloc(1, sizeof *sink);
    if (!sink)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", config->target);
    sink->config = *config;
    sink->what = what;
    const adcgs_status status = open_target(sink, error);
    if (status != ADCGS_OK) {
        free(sink);
        return status;
    }
    if (what->begin)
        what->begin(sink->file, config);
    *out = sink;
    return ADCGS_OK;
}

void adcgs_sink_size(const adcgs_sink *sink, int *width, int *height)
{
    *width = sink->config.width;
    *height = sink->config.height;
    if (sink->video)
        adcgs_video_write_size(sink->video, width, height);
}

adcgs_status adcgs_sink_write(adcgs_sink *sink, const adcgs_frame *frame, int index, adcgs_error *error)
{
    const adcgs_sink_extras none = {0};
    return adcgs_sink_write_with(sink, frame, &none, index, error);
}

adcgs_status adcgs_sink_write_with(adcgs_sink *sink, const adcgs_frame *frame, const adcgs_sink_extras *extras, int index,
                                   adcgs_error *error)
{
    sink->extras = *extras;
    if (frame->width != sink->config.width || frame->height != sink->config.height)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: a frame of %dx%d pixels, expected %dx%d", sink->config.target,
                          frame->width, frame->height, sink->config.width, sink->config.height);
    errno = 0;
    ADCGS_TRY(sink->what->write(sink, frame, index, error));
    if (sink->file && ferror(sink->file))
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot write: %s",
                          sink->file == stdout ? "standard output" : sink->config.target, strerror(errno ? errno : EIO));
    return ADCGS_OK;
}

adcgs_status adcgs_sink_close(adcgs_sink **sink, adcgs_error *error)
{
    adcgs_status status = ADCGS_OK;
    if (!*sink)
        return ADCGS_OK;
    const int reason = (*sink)->file == stdout ? adcgs_file_flush(stdout) : 0;
    if (reason)
        status = adcgs_fail(error, ADCGS_ERR_IO, "standard output: cannot write: %s", strerror(reason));
    else if ((*sink)->atomic.file)
        status = adcgs_atomic_commit(&(*sink)->atomic, error);
    else if ((*sink)->video)
        status = adcgs_video_write_close(&(*sink)->video, error);
    free(*sink);
    *sink = NULL;
    return status;
}

void adcgs_sink_abort(adcgs_sink **sink)
{
    if (!*sink)
        return;
    adcgs_atomic_abort(&(*sink)->atomic);
    adcgs_video_write_abort(&(*sink)->video);
    free(*sink);
    *sink = NULL;
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Writing OpenEXR. */
#include "config.h"

#include "io/exr.h"

#include <unistd.h>

#include <openexr.h>

static const char *const channel_names[5] = {"", "Y", "YA", "RGB", "RGBA"};

/** Messages are written by the callers, with the file's name. */
static void ignore_message(exr_const_context_t context, exr_result_t code, const char *text)
{
}

/** Place of a channel in a pixel of ours, -1 if it has none. */
static int place_of(const char *name, int channels)
{
    const char *found = name[0] && !name[1] ? strchr(channel_names[channels], name[0]) : NULL;
    return found ? (int)(found - channel_names[channels]) : -1;
}

/** Point the library at where a chunk's first row lies in our picture. */
static void aim(exr_coding_channel_info_t *channels, int count, const adcgs_image *image, int row)
{
    const size_t pixel = (size_t)image->channels;
    for (int i = 0; i < count; i++) {
        const size_t place = (size_t)place_of(channels[i].channel_name, image->channels);
        const float *first = image->data + (size_t)row * (size_t)image->width * pixel + place;
        channels[i].user_bytes_per_element = 4;
        channels[i].user_data_type = EXR_PIXEL_FLOAT;
        channels[i].user_pixel_stride = (int32_t)(pixel * sizeof(float));
        channels[i].user_line_stride = (int32_t)(pixel * sizeof(float) * (size_t)image->width);
        channels[i].encode_from_ptr = (const uint8_t *)first;
    }
}

static int64_t write_at(exr_const_context_t context, void *user, const void *buffer, uint64_t bytes, uint64_t offset,
                        exr_stream_error_func_ptr_t report)
{
    const int fd = fileno(user);
    uint64_t done = 0;
    while (done < bytes) {
        const ssize_t n = pwrite(fd, (const uint8_t *)buffer + done, bytes - done, (off_t)(offset + done));
        if (n <= 0)
            return -1;
        done += (uint64_t)n;
    }
    return (int64_t)done;
}

static exr_result_t describe(exr_context_t context, const adcgs_image *image, int half)
{
    int part;
    exr_result_t code = exr_add_part(context, "image", EXR_STORAGE_SCANLINE, &part);
    if (code == EXR_ERR_SUCCESS)
        code = exr_initialize_required_attr_simple(context, part, image->width, image->height, EXR_COMPRESSION_ZIP);
    /* The file's channels are in alphabetical order. */
    for (const char *sorted = "ABGRY"; *sorted && code == EXR_ERR_SUCCESS; sorted++) {
        const char name[2] = {*sorted, 0};
        if (place_of(name, image->channels) >= 0)
            code = exr_add_channel(context, part, name, half ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT, EXR_PERCEPTUALLY_LOGARITHMIC,
                                   1, 1);
    }
    return code == EXR_ERR_SUCCESS ? exr_write_header(context) : code;
}

static exr_result_t write_chunks(exr_context_t context, const adcgs_image *image)
{
    exr_encode_pipeline_t pipeline = EXR_ENCODE_PIPELINE_INITIALIZER;
    exr_result_t code = EXR_ERR_SUCCESS;
    int started = 0;
    for (int y = 0; y < image->height && code == EXR_ERR_SUCCESS;) {
        exr_chunk_info_t chunk;
        code = exr_write_scanline_chunk_info(context, 0, y, &chunk);
        if (code == EXR_ERR_SUCCESS)
            code = started ? exr_encoding_update(context, 0, &chunk, &pipeline)
                           : exr_encoding_initialize(context, 0, &chunk, &pipeline);
        if (code != EXR_ERR_SUCCESS)
            break;
        aim(pipeline.channels, pipeline.channel_count, image, y);
        if (!started)
            code = exr_encoding_choose_default_routines(context, 0, &pipeline);
        started = 1;
        if (code == EXR_ERR_SUCCESS)
            code = exr_encoding_run(context, 0, &pipeline);
        y += chunk.height;
    }
    exr_encoding_destroy(context, &pipeline);
    return code;
}

static exr_result_t write_premultiplied(FILE *file, const adcgs_image *image, int half, const char *path)
{
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = ignore_message;
    setup.user_data = file;
    setup.write_fn = write_at;
    exr_context_t context;
    exr_result_t code = exr_start_write(&context, path, EXR_WRITE_FILE_DIRECTLY, &setup);
    if (code != EXR_ERR_SUCCESS)
        return code;
    code = describe(context, image, half);
    if (code == EXR_ERR_SUCCESS)
        code = write_chunks(context, image);
    const exr_result_t end = exr_finish(&context);
    return code == EXR_ERR_SUCCESS ? end : code;
}

adcgs_status adcgs_exr_write(FILE *file, const adcgs_image *image, int half, const char *path, adcgs_error *error)
{
    adcgs_image copy = *image;
    if (image->channels % 2 == 0) {
        ADCGS_TRY(adcgs_image_alloc(&copy, image->width, image->height, image->channels, path, error));
        memcpy(copy.data, image->data, (size_t)image->width * (size_t)image->height * (size_t)image->channels * sizeof(float));
        adcgs_image_premultiply(&copy);
    }
    const exr_result_t code = write_premultiplied(file, &copy, half, path);
    if (copy.data != image->data)
        adcgs_image_free(&copy);
    if (code != EXR_ERR_SUCCESS)
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot write EXR: %s", path, exr_get_default_error_message(code));
    return ADCGS_OK;
}

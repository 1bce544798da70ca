/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Writing OpenEXR. */
#include "config.h"

#include "media/image/exr.h"

#include <openexr.h>

/* Smallest pixel aspect ratio that the library accepts; the largest is its inverse. Definition (checks of OpenEXR). */
#define ASPECT_MIN 1e-6

/** A channel and the place of its samples; the file sorts channels alphabetically. */
typedef struct plane {
    char name[2];
    exr_pixel_type_t type;
    const float *samples;
    size_t stride; /**< floats from one pixel to the next */
} plane;

typedef struct picture {
    const adcgs_image *image;
    const adcgs_image_options *options;
    int n;
    plane planes[5];
} picture;

/** Ignores the library's messages: callers write their own, with the file's name. */
static void ignore_message(exr_const_context_t context, exr_result_t code, const char *text) {}

static void list_planes(picture *p)
{
    static const char *const names[5] = {"", "Y", "YA", "RGB", "RGBA"};
    const adcgs_image *image = p->image;
    const exr_pixel_type_t type = p->options->half ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT;
    for (const char *sorted = "ABGRY"; *sorted; sorted++) {
        const char *found = strchr(names[image->channels], *sorted);
        if (found)
            p->planes[p->n++] = (plane){{*sorted}, type, image->data + (found - names[image->channels]), (size_t)image->channels};
    }
    if (p->options->depth)
        p->planes[p->n++] = (plane){"Z", EXR_PIXEL_FLOAT, p->options->depth, 1};
}

/** Point the library at the first row of a chunk in our image. */
static void aim(exr_coding_channel_info_t *channels, int count, const picture *p, int row)
{
    for (int i = 0; i < count && i < p->n; i++) {
        const plane *from = &p->planes[i];
        const size_t line = from->stride * (size_t)p->image->width;
        channels[i].user_bytes_per_element = 4;
        channels[i].user_data_type = EXR_PIXEL_FLOAT;
        channels[i].user_pixel_stride = (int32_t)(from->stride * sizeof(float));
        channels[i].user_line_stride = (int32_t)(line * sizeof(float));
        channels[i].encode_from_ptr = (const uint8_t *)(from->samples + (size_t)row * line);
    }
}

/**
 * Write callback of the library: writes bytes at an offset of the file, which is in memory. The library leaves gaps and fills
 * them later.
 */
static int64_t write_at(exr_const_context_t context, void *user, const void *buffer, uint64_t bytes, uint64_t offset,
                        exr_stream_error_func_ptr_t report)
{
    static const uint8_t gap[4096];
    adcgs_buffer *out = user;
    while (out->size < offset && !out->failed)
        adcgs_write_bytes(out, gap, (size_t)ADCGS_MIN(offset - out->size, (uint64_t)sizeof gap));
    const size_t over = out->failed ? 0 : (size_t)ADCGS_MIN(out->size - offset, bytes);
    if (over)
        memcpy(out->data + offset, buffer, over);
    adcgs_write_bytes(out, (const uint8_t *)buffer + over, (size_t)(bytes - over));
    if (!out->failed)
        return (int64_t)bytes;
    report(context, EXR_ERR_OUT_OF_MEMORY, "out of memory");
    return -1;
}

/** Our matrices multiply column vectors. EXR's multiply row vectors, and its camera has y up. */
static void make_matrices(const adcgs_camera *camera, exr_attr_m44f_t *to_camera, exr_attr_m44f_t *to_ndc)
{
    double m[4][3]; /* world to our camera, for row vectors */
    for (int j = 0; j < 3; j++) {
        m[3][j] = 0.0;
        for (int i = 0; i < 3; i++) {
            m[i][j] = camera->cam_to_world[4 * i + j];
            m[3][j] -= camera->cam_to_world[4 * i + 3] * m[i][j];
        }
    }
    for (int i = 0; i < 4; i++) {
        const double x = m[i][0], y = m[i][1], z = m[i][2], one = i == 3;
        const double camera_row[4] = {x, -y, z, one};
        const double ndc_row[4] = {(camera->fx * x + camera->cx * z) / camera->width,
                                   (camera->fy * y + camera->cy * z) / camera->height, z - one * camera->near_plane, z};
        for (int j = 0; j < 4; j++) {
            to_camera->m[4 * i + j] = (float)camera_row[j];
            to_ndc->m[4 * i + j] = (float)ndc_row[j];
        }
    }
}

/**
 * Set the attributes that every EXR file has. The screen window is the camera's projection of the image onto a plane at distance
 * 1.
 */
static exr_result_t describe_size(exr_context_t context, int part, const picture *p)
{
    const adcgs_camera *camera = p->options->camera;
    const int width = p->image->width, height = p->image->height;
    const exr_attr_box2i_t window = {.min = {{{0, 0}}}, .max = {{{width - 1, height - 1}}}};
    exr_attr_v2f_t centre = {{{0.0f, 0.0f}}};
    float across = 1.0f, aspect = 1.0f;
    if (camera) {
        centre.x = (float)((camera->cx - 0.5 * width) / camera->fx);
        centre.y = (float)((camera->cy - 0.5 * height) / camera->fy);
        across = (float)(width / camera->fx);
        aspect = (float)ADCGS_MIN(ADCGS_MAX(camera->fy / camera->fx, ASPECT_MIN), 1.0 / ASPECT_MIN);
    }
    return exr_initialize_required_attr(context, part, &window, &window, aspect, &centre, across, EXR_LINEORDER_INCREASING_Y,
                                        EXR_COMPRESSION_ZIP);
}

static exr_result_t describe_camera(exr_context_t context, int part, const adcgs_camera *camera, double time)
{
    exr_attr_m44f_t to_camera, to_ndc;
    make_matrices(camera, &to_camera, &to_ndc);
    const exr_attr_v2d_t focal = {{{camera->fx, camera->fy}}}, principal = {{{camera->cx, camera->cy}}};
    const exr_result_t codes[] = {
        exr_attr_set_m44f(context, part, "worldToCamera", &to_camera),
        exr_attr_set_m44f(context, part, "worldToNDC", &to_ndc),
        exr_attr_set_v2d(context, part, "adcgs/focal", &focal),
        exr_attr_set_v2d(context, part, "adcgs/principal", &principal),
        exr_attr_set_double(context, part, "adcgs/near", camera->near_plane),
        exr_attr_set_double(context, part, "adcgs/time", time),
        exr_attr_set_string(context, part, "adcgs/camera", camera->name),
    };
    for (size_t i = 0; i < ADCGS_COUNTOF(codes); i++)
        if (codes[i] != EXR_ERR_SUCCESS)
            return codes[i];
    return EXR_ERR_SUCCESS;
}

/** Declare the colour space. Readers take an EXR file without a declaration for linear light with these primaries, sRGB's. */
static exr_result_t describe_colours(exr_context_t context, int part, int linear)
{
    static const exr_attr_chromaticities_t bt709 = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};
    if (!linear)
        return exr_attr_set_string(context, part, "oiio:ColorSpace", "sRGB");
    const exr_result_t code = exr_attr_set_string(context, part, "oiio:ColorSpace", "Linear");
    return code == EXR_ERR_SUCCESS ? exr_attr_set_chromaticities(context, part, "chromaticities", &bt709) : code;
}

static exr_result_t describe(exr_context_t context, const picture *p)
{
    int part;
    exr_result_t code = exr_add_part(context, "image", EXR_STORAGE_SCANLINE, &part);
    if (code == EXR_ERR_SUCCESS)
        code = describe_size(context, part, p);
    for (int i = 0; i < p->n && code == EXR_ERR_SUCCESS; i++)
        code = exr_add_channel(context, part, p->planes[i].name, p->planes[i].type, EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    if (code == EXR_ERR_SUCCESS)
        code = exr_attr_set_string(context, part, "software", PACKAGE_NAME " " PACKAGE_VERSION);
    if (code == EXR_ERR_SUCCESS)
        code = describe_colours(context, part, p->options->linear);
    if (code == EXR_ERR_SUCCESS && p->options->camera)
        code = describe_camera(context, part, p->options->camera, p->options->time);
    return code == EXR_ERR_SUCCESS ? exr_write_header(context) : code;
}

static exr_result_t write_chunks(exr_context_t context, const picture *p)
{
    exr_encode_pipeline_t pipeline = EXR_ENCODE_PIPELINE_INITIALIZER;
    exr_result_t code = EXR_ERR_SUCCESS;
    int started = 0;
    for (int y = 0; y < p->image->height && code == EXR_ERR_SUCCESS;) {
        exr_chunk_info_t chunk;
        code = exr_write_scanline_chunk_info(context, 0, y, &chunk);
        if (code == EXR_ERR_SUCCESS)
            code = started ? exr_encoding_update(context, 0, &chunk, &pipeline)
                           : exr_encoding_initialize(context, 0, &chunk, &pipeline);
        if (code != EXR_ERR_SUCCESS)
            break;
        aim(pipeline.channels, pipeline.channel_count, p, y);
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

static exr_result_t write_premultiplied(adcgs_buffer *out, const picture *p, const char *path)
{
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = ignore_message;
    setup.user_data = out;
    setup.write_fn = write_at;
    exr_context_t context;
    exr_result_t code = exr_start_write(&context, path, EXR_WRITE_FILE_DIRECTLY, &setup);
    if (code != EXR_ERR_SUCCESS)
        return code;
    code = describe(context, p);
    if (code == EXR_ERR_SUCCESS)
        code = write_chunks(context, p);
    const exr_result_t end = exr_finish(&context);
    return code == EXR_ERR_SUCCESS ? end : code;
}

/**
 * Convert to EXR's form, with colours multiplied by alpha. The transfer curve comes first, since it holds for straight colours.
 */
static void make_stored(adcgs_image *image, const adcgs_image_options *options)
{
    if (options->linear) {
        if (options->premultiplied)
            adcgs_image_unpremultiply(image);
        adcgs_image_to_linear(image);
    }
    adcgs_image_premultiply(image);
}

adcgs_status adcgs_exr_encode(adcgs_buffer *out, const adcgs_image *image, const adcgs_image_options *options, const char *path,
                              adcgs_error *error)
{
    adcgs_image copy = *image;
    if (options->linear || (image->channels % 2 == 0 && !options->premultiplied)) {
        ADCGS_TRY(adcgs_image_copy(&copy, image, path, error));
        make_stored(&copy, options);
    }
    picture p = {.image = &copy, .options = options};
    list_planes(&p);
    const exr_result_t code = write_premultiplied(out, &p, path);
    if (copy.data != image->data)
        adcgs_image_free(&copy);
    if (code == EXR_ERR_OUT_OF_MEMORY || out->failed)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    if (code != EXR_ERR_SUCCESS)
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot write EXR: %s", path, exr_get_default_error_message(code));
    return ADCGS_OK;
}

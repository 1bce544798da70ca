/* SPDX-License-Identifier: BSD-2-Clause */
/** \file PNG by libspng. */
#include "config.h"

#include "media/image/png.h"

#include <math.h>
#include <stdlib.h>

#include <spng.h>

/* Origin: chosen by hand, not measured, except for the comparison at LEVEL, on images that are not recorded. */
#define LEVEL 4               /* zlib's level; with one filter it takes a quarter of the defaults' time for 10 % more bytes */
#define CHUNK_MAX (64u << 20) /* bytes of a chunk without pixels, and of all that are kept */

/* ---- Errors ---- */

static adcgs_status read_failure(int code, const char *path, adcgs_error *error)
{
    switch (code) {
    case SPNG_EMEM:
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    case SPNG_IO_ERROR:
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot read", path);
    case SPNG_IO_EOF:
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: damaged image: the file ends early, expected PNG's chunk IEND", path);
    default:
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: damaged image: PNG: %s", path, spng_strerror(code));
    }
}

/* ---- Reading ---- */

/** Layout of a file, and the format to decode it to. */
typedef struct layout {
    int width, height, channels;
    int wide;   /**< samples have 16 bits */
    int linear; /**< linear light, not sRGB's curve */
    int interlaced;
    int format; /**< libspng's */
} layout;

static const struct {
    int narrow, wide; /* formats for up to 8 bits, and for 16 */
} formats[4] = {
    /* by channels */
    {SPNG_FMT_G8, SPNG_FMT_PNG},
    {SPNG_FMT_GA8, SPNG_FMT_GA16},
    {SPNG_FMT_RGB8, SPNG_FMT_PNG},
    {SPNG_FMT_RGBA8, SPNG_FMT_RGBA16},
};

/** libspng decodes grey with a transparent level to grey with alpha. Images stored with alpha are decoded in their own format. */
static void choose_format(layout *l, const struct spng_ihdr *head, int has_transparent)
{
    const int stored_alpha = head->color_type & 4, colour = head->color_type & 2;
    l->wide = head->bit_depth == 16;
    l->channels = (colour ? 3 : 1) + (stored_alpha || has_transparent);
    l->format = l->wide ? formats[l->channels - 1].wide : formats[l->channels - 1].narrow;
    if (stored_alpha)
        l->format = SPNG_FMT_PNG;
}

/** True for linear light: only if gAMA alone declares it. Other exponents are treated as sRGB. */
static int is_linear(spng_ctx *png)
{
    uint8_t intent;
    double gamma;
    return spng_get_srgb(png, &intent) && !spng_get_gama(png, &gamma) && fabs(gamma - 1.0) < 0.005;
}

static adcgs_status read_layout(spng_ctx *png, FILE *file, layout *out, const char *path, adcgs_error *error)
{
    struct spng_ihdr head;
    struct spng_trns transparent;
    int code = spng_set_crc_action(png, SPNG_CRC_ERROR, SPNG_CRC_ERROR);
    if (!code)
        code = spng_set_chunk_limits(png, CHUNK_MAX, CHUNK_MAX);
    if (!code)
        code = spng_set_png_file(png, file);
    if (!code)
        code = spng_get_ihdr(png, &head);
    if (code)
        return read_failure(code, path, error);
    if (head.width > ADCGS_IMAGE_MAX || head.height > ADCGS_IMAGE_MAX)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %ux%u pixels, expected 1x1 to %dx%d", path, head.width, head.height,
                          ADCGS_IMAGE_MAX, ADCGS_IMAGE_MAX);
    code = spng_get_trns(png, &transparent);
    if (code && code != SPNG_ECHUNKAVAIL)
        return read_failure(code, path, error);
    choose_format(out, &head, !code);
    out->width = (int)head.width;
    out->height = (int)head.height;
    out->linear = is_linear(png);
    out->interlaced = head.interlace_method != 0;
    return ADCGS_OK;
}

/** Convert stored samples to values of 0 to 1. */
static void convert(const uint8_t *samples, int wide, size_t n, float *out)
{
    for (size_t i = 0; i < n; i++) {
        uint16_t sample = samples[i];
        if (wide)
            memcpy(&sample, samples + 2 * i, sizeof sample);
        out[i] = (float)sample / (wide ? 65535.0f : 255.0f);
    }
}

static adcgs_status read_pixels(spng_ctx *png, FILE *file, const layout *l, adcgs_image *out, const char *path,
                                adcgs_error *error)
{
    size_t bytes;
    const size_t values = (size_t)l->width * (size_t)l->height * (size_t)l->channels;
    int code = spng_decoded_image_size(png, l->format, &bytes);
    if (!code && bytes != values << l->wide)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: damaged image: PNG of %zu bytes of pixels, expected %zu", path, bytes,
                          values << l->wide);
    uint8_t *samples = code ? NULL : malloc(bytes);
    if (!code && !samples)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %dx%d pixels", path, l->width, l->height);
    if (!code)
        code = spng_decode_image(png, samples, bytes, l->format, SPNG_DECODE_TRNS);
    if (!code)
        code = spng_decode_chunks(png); /* chunks after the pixels, so that the whole file is checked */
    if (!code && feof(file))
        code = SPNG_IO_EOF; /* libspng ignores an end within the checksum of IEND */
    if (!code)
        convert(samples, l->wide, values, out->data);
    free(samples);
    return code ? read_failure(code, path, error) : ADCGS_OK;
}

static adcgs_status open_decoder(spng_ctx **png, const char *path, adcgs_error *error)
{
    *png = spng_ctx_new(0);
    return *png ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
}

adcgs_status adcgs_png_probe(FILE *file, int *width, int *height, int *channels, const char *path, adcgs_error *error)
{
    spng_ctx *png;
    layout l = {0};
    ADCGS_TRY(open_decoder(&png, path, error));
    const adcgs_status status = read_layout(png, file, &l, path, error);
    spng_ctx_free(png);
    *width = l.width;
    *height = l.height;
    *channels = l.channels;
    return status;
}

struct adcgs_png_rows {
    spng_ctx *png;
    FILE *file;
    layout l;
    uint8_t *samples; /**< of a row */
    int at;           /**< index of the next row */
};

static adcgs_status start_rows(adcgs_png_rows *r, const char *path, adcgs_error *error)
{
    size_t bytes;
    const size_t values = (size_t)r->l.width * (size_t)r->l.channels;
    int code = spng_decoded_image_size(r->png, r->l.format, &bytes);
    if (!code && bytes != (values << r->l.wide) * (size_t)r->l.height)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: damaged image: PNG of %zu bytes of pixels, expected %zu", path, bytes,
                          (values << r->l.wide) * (size_t)r->l.height);
    r->samples = malloc(values << r->l.wide);
    if (!r->samples)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %d pixels", path, r->l.width);
    if (!code)
        code = spng_decode_image(r->png, NULL, 0, r->l.format, SPNG_DECODE_TRNS | SPNG_DECODE_PROGRESSIVE);
    return code ? read_failure(code, path, error) : ADCGS_OK;
}

adcgs_status adcgs_png_rows_open(adcgs_png_rows **out, FILE *file, int *width, int *height, int *channels, const char *path,
                                 adcgs_error *error)
{
    adcgs_png_rows *r = *out = calloc(1, sizeof *r);
    if (!r)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    r->file = file;
    adcgs_status status = open_decoder(&r->png, path, error);
    if (status == ADCGS_OK)
        status = read_layout(r->png, file, &r->l, path, error);
    if (status == ADCGS_OK && !r->l.interlaced)
        status = start_rows(r, path, error);
    *width = r->l.width;
    *height = r->l.height;
    *channels = r->l.channels;
    if (status == ADCGS_OK && !r->l.interlaced)
        return ADCGS_OK;
    adcgs_png_rows_close(out);
    rewind(file);
    return status;
}

adcgs_status adcgs_png_rows_next(adcgs_png_rows *r, float *row, const char *path, adcgs_error *error)
{
    adcgs_image line = {r->l.width, 1, r->l.channels, row};
    const size_t values = (size_t)r->l.width * (size_t)r->l.channels;
    const int last = ++r->at == r->l.height;
    int code = spng_decode_row(r->png, r->samples, values << r->l.wide);
    if (code == SPNG_EOI && last)
        code = spng_decode_chunks(r->png); /* chunks after the pixels, so that the whole file is checked */
    if (!code && last && feof(r->file))
        code = SPNG_IO_EOF; /* libspng ignores an end within the checksum of IEND */
    if (code)
        return read_failure(code, path, error);
    convert(r->samples, r->l.wide, values, row);
    if (r->l.linear)
        adcgs_image_to_srgb(&line);
    return ADCGS_OK;
}

void adcgs_png_rows_close(adcgs_png_rows **rows)
{
    adcgs_png_rows *const r = *rows;
    if (r) {
        spng_ctx_free(r->png);
        free(r->samples);
    }
    free(r);
    *rows = NULL;
}

/** Decode an interlaced image as a whole. */
static adcgs_status read_interlaced(FILE *file, adcgs_image *out, const char *path, adcgs_error *error)
{
    spng_ctx *png;
    layout l;
    *out = (adcgs_image){0};
    ADCGS_TRY(open_decoder(&png, path, error));
    adcgs_status status = read_layout(png, file, &l, path, error);
    if (status == ADCGS_OK)
        status = adcgs_image_alloc(out, l.width, l.height, l.channels, path, error);
    if (status == ADCGS_OK)
        status = read_pixels(png, file, &l, out, path, error);
    spng_ctx_free(png);
    if (status != ADCGS_OK)
        adcgs_image_free(out);
    else if (l.linear)
        adcgs_image_to_srgb(out);
    return status;
}

adcgs_status adcgs_png_read(FILE *file, adcgs_image *out, const char *path, adcgs_error *error)
{
    adcgs_png_rows *rows;
    int width, height, channels;
    *out = (adcgs_image){0};
    ADCGS_TRY(adcgs_png_rows_open(&rows, file, &width, &height, &channels, path, error));
    if (!rows)
        return read_interlaced(file, out, path, error);
    adcgs_status status = adcgs_image_alloc(out, width, height, channels, path, error);
    for (int y = 0; y < height && status == ADCGS_OK; y++)
        status = adcgs_png_rows_next(rows, out->data + (size_t)y * (size_t)width * (size_t)channels, path, error);
    adcgs_png_rows_close(&rows);
    if (status != ADCGS_OK)
        adcgs_image_free(out);
    return status;
}

/* ---- Writing ---- */

static int append(spng_ctx *png, void *user, void *bytes, size_t n)
{
    adcgs_buffer *out = user;
    adcgs_write_bytes(out, bytes, n);
    return out->failed ? SPNG_IO_ERROR : 0;
}

/** Set size, compression and sRGB; gAMA and cHRM repeat it, as the format recommends. */
static int describe(spng_ctx *png, const adcgs_image *image, int bits)
{
    static const uint8_t types[4] = {SPNG_COLOR_TYPE_GRAYSCALE, SPNG_COLOR_TYPE_GRAYSCALE_ALPHA, SPNG_COLOR_TYPE_TRUECOLOR,
                                     SPNG_COLOR_TYPE_TRUECOLOR_ALPHA};
    struct spng_ihdr head = {.width = (uint32_t)image->width,
                             .height = (uint32_t)image->height,
                             .bit_depth = (uint8_t)bits,
                             .color_type = types[image->channels - 1]};
    struct spng_chrm_int primaries = {31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000};
    int code = spng_set_ihdr(png, &head);
    code = code ? code : spng_set_option(png, SPNG_IMG_COMPRESSION_LEVEL, LEVEL);
    code = code ? code : spng_set_option(png, SPNG_FILTER_CHOICE, SPNG_FILTER_CHOICE_PAETH);
    code = code ? code : spng_set_srgb(png, 3);
    code = code ? code : spng_set_gama_int(png, 45455);
    return code ? code : spng_set_chrm_int(png, &primaries);
}

static int encode_rows(spng_ctx *png, const adcgs_image *image, int bits, void *row)
{
    const size_t values = (size_t)image->width * (size_t)image->channels;
    int code = spng_encode_image(png, NULL, 0, SPNG_FMT_PNG, SPNG_ENCODE_PROGRESSIVE | SPNG_ENCODE_FINALIZE);
    for (int y = 0; y < image->height && !code; y++) {
        const float *line = image->data + (size_t)y * values;
        if (bits == 16)
            adcgs_image_to_u16(line, values, row);
        else
            adcgs_image_to_u8(line, values, row);
        code = spng_encode_row(png, row, values * (size_t)bits / 8);
    }
    return code == SPNG_EOI ? 0 : code ? code : SPNG_ENOTFINAL;
}

adcgs_status adcgs_png_encode(adcgs_buffer *out, const adcgs_image *image, const adcgs_image_options *options, const char *path,
                              adcgs_error *error)
{
    spng_ctx *png = spng_ctx_new(SPNG_CTX_ENCODER);
    uint16_t *row = malloc((size_t)image->width * (size_t)image->channels * sizeof *row);
    int code = png && row ? spng_set_png_stream(png, append, out) : SPNG_EMEM;
    code = code ? code : describe(png, image, options->bits);
    code = code ? code : encode_rows(png, image, options->bits, row);
    spng_ctx_free(png);
    free(row);
    if (code == SPNG_EMEM || out->failed)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    return code ? adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot write PNG: %s", path, spng_strerror(code)) : ADCGS_OK;
}

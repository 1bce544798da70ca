/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * JPEG by libjpeg-turbo. The end of a file is checked here, since the library
 * accepts truncated files.
 */
#include "config.h"

#include "media/image/jpeg.h"

#include "system/extension.h"
#include "system/file.h"

#include <stdlib.h>

#include <turbojpeg.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define QUALITY 95                   /* of libjpeg's scale, 1 to 100, where the caller gives none */
#define FILE_MAX ((uint64_t)1 << 30) /* bytes of a file that is read */

/* ---- Markers ---- */

/* Bytes of markers: MARKER, then one of the others; definition (ITU-T T.81, B.1.1 and Table B.1). */
enum {
    STUFFED = 0x00,
    TEM = 0x01,
    SOF0 = 0xc0,
    DHT = 0xc4,
    JPG = 0xc8,
    DAC = 0xcc,
    SOF15 = 0xcf,
    RST0 = 0xd0,
    RST7 = 0xd7,
    SOI = 0xd8,
    EOI = 0xd9,
    MARKER = 0xff
};

/** The next marker that matters here. Skips coded data and bytes between segments. */
static int next_marker(FILE *file)
{
    for (int c = getc(file); c != EOF; c = getc(file)) {
        if (c != MARKER)
            continue;
        while (c == MARKER)
            c = getc(file);
        if (c != STUFFED && c != TEM && !(c >= RST0 && c <= RST7) && c != SOI)
            return c;
    }
    return EOF;
}

static int is_frame(int marker)
{
    return marker >= SOF0 && marker <= SOF15 && marker != DHT && marker != JPG && marker != DAC;
}

static int read_u16(FILE *file)
{
    const int high = getc(file), low = getc(file);
    return low == EOF ? 0 : high << 8 | low;
}

/** Skip to the end of the image or, with to_frame, to its frame header, whose length has then been read. */
static adcgs_status walk(FILE *file, int to_frame, const char *path, adcgs_error *error)
{
    for (int marker = next_marker(file); marker != EOI; marker = next_marker(file)) {
        const int bytes = marker == EOF ? 0 : read_u16(file); /* including these two bytes */
        if (to_frame && is_frame(marker) && bytes >= 8)
            return ADCGS_OK;
        if (bytes < 2 || fseek(file, bytes - 2, SEEK_CUR))
            return adcgs_fail(error, ADCGS_ERR_DATA, "%s: damaged image: the file ends early, expected JPEG's marker EOI", path);
    }
    return to_frame ? adcgs_fail(error, ADCGS_ERR_DATA, "%s: damaged image: JPEG without a frame", path) : ADCGS_OK;
}

adcgs_status adcgs_jpeg_probe(FILE *file, int *width, int *height, int *channels, const char *path, adcgs_error *error)
{
    ADCGS_TRY(walk(file, 1, path, error));
    getc(file); /* bits of a sample */
    *height = read_u16(file);
    *width = read_u16(file);
    *channels = getc(file) == 1 ? 1 : 3;
    return ADCGS_OK;
}

/* ---- Reading ---- */

/** Convert CMYK as Adobe stores it, 255 for no ink, by multiplying with black. In place, from four to three bytes a pixel. */
static void ink_to_rgb(uint8_t *bytes, size_t pixels)
{
    for (size_t i = 0; i < pixels; i++)
        for (size_t c = 0; c < 3; c++)
            bytes[3 * i + c] = (uint8_t)((bytes[4 * i + c] * bytes[4 * i + 3] + 127) / 255);
}

/** True for a warning without loss of data: bytes between segments, which some cameras leave there. */
static int is_harmless(tjhandle decoder)
{
    return tjGetErrorCode(decoder) == TJERR_WARNING && strstr(tjGetErrorStr2(decoder), "extraneous bytes");
}

static adcgs_status refuse(tjhandle decoder, const char *path, adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_DATA, "%s: damaged image: JPEG: %.120s", path, tjGetErrorStr2(decoder));
}

static adcgs_status decode(tjhandle decoder, const uint8_t *data, size_t size, adcgs_image *out, const char *path,
                           adcgs_error *error)
{
    int width, height, sampling, space;
    if (tjDecompressHeader3(decoder, data, (unsigned long)size, &width, &height, &sampling, &space))
        return refuse(decoder, path, error);
    const int ink = space == TJCS_CMYK || space == TJCS_YCCK, stored = ink ? 4 : space == TJCS_GRAY ? 1 : 3;
    ADCGS_TRY(adcgs_image_alloc(out, width, height, ADCGS_MIN(stored, 3), path, error));
    const size_t pixels = (size_t)width * (size_t)height, values = pixels * (size_t)out->channels;
    uint8_t *bytes = malloc(pixels * (size_t)stored);
    if (!bytes)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %dx%d pixels", path, width, height);
    const int format = ink ? TJPF_CMYK : stored == 1 ? TJPF_GRAY : TJPF_RGB;
    adcgs_status status = ADCGS_OK;
    if (tjDecompress2(decoder, data, (unsigned long)size, bytes, width, 0, height, format, TJFLAG_ACCURATEDCT) &&
        !is_harmless(decoder))
        status = refuse(decoder, path, error);
    if (ink)
        ink_to_rgb(bytes, pixels);
    for (size_t i = 0; i < values; i++)
        out->data[i] = (float)bytes[i] / 255.0f;
    free(bytes);
    return status;
}

adcgs_status adcgs_jpeg_read(FILE *file, adcgs_image *out, const char *path, adcgs_error *error)
{
    uint8_t *data;
    size_t size;
    *out = (adcgs_image){0};
    ADCGS_TRY(walk(file, 0, path, error));
    rewind(file);
    ADCGS_TRY(adcgs_file_load_open(&data, &size, file, path, FILE_MAX, error));
    tjhandle decoder = tjInitDecompress();
    const adcgs_status status =
        decoder ? decode(decoder, data, size, out, path, error) : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    if (decoder)
        tjDestroy(decoder);
    free(data);
    if (status != ADCGS_OK)
        adcgs_image_free(out);
    return status;
}

/* ---- Writing ---- */

static adcgs_status encode(adcgs_buffer *out, tjhandle encoder, const adcgs_image *image, const uint8_t *bytes, int quality,
                           const char *path, adcgs_error *error)
{
    unsigned char *data = NULL;
    unsigned long size = 0;
    const int grey = image->channels == 1, chroma = quality ? TJSAMP_420 : TJSAMP_444;
    const int code = tjCompress2(encoder, bytes, image->width, 0, image->height, grey ? TJPF_GRAY : TJPF_RGB, &data, &size,
                                 grey ? TJSAMP_GRAY : chroma, quality ? quality : QUALITY, TJFLAG_ACCURATEDCT);
    if (!code)
        adcgs_write_bytes(out, data, size);
    tjFree(data);
    return code ? adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot write JPEG: %.120s", path, tjGetErrorStr2(encoder)) : ADCGS_OK;
}

adcgs_status adcgs_jpeg_encode(adcgs_buffer *out, const adcgs_image *image, const adcgs_image_options *options, const char *path,
                               adcgs_error *error)
{
    if (options->bits != 8)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: .%s files hold no samples of %d bits", path, adcgs_extension(path),
                          options->bits);
    if (image->channels % 2 == 0)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: .%s files hold no alpha; EXR, PNG and TIFF do", path,
                          adcgs_extension(path));
    const size_t values = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    uint8_t *bytes = malloc(values);
    tjhandle encoder = tjInitCompress();
    adcgs_status status = ADCGS_OK;
    if (bytes && encoder) {
        adcgs_image_to_u8(image->data, values, bytes);
        status = encode(out, encoder, image, bytes, options->quality, path, error);
    } else
        status = adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    if (encoder)
        tjDestroy(encoder);
    free(bytes);
    return status;
}

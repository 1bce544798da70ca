/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Images: the table of formats with their readers and writers. */
#include "config.h"

#include "media/image/image.h"

#include "bits/bytes.h"
#include "media/image/netpbm.h"
#include "media/kind.h"
#include "system/atomic.h"
#include "system/extension.h"
#include "system/file.h"
#ifdef HAVE_ENCODER
#include "media/image/exr.h"
#include "media/image/jpeg.h"
#include "media/image/oiio_shim.h"
#include "media/image/photo.h"
#include "media/image/png.h"
#endif

#include <errno.h>
#include <stdlib.h>
#include <strings.h>

typedef adcgs_status prober(FILE *file, int *width, int *height, int *channels, const char *path, adcgs_error *error);
typedef adcgs_status reader(FILE *file, adcgs_image *out, const char *path, adcgs_error *error);
typedef adcgs_status encoder(adcgs_buffer *out, const adcgs_image *image, const adcgs_image_options *options, const char *path,
                             adcgs_error *error);

/** A format. Reading detects it by the first bytes, writing by the extension. */
typedef struct format {
    const char *magic[2]; /* NULL: not this one */
    const char *extensions[6];
    prober *probe; /* NULL: OpenImageIO reads it */
    reader *read;
    encoder *encode;
} format;

/* ---- OpenImageIO, if the build has it ---- */

#ifdef HAVE_ENCODER
static adcgs_status probe_foreign(FILE *file, const char *named, int *width, int *height, int *channels, const char *path,
                                  adcgs_error *error)
{
    const adcgs_oiio *oiio;
    ADCGS_TRY(adcgs_oiio_get(&oiio, path, error));
    return oiio->probe(width, height, channels, file, named, path, error);
}

static adcgs_status read_foreign(FILE *file, const char *named, adcgs_image *out, const char *path, adcgs_error *error)
{
    const adcgs_oiio *oiio;
    ADCGS_TRY(adcgs_oiio_get(&oiio, path, error));
    return oiio->read(out, file, named, path, error);
}

static adcgs_status encode_foreign(adcgs_buffer *out, const adcgs_image *image, const adcgs_image_options *options,
                                   const char *path, adcgs_error *error)
{
    const adcgs_oiio *oiio;
    uint8_t *data;
    size_t bytes;
    ADCGS_TRY(adcgs_oiio_get(&oiio, path, error));
    ADCGS_TRY(oiio->encode(&data, &bytes, image, options->bits, options->format ? options->format : adcgs_extension(path), path,
                           error));
    adcgs_write_bytes(out, data, bytes);
    free(data);
    return ADCGS_OK;
}
#else
static adcgs_status probe_foreign(FILE *file, const char *named, int *width, int *height, int *channels, const char *path,
                                  adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: this build reads binary PGM and PPM only", path);
}

static adcgs_status read_foreign(FILE *file, const char *named, adcgs_image *out, const char *path, adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: this build reads binary PGM and PPM only", path);
}

static adcgs_status encode_foreign(adcgs_buffer *out, const adcgs_image *image, const adcgs_image_options *options,
                                   const char *path, adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: this build writes images as PPM and PGM only", path);
}
#endif

/* ---- The table ---- */

static const format formats[] = {
    {{"P5", "P6"}, {"ppm", "pgm"}, adcgs_netpbm_probe, adcgs_netpbm_read, adcgs_netpbm_encode},
#ifdef HAVE_ENCODER
    {{"\x89PNG\r\n\x1a\n"}, {"png"}, adcgs_png_probe, adcgs_png_read, adcgs_png_encode},
    {{"\xff\xd8\xff"}, {"jpg", "jpeg", "jpe", "jfif", "jif", "jfi"}, adcgs_jpeg_probe, adcgs_jpeg_read, adcgs_jpeg_encode},
    {{NULL}, {"exr"}, NULL, NULL, adcgs_exr_encode},
#endif
};
static const format foreign = {{NULL}, {NULL}, NULL, NULL, encode_foreign};

/** NULL: no format of ours. */
static const format *find_reader(const uint8_t *begin, size_t n)
{
    for (size_t i = 0; i < ADCGS_COUNTOF(formats); i++)
        for (size_t k = 0; k < ADCGS_COUNTOF(formats[i].magic); k++) {
            const char *magic = formats[i].magic[k];
            if (magic && n >= strlen(magic) && !memcmp(begin, magic, strlen(magic)))
                return &formats[i];
        }
    return NULL;
}

static const format *find_writer(const char *extension)
{
    for (size_t i = 0; i < ADCGS_COUNTOF(formats); i++)
        for (size_t k = 0; k < ADCGS_COUNTOF(formats[i].extensions); k++)
            if (formats[i].extensions[k] && !strcasecmp(extension, formats[i].extensions[k]))
                return &formats[i];
    return &foreign;
}

static int is_exr(const char *extension)
{
    return !strcasecmp(extension, "exr");
}

/* ---- Reading ---- */

/** An open image and its reader: one of our formats, or a named reader of OpenImageIO. */
typedef struct source {
    FILE *file;
    const format *own; /**< NULL: OpenImageIO's */
    const char *reader;
} source;

static uint32_t load_size(const uint8_t *at, size_t bytes)
{
    return bytes == 2 ? (uint32_t)(at[0] | at[1] << 8) : adcgs_load_le32(at);
}

/** Check the size before reading: OpenImageIO's GIF and BMP readers allocate all pixels before they report it. */
static adcgs_status check_early(const char *named, const uint8_t *begin, size_t n, const char *path, adcgs_error *error)
{
    const int is_gif = !strcmp(named, "gif"), is_bmp = !strcmp(named, "bmp");
    const size_t bytes = is_gif || (n >= 26 && adcgs_load_le32(begin + 14) == 12) ? 2 : 4, at = is_gif ? 6 : 18;
    if ((!is_gif && !is_bmp) || n < at + 2 * bytes)
        return ADCGS_OK;
    const uint32_t width = load_size(begin + at, bytes), height = load_size(begin + at + bytes, bytes);
    const uint32_t rows = bytes == 4 && height > 0x7fffffffu ? 0u - height : height; /* negative height: rows from top to
                                                                                        bottom */
    if (width >= 1 && rows >= 1 && width <= ADCGS_IMAGE_MAX && rows <= ADCGS_IMAGE_MAX)
        return ADCGS_OK;
    return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %ux%u pixels, expected 1x1 to %dx%d", path, width, rows, ADCGS_IMAGE_MAX,
                      ADCGS_IMAGE_MAX);
}

/** Choose the reader by the first bytes. A file that is no image of a supported kind is refused with its kind. */
static adcgs_status find_source(source *s, const uint8_t *begin, size_t n, const char *path, adcgs_error *error)
{
    s->own = find_reader(begin, n);
#ifndef HAVE_ENCODER
    if (!s->own)
        return probe_foreign(s->file, NULL, NULL, NULL, NULL, path, error);
#endif
    const adcgs_kind *const kind = adcgs_kind_of(begin, n, 0, NULL, path);
    s->reader = kind->reader;
    if (!s->own && !s->reader)
        return adcgs_kind_refuse(kind, path, ADCGS_WANT_IMAGE, error);
    return s->own ? ADCGS_OK : check_early(s->reader, begin, n, path, error);
}

static adcgs_status open_image(source *s, const char *path, adcgs_error *error)
{
    uint8_t begin[ADCGS_KIND_BYTES];
    ADCGS_TRY(adcgs_file_open(&s->file, path, error));
    errno = 0;
    const size_t n = fread(begin, 1, sizeof begin, s->file);
    adcgs_status status;
    if (n < 2 || fseek(s->file, 0, SEEK_SET))
        status = errno ? adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot read: %s", path, strerror(errno))
                       : adcgs_fail(error, ADCGS_ERR_DATA, "%s: too short for an image", path);
    else
        status = find_source(s, begin, n, path, error);
    if (status != ADCGS_OK)
        fclose(s->file);
    return status;
}

adcgs_status adcgs_image_read(adcgs_image *out, const char *path, adcgs_error *error)
{
    source s;
    *out = (adcgs_image){0};
    ADCGS_TRY(open_image(&s, path, error));
    const adcgs_status status = s.own ? s.own->read(s.file, out, path, error) : read_foreign(s.file, s.reader, out, path, error);
    fclose(s.file);
    return status;
}

adcgs_status adcgs_image_probe(int *width, int *height, int *channels, const char *path, adcgs_error *error)
{
    source s;
    ADCGS_TRY(open_image(&s, path, error));
    adcgs_status status = s.own ? s.own->probe(s.file, width, height, channels, path, error)
                                : probe_foreign(s.file, s.reader, width, height, channels, path, error);
    fclose(s.file);
    if (status == ADCGS_OK && (*width < 1 || *height < 1 || *width > ADCGS_IMAGE_MAX || *height > ADCGS_IMAGE_MAX))
        status = adcgs_fail(error, ADCGS_ERR_DATA, "%s: %dx%d pixels, expected at most %dx%d", path, *width, *height,
                            ADCGS_IMAGE_MAX, ADCGS_IMAGE_MAX);
    return status;
}

/* ---- Reading by rows ---- */

struct adcgs_image_rows {
    source from;
    adcgs_image whole; /**< for formats without reading by rows */
    size_t row, at;    /**< values per row; values of `whole` that have been read */
#ifdef HAVE_ENCODER
    adcgs_png_rows *png;
#endif
};

static adcgs_status start_rows(adcgs_image_rows *r, int *width, int *height, int *channels, const char *path, adcgs_error *error)
{
    const source *s = &r->from;
#ifdef HAVE_ENCODER
    if (s->own && s->own->read == adcgs_png_read)
        ADCGS_TRY(adcgs_png_rows_open(&r->png, s->file, width, height, channels, path, error));
    if (r->png)
        return ADCGS_OK;
#endif
    ADCGS_TRY(s->own ? s->own->read(s->file, &r->whole, path, error) : read_foreign(s->file, s->reader, &r->whole, path, error));
    *width = r->whole.width;
    *height = r->whole.height;
    *channels = r->whole.channels;
    return ADCGS_OK;
}

adcgs_status adcgs_image_rows_open(adcgs_image_rows **out, int *width, int *height, int *channels, const char *path,
                                   adcgs_error *error)
{
    adcgs_image_rows *r = *out = calloc(1, sizeof *r);
    if (!r)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    adcgs_status status = open_image(&r->from, path, error);
    if (status != ADCGS_OK)
        r->from.file = NULL;
    else
        status = start_rows(r, width, height, channels, path, error);
    if (status != ADCGS_OK)
        adcgs_image_rows_close(out);
    else
        r->row = (size_t)*width * (size_t)*channels;
    return status;
}

adcgs_status adcgs_image_rows_read(adcgs_image_rows *r, int n, float *to, const char *path, adcgs_error *error)
{
#ifdef HAVE_ENCODER
    for (int i = 0; r->png && i < n; i++)
        ADCGS_TRY(adcgs_png_rows_next(r->png, to + (size_t)i * r->row, path, error));
    if (r->png)
        return ADCGS_OK;
#endif
    memcpy(to, r->whole.data + r->at, (size_t)n * r->row * sizeof *to);
    r->at += (size_t)n * r->row;
    return ADCGS_OK;
}

void adcgs_image_rows_close(adcgs_image_rows **rows)
{
    adcgs_image_rows *const r = *rows;
    if (r) {
#ifdef HAVE_ENCODER
        adcgs_png_rows_close(&r->png);
#endif
        adcgs_image_free(&r->whole);
        if (r->from.file)
            fclose(r->from.file);
    }
    free(r);
    *rows = NULL;
}

#ifdef HAVE_ENCODER
adcgs_status adcgs_image_tell(adcgs_photo *photo, const char *path, adcgs_error *error)
{
    const adcgs_oiio *oiio;
    source s;
    ADCGS_TRY(open_image(&s, path, error));
    adcgs_status status = adcgs_oiio_get(&oiio, path, error);
    if (status == ADCGS_OK)
        status = oiio->tell(photo, s.file, s.reader, path, error);
    fclose(s.file);
    return status;
}
#endif

/* ---- Writing ---- */

/** Check the options against our formats; OpenImageIO checks its own formats. */
static adcgs_status check_options(const adcgs_image_options *options, const char *path, const char *extension, adcgs_error *error)
{
    if (!*extension)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: the file name needs an extension that gives the format", path);
    if (options->bits != 0 && options->bits != 8 && options->bits != 16)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: %d bits, expected 8 or 16", path, options->bits);
    if (options->depth && !is_exr(extension))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: depth needs EXR", path);
    if (options->linear && !is_exr(extension))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: linear light needs EXR", path);
    return ADCGS_OK;
}

/** Encode the file in memory. Only EXR has premultiplied colours. */
static adcgs_status encode_image(adcgs_buffer *out, const adcgs_image *image, const adcgs_image_options *options,
                                 const char *path, const char *extension, adcgs_error *error)
{
    adcgs_image_options set = *options;
    adcgs_image copy = *image;
    set.bits = set.bits ? set.bits : 8;
    if (set.premultiplied && !is_exr(extension)) {
        ADCGS_TRY(adcgs_image_copy(&copy, image, path, error));
        adcgs_image_unpremultiply(&copy);
        set.premultiplied = 0;
    }
    adcgs_status status = find_writer(extension)->encode(out, &copy, &set, path, error);
    if (copy.data != image->data)
        adcgs_image_free(&copy);
    if (status == ADCGS_OK && out->failed)
        status = adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    return status;
}

adcgs_status adcgs_image_write_as(const adcgs_image *image, const adcgs_image_options *options, const char *path,
                                  adcgs_error *error)
{
    const char *extension = options->format ? options->format : adcgs_extension(path);
    adcgs_buffer bytes;
    ADCGS_TRY(check_options(options, path, extension, error));
    adcgs_buffer_init(&bytes);
    adcgs_status status = encode_image(&bytes, image, options, path, extension, error);
    if (status == ADCGS_OK)
        status = adcgs_atomic_save(path, bytes.data, bytes.size, error);
    adcgs_buffer_clear(&bytes);
    return status;
}

adcgs_status adcgs_image_write(const adcgs_image *image, const char *path, int half, adcgs_error *error)
{
    const adcgs_image_options options = {.half = half};
    return adcgs_image_write_as(image, &options, path, error);
}

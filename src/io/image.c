/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Images: who reads and writes what. */
#include "config.h"

#include "io/image.h"

#include "io/atomic.h"
#include "io/extension.h"
#include "io/file.h"
#include "io/netpbm.h"
#ifdef HAVE_ENCODER
#include "io/exr.h"
#include "io/oiio_shim.h"
#include "io/whole.h"
#endif

#include <errno.h>
#include <strings.h>

static int is_exr(const char *extension)
{
    return !strcasecmp(extension, "exr");
}

/** Open for reading and tell by the first two bytes whether our own reader takes it. */
static adcgs_status open_image(FILE **file, int *own, const char *path, adcgs_error *error)
{
    uint8_t magic[2];
    ADCGS_TRY(adcgs_file_open(file, path, error));
    errno = 0;
    if (fread(magic, 1, 2, *file) < 2 || fseek(*file, 0, SEEK_SET)) {
        const int reason = errno;
        fclose(*file);
        return reason ? adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot read: %s", path, strerror(reason))
                      : adcgs_fail(error, ADCGS_ERR_DATA, "%s: too short for an image", path);
    }
    *own = magic[0] == 'P' && (magic[1] == '5' || magic[1] == '6');
    return ADCGS_OK;
}

#ifdef HAVE_ENCODER
static adcgs_status read_foreign(FILE *file, adcgs_image *out, const char *path, adcgs_error *error)
{
    const adcgs_oiio *oiio;
    ADCGS_TRY(adcgs_whole_check(file, 1, path, error));
    ADCGS_TRY(adcgs_oiio_get(&oiio, path, error));
    return oiio->read(out, path, error);
}

static adcgs_status probe_foreign(FILE *file, int *width, int *height, int *channels, const char *path, adcgs_error *error)
{
    const adcgs_oiio *oiio;
    ADCGS_TRY(adcgs_whole_check(file, 0, path, error));
    ADCGS_TRY(adcgs_oiio_get(&oiio, path, error));
    return oiio->probe(width, height, channels, path, error);
}

static adcgs_status write_foreign(adcgs_atomic *atomic, const adcgs_image *image, const adcgs_image_options *options,
                                  const char *path, const char *extension, adcgs_error *error)
{
    if (is_exr(extension))
        return adcgs_exr_write(atomic->file, image, options, path, error);
    const adcgs_oiio *oiio;
    ADCGS_TRY(adcgs_oiio_get(&oiio, path, error));
    return oiio->write(image, options->bits, adcgs_atomic_name(atomic), extension, path, error);
}
#else
static adcgs_status read_foreign(FILE *file, adcgs_image *out, const char *path, adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: this build reads binary PGM and PPM only", path);
}

static adcgs_status probe_foreign(FILE *file, int *width, int *height, int *channels, const char *path, adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: this build reads binary PGM and PPM only", path);
}

static adcgs_status write_foreign(adcgs_atomic *atomic, const adcgs_image *image, const adcgs_image_options *options,
                                  const char *path, const char *extension, adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: this build writes images as PPM and PGM only", path);
}
#endif

adcgs_status adcgs_image_read(adcgs_image *out, const char *path, adcgs_error *error)
{
    FILE *file;
    int own;
    *out = (adcgs_image){0};
    ADCGS_TRY(open_image(&file, &own, path, error));
    const adcgs_status status = own ? adcgs_netpbm_read(file, out, path, error) : read_foreign(file, out, path, error);
    fclose(file);
    return status;
}

adcgs_status adcgs_image_probe(int *width, int *height, int *channels, const char *path, adcgs_error *error)
{
    FILE *file;
    int own;
    ADCGS_TRY(open_image(&file, &own, path, error));
    adcgs_status status = own ? adcgs_netpbm_probe(file, width, height, channels, path, error)
                              : probe_foreign(file, width, height, channels, path, error);
    fclose(file);
    if (status == ADCGS_OK && (*width < 1 || *height < 1 || *width > ADCGS_IMAGE_MAX || *height > ADCGS_IMAGE_MAX))
        status = adcgs_fail(error, ADCGS_ERR_DATA, "%s: %dx%d pixels, expected at most %dx%d", path, *width, *height,
                            ADCGS_IMAGE_MAX, ADCGS_IMAGE_MAX);
    return status;
}

/** What the formats have is asked before a file is opened, except for OpenImageIO's. */
static adcgs_status check_options(const adcgs_image_options *options, const char *path, const char *extension,
                                  adcgs_error *error)
{
    if (!*extension)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: the name's extension must say the format", path);
    if (options->bits != 0 && options->bits != 8 && options->bits != 16)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: %d bits, expected 8 or 16", path, options->bits);
    if (options->depth && !is_exr(extension))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: depth needs EXR", path);
    if (options->linear && !is_exr(extension))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: linear light needs EXR", path);
    return ADCGS_OK;
}

/** Write what is opened; only EXR has premultiplied colours. */
static adcgs_status write_open(adcgs_atomic *atomic, const adcgs_image *image, const adcgs_image_options *options,
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
    const int own = !strcasecmp(extension, "ppm") || !strcasecmp(extension, "pgm");
    const adcgs_status status = own ? adcgs_netpbm_write(atomic->file, &copy, set.bits, path, error)
                                    : write_foreign(atomic, &copy, &set, path, extension, error);
    if (copy.data != image->data)
        adcgs_image_free(&copy);
    return status;
}

adcgs_status adcgs_image_write_as(const adcgs_image *image, const adcgs_image_options *options, const char *path,
                                  adcgs_error *error)
{
    const char *extension = adcgs_extension(path);
    adcgs_atomic atomic;
    ADCGS_TRY(check_options(options, path, extension, error));
    ADCGS_TRY(adcgs_atomic_open(&atomic, path, error));
    const adcgs_status status = write_open(&atomic, image, options, path, extension, error);
    if (status != ADCGS_OK) {
        adcgs_atomic_abort(&atomic);
        return status;
    }
    return adcgs_atomic_commit(&atomic, error);
}

adcgs_status adcgs_image_write(const adcgs_image *image, const char *path, int half, adcgs_error *error)
{
    const adcgs_image_options options = {.half = half};
    return adcgs_image_write_as(image, &options, path, error);
}

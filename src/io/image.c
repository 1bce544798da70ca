/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Images: memory, conversions, and who reads and writes what. */
#include "config.h"

#include "io/image.h"

#include "io/atomic.h"
#include "io/netpbm.h"
#ifdef HAVE_ENCODER
#include "io/exr.h"
#include "io/oiio_shim.h"
#endif

#include <errno.h>
#include <stdlib.h>
#include <strings.h>

adcgs_status adcgs_image_alloc(adcgs_image *image, int width, int height, int channels, const char *path, adcgs_error *error)
{
    *image = (adcgs_image){0};
    if (width < 1 || height < 1 || width > ADCGS_IMAGE_MAX || height > ADCGS_IMAGE_MAX)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %dx%d pixels, expected 1x1 to %dx%d", path, width, height, ADCGS_IMAGE_MAX,
                          ADCGS_IMAGE_MAX);
    if (channels < 1 || channels > 4)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %d channels, expected 1 to 4", path, channels);
    const size_t values = (size_t)width * (size_t)height * (size_t)channels;
    float *data = values > SIZE_MAX / sizeof *data ? NULL : malloc(values * sizeof *data);
    if (!data)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %dx%d pixels", path, width, height);
    *image = (adcgs_image){width, height, channels, data};
    return ADCGS_OK;
}

void adcgs_image_free(adcgs_image *image)
{
    free(image->data);
    *image = (adcgs_image){0};
}

void adcgs_image_to_u8(const float *values, size_t n, uint8_t *out)
{
    for (size_t i = 0; i < n; i++) {
        const float low = values[i] > 0.0f ? values[i] : 0.0f; /* not-a-number becomes 0 */
        const float clipped = low < 1.0f ? low : 1.0f;
        out[i] = (uint8_t)(clipped * 255.0f + 0.5f);
    }
}

static size_t pixels_with_alpha(const adcgs_image *image)
{
    return image->channels % 2 ? 0 : (size_t)image->width * (size_t)image->height;
}

void adcgs_image_premultiply(adcgs_image *image)
{
    const size_t n = pixels_with_alpha(image), channels = (size_t)image->channels;
    for (size_t i = 0; i < n; i++) {
        float *pixel = image->data + i * channels;
        for (size_t c = 0; c + 1 < channels; c++)
            pixel[c] *= pixel[channels - 1];
    }
}

void adcgs_image_unpremultiply(adcgs_image *image)
{
    const size_t n = pixels_with_alpha(image), channels = (size_t)image->channels;
    for (size_t i = 0; i < n; i++) {
        float *pixel = image->data + i * channels;
        for (size_t c = 0; c + 1 < channels; c++)
            if (pixel[channels - 1] > 0.0f)
                pixel[c] /= pixel[channels - 1];
    }
}

/** Open for reading and tell by the first two bytes whether our own reader takes it. */
static adcgs_status open_image(FILE **file, int *own, const char *path, adcgs_error *error)
{
    uint8_t magic[2];
    *file = fopen(path, "rb");
    if (!*file)
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot open: %s", path, strerror(errno));
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
static adcgs_status read_foreign(adcgs_image *out, const char *path, adcgs_error *error)
{
    return adcgs_oiio_read(out, path, error);
}

static adcgs_status probe_foreign(int *width, int *height, int *channels, const char *path, adcgs_error *error)
{
    return adcgs_oiio_probe(width, height, channels, path, error);
}

static adcgs_status write_foreign(adcgs_atomic *atomic, const adcgs_image *image, const char *path, const char *extension,
                                  int half, adcgs_error *error)
{
    if (!strcasecmp(extension, "exr"))
        return adcgs_exr_write(atomic->file, image, half, path, error);
    return adcgs_oiio_write(image, adcgs_atomic_name(atomic), extension, path, error);
}
#else
static adcgs_status read_foreign(adcgs_image *out, const char *path, adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: this build reads binary PGM and PPM only", path);
}

static adcgs_status probe_foreign(int *width, int *height, int *channels, const char *path, adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: this build reads binary PGM and PPM only", path);
}

static adcgs_status write_foreign(adcgs_atomic *atomic, const adcgs_image *image, const char *path, const char *extension,
                                  int half, adcgs_error *error)
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
    const adcgs_status status = own ? adcgs_netpbm_read(file, out, path, error) : read_foreign(out, path, error);
    fclose(file);
    return status;
}

adcgs_status adcgs_image_probe(int *width, int *height, int *channels, const char *path, adcgs_error *error)
{
    FILE *file;
    int own;
    ADCGS_TRY(open_image(&file, &own, path, error));
    adcgs_status status = own ? adcgs_netpbm_probe(file, width, height, channels, path, error)
                              : probe_foreign(width, height, channels, path, error);
    fclose(file);
    if (status == ADCGS_OK && (*width < 1 || *height < 1 || *width > ADCGS_IMAGE_MAX || *height > ADCGS_IMAGE_MAX))
        status = adcgs_fail(error, ADCGS_ERR_DATA, "%s: %dx%d pixels, expected at most %dx%d", path, *width, *height,
                            ADCGS_IMAGE_MAX, ADCGS_IMAGE_MAX);
    return status;
}

static const char *extension_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    const char *dot = strrchr(slash ? slash : path, '.');
    return dot ? dot + 1 : "";
}

adcgs_status adcgs_image_write(const adcgs_image *image, const char *path, int half, adcgs_error *error)
{
    const char *extension = extension_of(path);
    if (!*extension)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: the name's extension must say the format", path);
    adcgs_atomic atomic;
    ADCGS_TRY(adcgs_atomic_open(&atomic, path, error));
    const int own = !strcasecmp(extension, "ppm") || !strcasecmp(extension, "pgm");
    const adcgs_status status = own ? adcgs_netpbm_write(atomic.file, image, path, error)
                                    : write_foreign(&atomic, image, path, extension, half, error);
    if (status != ADCGS_OK) {
        adcgs_atomic_abort(&atomic);
        return status;
    }
    return adcgs_atomic_commit(&atomic, error);
}

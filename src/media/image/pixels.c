/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Pixels of an image: their memory, and conversions. */
#include "config.h"

#include "media/image/image.h"

#include <math.h>
#include <stdlib.h>

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

adcgs_status adcgs_image_copy(adcgs_image *copy, const adcgs_image *image, const char *path, adcgs_error *error)
{
    ADCGS_TRY(adcgs_image_alloc(copy, image->width, image->height, image->channels, path, error));
    memcpy(copy->data, image->data, (size_t)image->width * (size_t)image->height * (size_t)image->channels * sizeof *copy->data);
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
        const float low = values[i] > 0.0f ? values[i] : 0.0f; /* NaN becomes 0 */
        const float clipped = low < 1.0f ? low : 1.0f;
        out[i] = (uint8_t)(clipped * 255.0f + 0.5f);
    }
}

void adcgs_image_to_u16(const float *values, size_t n, uint16_t *out)
{
    for (size_t i = 0; i < n; i++) {
        const double low = values[i] > 0.0f ? (double)values[i] : 0.0; /* NaN becomes 0 */
        out[i] = (uint16_t)((low < 1.0 ? low : 1.0) * 65535.0 + 0.5);
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

static float to_srgb(float v)
{
    return v <= 0.0031308f ? 12.92f * v : 1.055f * powf(v, 1.0f / 2.4f) - 0.055f;
}

static float to_linear(float v)
{
    return v <= 0.04045f ? v / 12.92f : powf((v + 0.055f) / 1.055f, 2.4f);
}

static void bend(adcgs_image *image, float (*curve)(float))
{
    const size_t n = (size_t)image->channels, colours = n % 2 ? n : n - 1;
    for (size_t i = 0; i < (size_t)image->width * (size_t)image->height; i++)
        for (size_t c = 0; c < colours; c++)
            image->data[i * n + c] = curve(image->data[i * n + c]);
}

void adcgs_image_to_srgb(adcgs_image *image)
{
    bend(image, to_srgb);
}

void adcgs_image_to_linear(adcgs_image *image)
{
    bend(image, to_linear);
}

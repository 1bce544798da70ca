/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Images of one size in columns and rows. */
#include "config.h"

#include "media/image/mosaic.h"

#include <math.h>

adcgs_status adcgs_mosaic_init(adcgs_mosaic *mosaic, int width, int height, int columns, int rows, const char *path,
                               adcgs_error *error)
{
    *mosaic = (adcgs_mosaic){.width = width, .height = height, .columns = columns, .rows = rows};
    ADCGS_TRY(adcgs_image_alloc(&mosaic->image, columns * (width + ADCGS_MOSAIC_GAP) - ADCGS_MOSAIC_GAP,
                                rows * (height + ADCGS_MOSAIC_GAP) - ADCGS_MOSAIC_GAP, 3, path, error));
    const size_t n = 3 * (size_t)mosaic->image.width * (size_t)mosaic->image.height;
    for (size_t i = 0; i < n; i++)
        mosaic->image.data[i] = 1.0f;
    return ADCGS_OK;
}

void adcgs_mosaic_clear(adcgs_mosaic *mosaic)
{
    adcgs_image_free(&mosaic->image);
    *mosaic = (adcgs_mosaic){0};
}

/** A line of an image in the mosaic. */
static float *line_of(const adcgs_mosaic *m, int column, int row, int y)
{
    const size_t line = (size_t)(row * (m->height + ADCGS_MOSAIC_GAP) + y), at = (size_t)(column * (m->width + ADCGS_MOSAIC_GAP));
    return m->image.data + 3 * (line * (size_t)m->image.width + at);
}

static float sample_of(adcgs_samples picture, const adcgs_mosaic *m, int x, int y, size_t c)
{
    return picture.data[((size_t)y * (size_t)m->width + (size_t)x) * picture.pixel + c * picture.channel];
}

void adcgs_mosaic_place(adcgs_mosaic *mosaic, int column, int row, adcgs_samples picture)
{
    for (int y = 0; y < mosaic->height; y++) {
        float *to = line_of(mosaic, column, row, y);
        for (int x = 0; x < mosaic->width; x++)
            for (size_t c = 0; c < 3; c++) {
                const float value = sample_of(picture, mosaic, x, y, c);
                *to++ = isnan(value) ? 0.0f : value; /* masked: black, as in the mask */
            }
    }
}

void adcgs_mosaic_difference(adcgs_mosaic *mosaic, int column, int row, adcgs_samples picture, adcgs_samples truth)
{
    for (int y = 0; y < mosaic->height; y++) {
        float *to = line_of(mosaic, column, row, y);
        for (int x = 0; x < mosaic->width; x++)
            for (size_t c = 0; c < 3; c++) {
                const float off = sample_of(picture, mosaic, x, y, c) - sample_of(truth, mosaic, x, y, c);
                *to++ = isnan(off) ? 0.5f : fminf(fmaxf(0.5f + ADCGS_MOSAIC_GAIN * off, 0.0f), 1.0f);
            }
    }
}

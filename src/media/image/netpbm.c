/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Binary PGM and PPM. */
#include "config.h"

#include "media/image/netpbm.h"

#include <stdlib.h>

#define NUMBER_MAX 99999999 /* largest number of a header; chosen by hand, not measured */

typedef struct header {
    int width, height, channels, maximum;
} header;

/** A decimal number after white space and comments; -1 if there is none or it exceeds NUMBER_MAX. */
static int read_number(FILE *file)
{
    int c = getc(file);
    while (c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '#') {
        if (c == '#')
            while (c != '\n' && c != EOF)
                c = getc(file);
        else
            c = getc(file);
    }
    int value = -1;
    for (; c >= '0' && c <= '9'; c = getc(file)) {
        value = (value < 0 ? 0 : value) * 10 + (c - '0');
        if (value > NUMBER_MAX)
            return -1;
    }
    ungetc(c, file);
    return value;
}

static adcgs_status read_header(FILE *file, header *out, const char *path, adcgs_error *error)
{
    const int p = getc(file), kind = getc(file);
    if (p != 'P' || (kind != '5' && kind != '6'))
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: not a binary PGM or PPM file (P5 or P6)", path);
    out->channels = kind == '6' ? 3 : 1;
    out->width = read_number(file);
    out->height = read_number(file);
    out->maximum = read_number(file);
    const int space = getc(file);
    if (out->width < 1 || out->height < 1 || out->maximum < 1 || out->maximum > 65535 ||
        !(space == ' ' || space == '\t' || space == '\n' || space == '\r'))
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: malformed PGM/PPM header", path);
    if (out->width > ADCGS_IMAGE_MAX || out->height > ADCGS_IMAGE_MAX)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %dx%d pixels, expected at most %dx%d", path, out->width, out->height,
                          ADCGS_IMAGE_MAX, ADCGS_IMAGE_MAX);
    return ADCGS_OK;
}

adcgs_status adcgs_netpbm_probe(FILE *file, int *width, int *height, int *channels, const char *path, adcgs_error *error)
{
    header head = {0};
    ADCGS_TRY(read_header(file, &head, path, error));
    *width = head.width;
    *height = head.height;
    *channels = head.channels;
    return ADCGS_OK;
}

static adcgs_status read_rows(FILE *file, const header *head, uint8_t *row, adcgs_image *out, const char *path,
                              adcgs_error *error)
{
    const size_t n = (size_t)head->width * (size_t)head->channels;
    const size_t sample = head->maximum > 255 ? 2 : 1;
    const float scale = (float)head->maximum;
    for (int y = 0; y < head->height; y++) {
        if (fread(row, sample, n, file) != n)
            return adcgs_fail(error, ADCGS_ERR_DATA, "%s: ends in row %d of %d", path, y, head->height);
        float *line = out->data + (size_t)y * n;
        for (size_t i = 0; i < n; i++)
            line[i] = (float)(sample == 2 ? row[2 * i] << 8 | row[2 * i + 1] : row[i]) / scale;
    }
    return ADCGS_OK;
}

adcgs_status adcgs_netpbm_read(FILE *file, adcgs_image *out, const char *path, adcgs_error *error)
{
    *out = (adcgs_image){0};
    header head = {0};
    ADCGS_TRY(read_header(file, &head, path, error));
    ADCGS_TRY(adcgs_image_alloc(out, head.width, head.height, head.channels, path, error));
    uint8_t *row = malloc((size_t)head.width * (size_t)head.channels * 2);
    const adcgs_status status =
        row ? read_rows(file, &head, row, out, path, error) : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    free(row);
    if (status != ADCGS_OK)
        adcgs_image_free(out);
    return status;
}

/** Convert a row without its alpha, to bytes or to pairs of bytes, high byte first. */
static void pack_row(const float *row, size_t width, size_t held, size_t stored, int bits, uint16_t *levels, uint8_t *bytes)
{
    if (bits == 16)
        adcgs_image_to_u16(row, width * held, levels);
    else
        adcgs_image_to_u8(row, width * held, bytes);
    for (size_t i = 0; i < width * stored; i++) {
        const size_t from = i / stored * held + i % stored;
        if (bits == 16) {
            bytes[2 * i] = (uint8_t)(levels[from] >> 8);
            bytes[2 * i + 1] = (uint8_t)levels[from];
        } else
            bytes[i] = bytes[from];
    }
}

adcgs_status adcgs_netpbm_encode(adcgs_buffer *out, const adcgs_image *image, const adcgs_image_options *options,
                                 const char *path, adcgs_error *error)
{
    const size_t stored = image->channels < 3 ? 1 : 3, held = (size_t)image->channels, width = (size_t)image->width;
    const int bits = options->bits;
    char head[64];
    uint8_t *bytes = malloc(2 * width * held);
    uint16_t *levels = malloc(width * held * sizeof *levels);
    const int done = bytes && levels;
    snprintf(head, sizeof head, "P%c\n%d %d\n%d\n", stored == 3 ? '6' : '5', image->width, image->height,
             bits == 16 ? 65535 : 255);
    adcgs_write_bytes(out, head, strlen(head));
    for (int y = 0; y < image->height && done; y++) {
        pack_row(image->data + (size_t)y * width * held, width, held, stored, bits, levels, bytes);
        adcgs_write_bytes(out, bytes, width * stored * (size_t)bits / 8);
    }
    free(bytes);
    free(levels);
    return done ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
}

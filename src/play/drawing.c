/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The shapes of the overlay. */
#include "config.h"

#include "play/drawing.h"

#include "system/text.h"

#include <math.h>
#include <stdio.h>

#define LINE_HEIGHT 1.3 /* of a line, in sizes of the font; chosen by hand, not measured */
#define DOTS "..."

int adcgs_line_height(int size)
{
    return (int)ceil(LINE_HEIGHT * size);
}

/** Copies as many characters as fit. \return their bytes */
static size_t clean(char out[ADCGS_TEXT_BYTES], const char *text)
{
    size_t used = 0;
    while (*text) {
        uint32_t code;
        const int length = adcgs_utf8_next(text, &code), good = length > 0 && adcgs_text_is_shown(code);
        const size_t bytes = good ? (size_t)length : 1;
        if (used + bytes >= ADCGS_TEXT_BYTES)
            break;
        memcpy(out + used, good ? text : "?", bytes);
        used += bytes;
        text += ADCGS_MAX(1, length);
    }
    out[used] = 0;
    return used;
}

int adcgs_text_width(const adcgs_type *type, int size, const char *text)
{
    char line[ADCGS_TEXT_BYTES];
    clean(line, text);
    return *line ? type->width(type->arg, size, line) : 0;
}

/** Removes the last characters until the text with dots fits. \return nonzero if something remains */
static int cut(const adcgs_type *type, char line[ADCGS_TEXT_BYTES], size_t bytes, int size, int width)
{
    bytes = ADCGS_MIN(bytes, ADCGS_TEXT_BYTES - sizeof DOTS);
    do {
        while (bytes > 0 && ((unsigned char)line[bytes] & 0xc0) == 0x80)
            bytes--; /* to the beginning of a character */
        memcpy(line + bytes, DOTS, sizeof DOTS);
        if (type->width(type->arg, size, line) <= width)
            return 1;
    } while (bytes-- > 0);
    return 0;
}

void adcgs_drawing_init(adcgs_drawing *d, const adcgs_type *type)
{
    d->type = type;
    d->n = d->full = 0;
    d->used = 0;
}

static void add(adcgs_drawing *d, const adcgs_shape *shape)
{
    if (d->n < ADCGS_SHAPES_MAX)
        d->shape[d->n++] = *shape;
    else
        d->full = 1;
}

void adcgs_drawing_rect(adcgs_drawing *d, adcgs_rect place, uint32_t colour)
{
    if (place.width > 0 && place.height > 0)
        add(d, &(adcgs_shape){.kind = ADCGS_SHAPE_RECT, .colour = colour, .place = place});
}

void adcgs_drawing_polygon(adcgs_drawing *d, const float *points, int n, uint32_t colour)
{
    adcgs_shape shape = {.kind = ADCGS_SHAPE_POLYGON, .colour = colour, .n = n};
    float low[2] = {points[0], points[1]}, high[2] = {points[0], points[1]};
    for (int i = 0; i < n; i++) {
        shape.x[i] = points[2 * i];
        shape.y[i] = points[2 * i + 1];
        for (int k = 0; k < 2; k++) {
            low[k] = ADCGS_MIN(low[k], points[2 * i + k]);
            high[k] = ADCGS_MAX(high[k], points[2 * i + k]);
        }
    }
    shape.place = (adcgs_rect){(int)floorf(low[0]), (int)floorf(low[1]), 0, 0};
    shape.place.width = (int)ceilf(high[0]) - shape.place.x;
    shape.place.height = (int)ceilf(high[1]) - shape.place.y;
    add(d, &shape);
}

int adcgs_drawing_text(adcgs_drawing *d, int x, int y, int size, int width, const char *text, uint32_t colour)
{
    char line[ADCGS_TEXT_BYTES];
    const size_t whole = clean(line, text);
    if (!whole || (d->type->width(d->type->arg, size, line) > width && !cut(d->type, line, whole, size, width)))
        return 0;
    const size_t bytes = strlen(line) + 1;
    const int wide = d->type->width(d->type->arg, size, line);
    if (d->used + bytes > sizeof d->text) {
        d->full = 1;
        return 0;
    }
    memcpy(d->text + d->used, line, bytes);
    add(d, &(adcgs_shape){.kind = ADCGS_SHAPE_TEXT,
                          .colour = colour,
                          .place = {x, y, wide, adcgs_line_height(size)},
                          .size = size,
                          .text = d->used});
    d->used += bytes;
    return wide;
}

int adcgs_drawing_inside(const adcgs_drawing *d, int width, int height)
{
    for (int i = 0; i < d->n; i++) {
        const adcgs_rect *const r = &d->shape[i].place;
        if (r->x < 0 || r->y < 0 || r->x + r->width > width || r->y + r->height > height)
            return 0;
    }
    return !d->full;
}

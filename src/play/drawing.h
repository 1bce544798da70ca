/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The shapes of the overlay: rectangles, polygons and lines of text, from the lowest to the uppermost. The list says where
 * everything is, and the window renders it. Text is UTF-8. Its size is the height of the font's em in pixels.
 */
#ifndef ADCGS_PLAY_DRAWING_H
#define ADCGS_PLAY_DRAWING_H

#include <stddef.h>
#include <stdint.h>

/* Origin: chosen by hand, not measured. */
#define ADCGS_SHAPES_MAX 256 /* shapes of a drawing, at most */
#define ADCGS_SHAPE_POINTS 4 /* points of a polygon, at most */
#define ADCGS_TEXT_BYTES 256 /* bytes of a line, with its end */

typedef struct adcgs_rect {
    int x, y, width, height;
} adcgs_rect;

typedef enum adcgs_shape_kind {
    ADCGS_SHAPE_RECT,    /**< place */
    ADCGS_SHAPE_POLYGON, /**< n points x, y: a convex polygon; place is its bounding box */
    ADCGS_SHAPE_TEXT     /**< text at index `text` of the list, size; place has its width, and the height of a line */
} adcgs_shape_kind;

typedef struct adcgs_shape {
    adcgs_shape_kind kind;
    uint32_t colour; /**< 0xRRGGBBAA */
    adcgs_rect place;
    int n;
    float x[ADCGS_SHAPE_POINTS], y[ADCGS_SHAPE_POINTS];
    int size;
    size_t text;
} adcgs_shape;

/** The letters' widths. */
typedef struct adcgs_type {
    int (*width)(void *arg, int size, const char *text); /**< of a line of text, pixels */
    void *arg;
} adcgs_type;

typedef struct adcgs_drawing {
    const adcgs_type *type;
    int n, full; /**< shapes; nonzero: some were left out for lack of room */
    adcgs_shape shape[ADCGS_SHAPES_MAX];
    size_t used;
    char text[16384];
} adcgs_drawing;

/** Height of a line of this size. */
int adcgs_line_height(int size);
/** Width of a line of text as adcgs_drawing_text() writes it. */
int adcgs_text_width(const adcgs_type *type, int size, const char *text);

/** Begins an empty drawing; type lives as long as it. */
void adcgs_drawing_init(adcgs_drawing *drawing, const adcgs_type *type);
void adcgs_drawing_rect(adcgs_drawing *drawing, adcgs_rect place, uint32_t colour);
/** A convex polygon of n <= ADCGS_SHAPE_POINTS points x, y. */
void adcgs_drawing_polygon(adcgs_drawing *drawing, const float *points, int n, uint32_t colour);
/**
 * Writes a line of text with its upper left corner at (x, y). Invalid UTF-8 and characters that control text become question
 * marks. Text wider than `width` is cut, and ends with three dots; if not even these fit, nothing is written.
 * \return the width of the written text
 */
int adcgs_drawing_text(adcgs_drawing *drawing, int x, int y, int size, int width, const char *text, uint32_t colour);
/** True if all shapes are in a window of this size. */
int adcgs_drawing_inside(const adcgs_drawing *drawing, int width, int height);

#endif

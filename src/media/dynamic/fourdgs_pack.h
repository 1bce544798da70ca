/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The parts of a .4dgs writer: bins of a frame, and the streams of a chunk. */
#ifndef ADCGS_MEDIA_DYNAMIC_FOURDGS_PACK_H
#define ADCGS_MEDIA_DYNAMIC_FOURDGS_PACK_H

#include "media/dynamic/fourdgs.h"
#include "media/dynamic/fourdgs_write.h"

#include <stdio.h>

#define ADCGS_FOURDGS_PLACES 14 /**< bins of a splat in a frame; arithmetic, 3 + 3 + 1 + 3 + 3 + 1 */

typedef struct adcgs_fourdgs_writer {
    const adcgs_splat_clip *clip;
    const char *path;
    adcgs_error *error;
    uint32_t n;
    double step, low[3], high[3];
    int32_t *rows[2]; /**< [n][ADCGS_FOURDGS_PLACES]: of the frame before, and of this one */
    uint32_t *moved;  /**< splats of the chunk */
    int32_t *symbols;
    uint8_t *planes, *packed;
    size_t room; /**< of packed */
    FILE *file;
    uint64_t at; /**< bytes that were written */
    int failed;  /**< out of memory */
} adcgs_fourdgs_writer;

static inline void adcgs_put_u(FILE *to, uint64_t value, int bytes)
{
    for (int i = 0; i < bytes; i++)
        putc((int)(value >> 8 * i & 255), to);
}

static inline void adcgs_put_f64(FILE *to, double value)
{
    adcgs_put_u(to, adcgs_double_bits(value), 8);
}

static inline void adcgs_put_string(FILE *to, const char *text)
{
    adcgs_put_u(to, strlen(text), 4);
    fputs(text, to);
}

/**
 * Set the rows of the next frame, and w->moved to the splats that differ from the frame before, or to all.
 * \return their number
 */
uint32_t adcgs_fourdgs_next_rows(adcgs_fourdgs_writer *w, uint32_t frame, int is_delta);
/** Put the streams of the n splats in w->moved: all attributes, or differences of those that change. */
void adcgs_fourdgs_put_splats(FILE *to, adcgs_fourdgs_writer *w, uint32_t n, int is_delta);

#endif

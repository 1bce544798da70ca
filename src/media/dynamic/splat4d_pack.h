/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The parts of a .splat4d writer: the clip in the order of the file, and the file's body. */
#ifndef ADCGS_MEDIA_DYNAMIC_SPLAT4D_PACK_H
#define ADCGS_MEDIA_DYNAMIC_SPLAT4D_PACK_H

#include "media/dynamic/splat4d.h"
#include "media/dynamic/splat4d_write.h"

#include <stdio.h>

/* Origin, unless a line states one: definition (.splat4d's code and FORMAT.md). */
#define ADCGS_SPLAT4D_TURN 128.0   /**< a component of a rotation of 1 */
#define ADCGS_SPLAT4D_LEVELS 255.0 /**< of colours and opacities */
#define ADCGS_SPLAT4D_MASKS 32     /**< combinations of five attributes; arithmetic */

typedef struct adcgs_splat4d_writer {
    const adcgs_splat_clip *clip;
    const char *path;
    adcgs_error *error;
    uint32_t n, group;
    double step[ADCGS_SPLAT4D_ATTRIBUTES];
    double low[3], high[3]; /**< bounds of the positions of all frames */
    int8_t *sign;           /**< [n_frames][n]: 1 or -1, so that quaternions follow each other without a change of sign */
    uint8_t *mask;          /**< [n]: bits of the attributes that change */
    uint32_t *order;        /**< [n]: splats in the order of the file */
    uint32_t moving[ADCGS_SPLAT4D_ATTRIBUTES], in_mask[ADCGS_SPLAT4D_MASKS];
    uint32_t *symbols; /**< of the stream that is being made, and their planes */
    uint8_t *planes;
    FILE *body;      /**< all after the JSON text */
    uint64_t *place; /**< [groups + 2]: begin of the static section and of each group in the body, and the end */
} adcgs_splat4d_writer;

/** A component in the units of the file's steps. */
double adcgs_splat4d_value(const adcgs_splat4d_writer *w, int attribute, uint32_t frame, uint32_t splat, int component);
/** Write the static section and the groups to w->body, and set w->place. All else is set. */
adcgs_status adcgs_splat4d_body(adcgs_splat4d_writer *w);

#endif

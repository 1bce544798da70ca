/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The baseline: a plain tile rasteriser as in the first paper on Gaussian splatting (Kerbl et al. 2023). It uses vectors, but
 * none of this renderer's other techniques. A splat is rendered in all rows of all tiles that the circle of three standard
 * deviations touches. Gradients are computed from back to front. One thread. It starts from projected and sorted splats, and its
 * sums go through the same backward projection, so that only the different parts are compared.
 */
#ifndef ADCGS_BENCH_PLAIN_H
#define ADCGS_BENCH_PLAIN_H

#include "grad/raster_backward_isa.h"

typedef struct plain_tile {
    float t[16][16];  /**< final transmittance, [row][column] */
    uint32_t end[16]; /**< position in the tile's list where each row ended */
} plain_tile;

typedef struct plain_job {
    const adcgs_splat2d *splats; /**< sorted by depth */
    uint32_t n;
    int tiles_x, tiles_y, width, height;
    float background[3];
    uint32_t *start, *list; /**< of each tile */
    size_t list_room;
    plain_tile *tiles;
    float *rgb;        /**< [3][height][width] */
    const float *grad; /**< [3][height][width] */
    float *sums;       /**< [n][SUM_WORDS], in the format of the backward pass, added over all tiles */
} plain_job;

typedef struct plain_dsp {
    void (*blend)(const plain_job *job, int tile);
    void (*back)(const plain_job *job, int tile);
} plain_dsp;

extern const plain_dsp plain_scalar, plain_avx2, plain_avx512;

/** Allocates the lists, tiles and sums for an image; free them with plain_clear(). */
void plain_init(plain_job *job, uint32_t most);
void plain_clear(plain_job *job);
/** Lists the splats of each tile. */
void plain_bin(plain_job *job);

#endif

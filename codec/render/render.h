/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Rendering in strict binary32 (spec clause "Rendering"): project, sort by
 * depth, bin into 16x16 tiles with exact 4x4-block masks, blend front to back.
 * The trainer uses the same forward pass and reads the kept lists.
 */
#ifndef ADCGS_RENDER_RENDER_H
#define ADCGS_RENDER_RENDER_H

#include "base/thread_pool.h"
#include "base/cpu_detect.h"

#include <adcgs/view.h>

#define ADCGS_TILE 16

/** Default screen filter of streams: variance in pixels^2 added to a splat's screen covariance (Kerbl et al., 2023). */
#define ADCGS_SCREEN_FILTER 0.3f

/** One projected splat, 64 bytes. alpha = exp2(a dx^2 + b dx dy + c dy^2 + log2_opacity), dx = pixel centre - x. */
typedef struct adcgs_splat2d {
    float x, y;    /**< centre, pixels */
    float a, b, c; /**< conic times -log2(e)/2, b times -log2(e) */
    float log2_opacity;
    float rgb[3];
    float depth;      /**< camera z, > near plane */
    uint16_t tile[4]; /**< x0, y0, x1, y1: tiles [x0,x1) x [y0,y1) that may be touched */
    uint32_t slot;    /**< index of the primitive */
    float spare[3];
} adcgs_splat2d;

/** A splat in a tile: index into splats, and the 4x4 blocks it may touch (bit 4*by+bx). */
typedef struct adcgs_tile_entry {
    uint32_t splat;
    uint32_t mask;
} adcgs_tile_entry;

typedef struct adcgs_raster adcgs_raster;

adcgs_status adcgs_raster_create(adcgs_raster **out, adcgs_cpu_level cpu, adcgs_pool *pool, adcgs_memory *memory,
                                 adcgs_error *error);
void adcgs_raster_free(adcgs_raster **raster);

/**
 * Render. primitives->n is a multiple of 64 and its arrays are 64-byte aligned. rgb: planar [3][height][width]. More than 2^28
 * (splat, tile) pairs by the splats' bounding rectangles are ADCGS_ERR_LIMIT. Allocates nothing once the workspace has grown. If
 * keep is nonzero, the data for the backward pass stays readable through adcgs_raster_kept() until the next call.
 */
adcgs_status adcgs_raster_forward(adcgs_raster *raster, const adcgs_primitives *primitives, const adcgs_view *view,
                                  const float background[3], float screen_filter, float *rgb, int keep, adcgs_error *error);

/**
 * Render depth and coverage in place of colours: the same splats with the same weights. sums: planar [3][height][width]: the sum
 * of weight times camera z in scene units, the sum of weights, and zeros. Discards the data kept by the last forward pass.
 */
adcgs_status adcgs_raster_depth(adcgs_raster *raster, const adcgs_primitives *primitives, const adcgs_view *view,
                                float screen_filter, float *sums, adcgs_error *error);

/** Data kept by the last forward pass with keep. */
typedef struct adcgs_kept {
    uint32_t n_splats;
    const adcgs_splat2d *splats; /**< [n_splats], by depth, then slot */
    int tiles_x, tiles_y;
    const uint32_t *tile_start;      /**< [tiles+1] into entries */
    const adcgs_tile_entry *entries; /**< depth order within a tile */
    const float *transmittance;      /**< final T, [tiles][16 blocks][16 pixels] */
    uint32_t n_slots;
    const uint32_t *where; /**< [n_slots] index into splats of a slot's splat, or 0xffffffff */
    const uint32_t *first; /**< [n_splats+1] first pair of a splat, counting (splat, tile) pairs splat by splat */
    const uint32_t *place; /**< [entries] number of that pair */
} adcgs_kept;
void adcgs_raster_kept(const adcgs_raster *raster, adcgs_kept *kept);

#endif

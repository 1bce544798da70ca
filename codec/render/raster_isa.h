/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Arguments of the renderer's kernels, and their variants; for raster.c alone. */
#ifndef ADCGS_RENDER_RASTER_ISA_H
#define ADCGS_RENDER_RASTER_ISA_H

#include "render/render.h"

/** Outline of a splat: alpha can reach 1/255 only where |dy| <= ym and |dx - slope*dy| <= width*sqrt(ym^2 - dy^2). */
typedef struct adcgs_outline {
    float slope, width, ym;
    float y_right; /**< dy of the rightmost point */
} adcgs_outline;

typedef struct adcgs_project_job {
    const adcgs_primitives *primitives;
    const adcgs_view *view;
    float filter;
    int tiles_x, tiles_y;
    adcgs_splat2d *splats;   /**< [slots] */
    adcgs_outline *outlines; /**< [slots] */
    uint64_t *keys;          /**< [slots] depth bits << 32 | index into splats */
    uint32_t *areas;         /**< [slots] tiles of the rectangle */
} adcgs_project_job;

/** Words that the binning kernel may write past its last pair. */
#define ADCGS_BIN_SLACK 16

typedef struct adcgs_bin_job {
    const uint64_t *order;         /**< sorted keys */
    const adcgs_splat2d *from;     /**< as projected */
    const adcgs_outline *outlines; /**< as projected */
    int tiles_x;
    adcgs_splat2d *to; /**< sorted */
    uint32_t *first;   /**< pairs of this piece before each sorted splat; not used if where is NULL */
    uint32_t *where;   /**< sorted position of each slot, or NULL */
} adcgs_bin_job;

typedef struct adcgs_blend_job {
    const adcgs_splat2d *splats;
    const adcgs_tile_entry *entries;
    const uint32_t *tile_start;
    int tiles_x, width, height;
    float background[3];
    float *rgb;
    float *transmittance; /**< [tiles][16][16], or NULL */
} adcgs_blend_job;

typedef struct adcgs_raster_dsp {
    /** Project 64 slots from first on. Visible splats are written from index at on, in slot order. Returns their number. */
    uint32_t (*project)(const adcgs_project_job *job, uint32_t first, uint32_t at);
    /**
     * Copy sorted splats [begin, end) and list the tiles that each touches: out[i] = splat << 36 | tile << 16 | mask. Adds one to
     * counts[tile] for each pair. Returns the number of pairs. out has room for the splats' areas and ADCGS_BIN_SLACK more.
     */
    uint32_t (*bin)(const adcgs_bin_job *job, uint32_t begin, uint32_t end, uint32_t *counts, uint64_t *out);
    /** Blend a tile and write its pixels. */
    void (*blend)(const adcgs_blend_job *job, int tile);
} adcgs_raster_dsp;

extern const adcgs_raster_dsp adcgs_raster_scalar, adcgs_raster_avx2, adcgs_raster_avx512;

#endif

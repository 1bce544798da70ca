/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Splats sampled at the frames of a clip, and pieces that replace them: splats that move along polynomials and fade around a
 * centre in time. Times are in frames.
 */
#ifndef ADCGS_MEDIA_DYNAMIC_SPLAT_PATHS_H
#define ADCGS_MEDIA_DYNAMIC_SPLAT_PATHS_H

#include "media/splats/splats.h"

#define ADCGS_PIECE_ORDERS 3     /**< powers of time in a position; definition (SpacetimeGaussians) */
#define ADCGS_PIECE_FOREVER 1e6f /**< sigma of pieces that do not fade, frames; chosen by hand, not measured */

/** A splat in one frame. */
typedef struct adcgs_path_sample {
    float mean[3], scale[3], rotation[4], opacity, colour[3]; /**< as in adcgs_splats; opacity 0: invisible, the rest is unused */
} adcgs_path_sample;

/** Splats that exist in some successive frames of a clip, and are invisible in the others. */
typedef struct adcgs_splat_paths {
    uint32_t n;
    uint32_t clip;             /**< frames of the clip, at least 1 */
    uint32_t first, frames;    /**< sampled frames */
    double tolerance;          /**< error of positions that is tolerated for the smallest splats, > 0 */
    adcgs_path_sample *sample; /**< [n][frames]; adcgs_pieces_add() changes signs of quaternions */
} adcgs_splat_paths;

/**
 * A row of a file. At frame t, with dt = t - centre: position mean + sum over j of motion[j] dt^(j+1), rotation normalised
 * (rotation + turn dt), opacity times exp(-dt^2 / (2 sigma^2)).
 */
typedef struct adcgs_piece {
    float mean[3], motion[ADCGS_PIECE_ORDERS][3];
    float rotation[4], turn[4];
    float scale[3], opacity, colour[3];
    float centre, sigma; /**< ADCGS_PIECE_FOREVER or more: does not fade */
} adcgs_piece;

/** Pieces of a clip. */
typedef struct adcgs_pieces {
    adcgs_piece *piece;
    uint32_t n, capacity;
    uint32_t clip;    /**< frames */
    double offset[3]; /**< subtracted from positions in the world */
    double worst;     /**< largest error of a splat, in units of the tolerance */
    uint32_t above;   /**< splats with an error above the tolerance */
} adcgs_pieces;

/** Forms of pieces. */
typedef enum adcgs_piece_form {
    ADCGS_PIECE_LINEAR, /**< orders above 1 and turns are 0: FTGS */
    ADCGS_PIECE_CUBIC   /**< .splatv */
} adcgs_piece_form;

/**
 * Add pieces for all paths. A path gets one piece if that suffices, else as many as are needed, at equal distances in time, whose
 * weights in the image sum up to that of the splat. ADCGS_ERR_UNSUPPORTED for more than ADCGS_SPLATS_MAX. The caller frees
 * pieces->piece.
 */
adcgs_status adcgs_pieces_add(adcgs_pieces *pieces, const adcgs_splat_paths *paths, adcgs_piece_form form, const char *path,
                              adcgs_error *error);

/** Write FTGS PLY version 1. comment: a line without its newline. Atomic. */
adcgs_status adcgs_ftgs_write(const adcgs_pieces *pieces, const char *comment, const char *path, adcgs_error *error);
/** Write .splatv with n cameras, of which at least the first serves viewers. Values become binary16 and bytes. Atomic. */
adcgs_status adcgs_splatv_write(const adcgs_pieces *pieces, const adcgs_camera *cameras, int n, const char *path,
                                adcgs_error *error);

#endif

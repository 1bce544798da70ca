/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Splats at one moment, in memory and in files. The formats are PLY
 * (io/splats_ply.h), SPZ (io/spz.h), GLB (io/glb.h) and, to be written only,
 * SOG (io/sog.h); what a file begins with tells a reader which it is, and its
 * name's ending tells a writer.
 */
#ifndef ADCGS_IO_SPLATS_H
#define ADCGS_IO_SPLATS_H

#include "base/base.h"

#include <adcgs/types.h>

#define ADCGS_SPLATS_DC 0.28209479177387814 /**< the spherical harmonic of degree 0: 1 / (2 sqrt(pi)) */
#define ADCGS_SPLATS_MAX (1u << 24)
#define ADCGS_SPLATS_DEGREE_MAX 3
#define ADCGS_SPLATS_NAMES ".ply, .spz, .glb or .sog" /**< what names of files may end in, for messages */

/** World axes, right-handed: codes of adcgs_stream. */
enum { ADCGS_SPLATS_UP_UNKNOWN, ADCGS_SPLATS_Y_UP, ADCGS_SPLATS_Z_UP, ADCGS_SPLATS_Y_DOWN };

/**
 * Arrays as in adcgs_primitives, but in world units: 64-byte aligned and as long as the next multiple of 64, where what is behind
 * the last splat has opacity 0 and draws nothing. All values are finite.
 */
typedef struct adcgs_splats {
    uint32_t n;
    uint8_t axes;      /**< ADCGS_SPLATS_Y_UP..., as far as the file or the stream tells */
    uint8_t antialiased; /**< trained with antialiasing: each view scales opacities (data/splat_views.h) */
    double offset[3];  /**< to be added to mean: not zero for a scene far from the origin, which binary32 cannot hold */
    float *mean[3], *scale[3], *rotation[4]; /**< world units; standard deviations, > 0; unit quaternion w x y z */
    float *opacity;    /**< 0..1 */
    float *colour[3];  /**< 0.5 + ADCGS_SPLATS_DC f_dc: RGB seen from everywhere, not clipped */
    int degree;        /**< of the colours' spherical harmonics, 0..3; 0: they do not depend on the direction of view */
    float *harmonics;  /**< [n][3][(degree+1)^2 - 1], those above degree 0, f_rest_* as it is; NULL with degree 0 */
    float *block;      /**< what the arrays are in */
} adcgs_splats;

/** n splats of degree 0 that draw nothing yet. ADCGS_ERR_DATA, naming path, for more than ADCGS_SPLATS_MAX. */
adcgs_status adcgs_splats_alloc(adcgs_splats *splats, uint64_t n, const char *path, adcgs_error *error);
void adcgs_splats_free(adcgs_splats *splats);
/**
 * One after the other; harmonics of the highest degree, axes of the first. ADCGS_ERR_UNSUPPORTED if some are antialiased and some
 * are not. On failure *out is empty.
 */
adcgs_status adcgs_splats_join(adcgs_splats *out, const adcgs_splats *parts, size_t n, const char *path, adcgs_error *error);

/** The splats as the renderer takes them; they stay where they are. */
void adcgs_splats_primitives(const adcgs_splats *splats, adcgs_primitives *out);
/**
 * A decoder's primitives in world units, world = origin + scale * scene, less the offset of a far origin (io/offset.h). Left
 * out are those that draw nothing: of opacity 0, or so far out that binary32 cannot hold them. The rest keep their order.
 */
adcgs_status adcgs_splats_take(adcgs_splats *out, const adcgs_primitives *primitives, const double origin[3], double scale,
                               const char *path, adcgs_error *error);

/** Whether the file begins as one of splats does; of PLY, any. */
int adcgs_splats_is(const char *path);
/**
 * Read a file of splats. Harmonics that are all zero are dropped.
 * \return ADCGS_ERR_UNSUPPORTED for what the format has and we do not take, ADCGS_ERR_DATA, naming what is wrong where, if it is
 * something else, has no splats, ends early or holds a number that is none.
 */
adcgs_status adcgs_splats_read(adcgs_splats *out, const char *path, adcgs_error *error);
/** As adcgs_splats_read() from memory, with a zero byte behind the data. */
adcgs_status adcgs_splats_parse(adcgs_splats *out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error);

/** How to write them. */
typedef struct adcgs_splats_style {
    const char *comment; /**< a line without its end, for formats that have a place for one */
    int rest_degree;     /**< 1..3: PLY gets f_rest_* of so high a degree, all zero, for programs that insist on them; 0: none */
} adcgs_splats_style;

/** ADCGS_ERR_USAGE unless the name ends in what tells a format that takes this style; in any case, ".PLY" too. */
adcgs_status adcgs_splats_check_name(const char *path, const adcgs_splats_style *style, adcgs_error *error);
/**
 * Write a file of the format that its name tells; only colours of degree 0 are written. Where a format says which way is up, what
 * knows its own is turned. An offset becomes the translation of GLB's node, and a comment "offset X Y Z" of PLY; SPZ and SOG have
 * no place for it. Atomic.
 */
adcgs_status adcgs_splats_write(const adcgs_splats *splats, const adcgs_splats_style *style, const char *path,
                                adcgs_error *error);

#endif

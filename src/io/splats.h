/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Splats at one moment in files: the PLY of 3D Gaussian splatting, with one
 * vertex per splat and the properties x y z, nx ny nz (zero, unused), f_dc_0..2,
 * f_rest_*, opacity, scale_0..2 and rot_0..3. Its numbers are those before the
 * activations: colour = 0.5 + ADCGS_SPLATS_DC f_dc, opacity a logit, scales
 * natural logarithms, the quaternion w x y z of any length.
 */
#ifndef ADCGS_IO_SPLATS_H
#define ADCGS_IO_SPLATS_H

#include "base/base.h"

#include <adcgs/types.h>

#define ADCGS_SPLATS_DC 0.28209479177387814 /**< the spherical harmonic of degree 0: 1 / (2 sqrt(pi)) */
#define ADCGS_SPLATS_MAX (1u << 24)
#define ADCGS_SPLATS_DEGREE_MAX 3

/**
 * Arrays as in adcgs_primitives, but in world units: 64-byte aligned and as long as the next multiple of 64, where what is behind
 * the last splat has opacity 0 and draws nothing. All values are finite.
 */
typedef struct adcgs_splats {
    uint32_t n;
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

/** The splats as the renderer takes them; they stay where they are. */
void adcgs_splats_primitives(const adcgs_splats *splats, adcgs_primitives *out);
/**
 * A decoder's primitives in world units, world = origin + scale * scene. Left out are those that draw nothing: of opacity 0, or
 * so far out that binary32 cannot hold them. The rest keep their order.
 */
adcgs_status adcgs_splats_take(adcgs_splats *out, const adcgs_primitives *primitives, const double origin[3], double scale,
                               const char *path, adcgs_error *error);

/**
 * Read a PLY of splats: text, or binary of either byte order; float or double properties. The properties may stand in any order;
 * nx, ny, nz and unknown ones are skipped; f_rest_* must be none, 9, 24 or 45, and are dropped if all are zero.
 * \return ADCGS_ERR_UNSUPPORTED for a compressed PLY, ADCGS_ERR_DATA, naming what is wrong where, if it is something else, has no
 * splats, lacks a property, ends early or holds a number that is not finite or a scale outside e^-80..e^80.
 */
adcgs_status adcgs_splats_read(adcgs_splats *out, const char *path, adcgs_error *error);
/** As adcgs_splats_read() from memory, with a zero byte behind the data. */
adcgs_status adcgs_splats_parse(adcgs_splats *out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error);

/**
 * Write a binary little-endian PLY of splats without f_rest_*; only colours of degree 0 are written. `comment` is a line of its
 * header without its end. Atomic.
 */
adcgs_status adcgs_splats_write(const adcgs_splats *splats, const char *comment, const char *path, adcgs_error *error);

#endif

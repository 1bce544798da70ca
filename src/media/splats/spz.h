/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Splats as SPZ, Niantic's format of columns: positions in fixed point of 24
 * bits, opacities, colours, scales and harmonics in 8 bits, rotations in 32 (24
 * in version 2). Its axes are right, up and back, so y is up. Versions 2 and 3
 * are one gzip stream. In version 4 each column is a zstd stream, after an
 * uncompressed header and table. From its text,
 * https://github.com/nianticlabs/spz: README.md, extensions/README.md.
 */
#ifndef ADCGS_MEDIA_SPLATS_SPZ_H
#define ADCGS_MEDIA_SPLATS_SPZ_H

#include "media/splats/splats.h"

#include <stdio.h>

/* Origin: definition (SPZ, whose text is named above). */
#define ADCGS_SPZ_HEADER 32         /**< bytes of the header of version 4 */
#define ADCGS_SPZ_OLD_HEADER 16     /**< bytes of that of versions 2 and 3, packed together with the columns */
#define ADCGS_SPZ_ENTRY 16          /**< bytes of a table entry: packed and unpacked size of a stream */
#define ADCGS_SPZ_ANTIALIASED 1     /**< a flag: trained with antialiasing */
#define ADCGS_SPZ_COLOUR 0.15       /**< f_dc is (c / 255 - 1/2) / 0.15 */
#define ADCGS_SPZ_SCALE_MIN (-10.0) /**< scales are e^(s / 16 - 10) */
#define ADCGS_SPZ_SCALE_STEPS 16.0  /**< steps per unit of a scale's logarithm */
#define ADCGS_SPZ_ROTATION_MAX 511  /**< represents the square root of 1/2, the maximum of the smaller three components */
#define ADCGS_SPZ_SQRT_HALF 0.70710678118654752 /**< sqrt(1/2) */

/** The columns, in their order in the file. */
typedef enum adcgs_spz_column {
    ADCGS_SPZ_POSITIONS,
    ADCGS_SPZ_OPACITIES,
    ADCGS_SPZ_COLOURS,
    ADCGS_SPZ_SCALES,
    ADCGS_SPZ_ROTATIONS,
    ADCGS_SPZ_HARMONICS, /**< only of degree 1 and more */
    ADCGS_SPZ_COLUMNS
} adcgs_spz_column;

/** True if the bytes begin like SPZ, or like any gzip file. */
int adcgs_spz_is(const uint8_t *data, size_t bytes);
/**
 * adcgs_splats_parse() of data that adcgs_spz_is() accepts. ADCGS_ERR_UNSUPPORTED for version 1, which was never released,
 * harmonics of degree 4, a file that declares other axes, and in a build without zlib and zstd. On failure the caller clears
 * *out.
 */
adcgs_status adcgs_spz_parse(adcgs_splats *out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error);
/**
 * Write the style's version to an open file; the caller checks it for errors. Positions get as many fractional bits as the
 * farthest one allows. Version 2 rounds x, y and z of rotations to steps of 1/127.5; w follows from them, and is up to 0.12
 * off where it is near 0. Scales outside 4.54e-5 to 380 and colours outside -0.44 to 1.44 are clamped. ADCGS_ERR_UNSUPPORTED
 * for zero splats, for positions beyond 2^23, and in a build without zlib and zstd.
 */
adcgs_status adcgs_spz_put(const adcgs_splats *splats, const adcgs_splats_style *style, FILE *file, const char *path,
                           adcgs_error *error);

#endif

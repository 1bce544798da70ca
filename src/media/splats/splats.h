/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Splats at one time step, in memory and in files. The formats are PLY
 * (media/splats/splats_ply.h), SPZ (spz.h), GLB (glb.h), SOG (sog.h) and, for
 * reading only, compressed PLY (ply_packed.h), .splat (dot_splat.h) and .ksplat
 * (ksplat.h). Reading detects the format by the content, writing by the
 * extension.
 */
#ifndef ADCGS_MEDIA_SPLATS_SPLATS_H
#define ADCGS_MEDIA_SPLATS_SPLATS_H

#include "base/base.h"

#include <adcgs/types.h>

#define ADCGS_SPLATS_DC 0.28209479177387814 /**< the spherical harmonic of degree 0: 1 / (2 sqrt(pi)); definition */
#define ADCGS_SPLATS_MAX (1u << 24)         /**< splats of a file; chosen by hand, not measured */
#define ADCGS_SPLATS_DEGREE_MAX 3           /**< of harmonics; definition (3D Gaussian splatting, KHR_gaussian_splatting) */
#define ADCGS_SPLATS_SCALE_MIN \
    1.8048514e-35f /**< e^-80: lower bound of scales, which flat splats get; chosen by hand, not measured */
#define ADCGS_SPLATS_SCALE_MAX 5.5406223e34f /**< e^80: upper bound of scales; chosen by hand, not measured */
#define ADCGS_SPLATS_FORMATS "PLY, SPZ, GLB, SOG, .splat or .ksplat" /**< formats that are read, for messages */
#define ADCGS_SPLATS_NAMES ".ply, .spz, .glb or .sog"                /**< extensions of file names, for messages */

/** World axes, right-handed: codes of adcgs_stream. */
enum {
    ADCGS_SPLATS_UP_UNKNOWN,
    ADCGS_SPLATS_Y_UP,
    ADCGS_SPLATS_Z_UP,
    ADCGS_SPLATS_Y_DOWN,
    ADCGS_SPLATS_KEEP /**< of a style alone: the splats' own */
};

/**
 * Arrays as in adcgs_primitives, but in world units. They are 64-byte aligned and padded to a multiple of 64 splats; padding has
 * opacity 0 and is invisible. All values are finite.
 */
typedef struct adcgs_splats {
    uint32_t n;
    uint8_t axes;        /**< ADCGS_SPLATS_Y_UP..., if the file or the stream gives them */
    uint8_t antialiased; /**< trained with antialiasing: each view scales opacities (scene/splat_views.h) */
    double offset[3];    /**< added to mean gives the position; nonzero for a scene so far from the origin that binary32 is too
                            coarse */
    float *mean[3], *scale[3], *rotation[4]; /**< world units; standard deviations, > 0; unit quaternion w x y z */
    float *opacity;                          /**< 0..1 */
    float *colour[3];                        /**< 0.5 + ADCGS_SPLATS_DC f_dc: RGB seen from any direction, not clipped */
    int degree;       /**< of the colours' spherical harmonics, 0..3; 0: colours do not depend on the viewing direction */
    float *harmonics; /**< [n][3][(degree+1)^2 - 1], those above degree 0, the file's f_rest_*; NULL with degree 0 */
    float *block;     /**< memory of the arrays */
} adcgs_splats;

/** n invisible splats of degree 0. ADCGS_ERR_DATA, naming path, for more than ADCGS_SPLATS_MAX. */
adcgs_status adcgs_splats_alloc(adcgs_splats *splats, uint64_t n, const char *path, adcgs_error *error);
void adcgs_splats_free(adcgs_splats *splats);
/**
 * Concatenate parts. Harmonics get the highest degree, axes are those of the first part. ADCGS_ERR_UNSUPPORTED if some parts are
 * antialiased and some are not. On failure *out is empty.
 */
adcgs_status adcgs_splats_join(adcgs_splats *out, const adcgs_splats *parts, size_t n, const char *path, adcgs_error *error);

/** Copy splats, with their offset. On failure *out is empty. */
adcgs_status adcgs_splats_copy(adcgs_splats *out, const adcgs_splats *splats, const char *path, adcgs_error *error);

/** Point the renderer's primitives at the splats, without a copy. */
void adcgs_splats_primitives(const adcgs_splats *splats, adcgs_primitives *out);
/**
 * A decoder's primitives in world units, world = origin + scale * scene, less the offset; NULL: that of a far origin
 * (media/splats/offset.h). Invisible primitives are dropped: those of opacity 0, or too far out for binary32. The others keep
 * their order.
 */
adcgs_status adcgs_splats_take(adcgs_splats *out, const adcgs_primitives *primitives, const double origin[3], double scale,
                               const double *offset, const char *path, adcgs_error *error);

/**
 * Copy one primitive to index `to`, world = origin + scale * scene. \return true if it is visible and can be stored; else `to`
 * has any values
 */
int adcgs_splats_take_one(adcgs_splats *out, uint32_t to, const adcgs_primitives *p, uint32_t from, const double origin[3],
                          double scale);

/** True if the file begins like one of splats; any PLY file does. */
int adcgs_splats_is(const char *path);
/**
 * Read a file of splats. meta.json of an unpacked SOG stands for its images in the same folder. Harmonics that are all zero are
 * dropped.
 * \return ADCGS_ERR_UNSUPPORTED for unsupported features of the format. ADCGS_ERR_DATA, naming the error and its position, for
 * another kind of file, and one that has no splats, ends early or holds a non-finite number.
 */
adcgs_status adcgs_splats_read(adcgs_splats *out, const char *path, adcgs_error *error);
/** As adcgs_splats_read() from memory, except for meta.json. A zero byte must follow the data. */
adcgs_status adcgs_splats_parse(adcgs_splats *out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error);

/** Options for writing splats. */
typedef struct adcgs_splats_style {
    const char *comment; /**< a line without its newline, for formats that can store one */
    int rest_degree;     /**< 1..3: PLY gets f_rest_* up to this degree, all zero, for programs that require them; 0: none */
    int spz_version;     /**< 2 to 4: version of SPZ; 0: 4 */
    uint8_t axes;        /**< ADCGS_SPLATS_Y_UP... of the written splats; 0: those of the format */
} adcgs_splats_style;

/** ADCGS_ERR_USAGE if the extension, in upper or lower case, is of no format that supports this style. */
adcgs_status adcgs_splats_check_name(const char *path, const adcgs_splats_style *style, adcgs_error *error);
/**
 * The axes that a file of this name and style gets from splats with these axes. Unknown ones, and ADCGS_SPLATS_KEEP, change
 * nothing. By default y is up in SPZ and GLB, which define it. In PLY and SOG y is down: viewers (SuperSplat, splat-transform)
 * take files without defined axes so.
 */
uint8_t adcgs_splats_axes_for(const char *path, const adcgs_splats_style *style, uint8_t axes);
/**
 * Write a file in the format of its extension; only colours of degree 0 are written. Splats are turned about x to the axes of
 * adcgs_splats_axes_for(), and so is their offset. An offset becomes the translation of GLB's node, or a comment "offset X Y
 * Z" of PLY; SPZ and SOG cannot store it. Atomic.
 */
adcgs_status adcgs_splats_write(const adcgs_splats *splats, const adcgs_splats_style *style, const char *path,
                                adcgs_error *error);

#endif

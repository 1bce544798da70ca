/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Point clouds in files: PLY and NPY by our own readers, Draco in a module (draco_shim.h), and from splats. */
#ifndef ADCGS_MEDIA_POINTS_POINTS_H
#define ADCGS_MEDIA_POINTS_POINTS_H

#ifdef __cplusplus
extern "C" {
#endif

#include "base/base.h"

#define ADCGS_POINTS_MAX (1u << 26) /**< points of a cloud; chosen by hand, not measured */

typedef struct adcgs_points {
    uint32_t n;
    double (*position)[3]; /**< finite; binary32 values, except for a cloud too far from the origin */
    uint8_t (*colour)[3];
    int coloured; /**< 0: the file has no colours, and all are mid-grey */
} adcgs_points;

/** Positions are uninitialised, colours grey. */
adcgs_status adcgs_points_alloc(adcgs_points *points, uint64_t n, const char *path, adcgs_error *error);
void adcgs_points_free(adcgs_points *points);
/**
 * Round positions to binary32. A cloud too far from the world's origin is left unrounded, since rounding would move its points
 * against each other. For example, coordinates in metres from the centre of the earth would lose half a metre. Readers of scenes
 * call this once all positions are in world units.
 */
void adcgs_points_round(adcgs_points *points);

/**
 * Read PLY, Draco, NPY, or splats of any format (media/splats/splats.h), detected by content. Points of splats are their centres,
 * with the colours seen from any direction. Coordinates are at most FLT_MAX, and rounded by adcgs_points_round().
 */
adcgs_status adcgs_points_read(adcgs_points *out, const char *path, adcgs_error *error);

/**
 * PLY in memory: ASCII, binary of either byte order. Positions are x, y, z of the element "vertex"; colours are red, green, blue
 * as integers (full range is white) or floats (1 is white). Other properties and elements are skipped. A zero byte must follow
 * the data, as from adcgs_file_load(). Positions are not yet checked to be finite.
 */
adcgs_status adcgs_ply_parse(adcgs_points *out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error);
/** Binary little-endian PLY with float positions and uchar colours. Atomic. */
adcgs_status adcgs_ply_write(const adcgs_points *points, const char *path, adcgs_error *error);

/**
 * NPY in memory, formats 1.0 to 3.0: a little-endian array of binary32 or binary64, shape (n,3), C order, without trailing bytes.
 * A zero byte must follow the data. Positions are not yet checked to be finite.
 */
adcgs_status adcgs_npy_parse(adcgs_points *out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error);

/** Draco in memory, a point cloud or the vertices of a mesh. ADCGS_ERR_UNSUPPORTED without the module. */
adcgs_status adcgs_draco_parse(adcgs_points *out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error);

/** Bits of a coordinate in Draco files; chosen by hand, not measured. */
#define ADCGS_DRACO_BITS 16
/**
 * Write a Draco point cloud with the points in their order. Positions are rounded to ADCGS_DRACO_BITS bits of the longest edge of
 * the bounding box. So the error along each axis is at most half of edge / (2^16 - 1), plus the rounding of binary32. Colours are
 * exact, and left out if points->coloured is 0. The same points give the same bytes. Atomic. ADCGS_ERR_UNSUPPORTED without the
 * module.
 */
adcgs_status adcgs_draco_write(const adcgs_points *points, const char *path, adcgs_error *error);

/**
 * Write PLY or Draco, by extension; ADCGS_ERR_USAGE for another extension. Points are relative to an offset
 * (media/splats/offset.h): PLY stores it in a comment, Draco cannot store it.
 */
adcgs_status adcgs_points_write(const adcgs_points *points, const double offset[3], const char *path, adcgs_error *error);

#ifdef __cplusplus
}
#endif
#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Point clouds in files: PLY and NPY by our own readers, Draco in a module (draco_shim.h). */
#ifndef ADCGS_IO_POINTS_H
#define ADCGS_IO_POINTS_H

#ifdef __cplusplus
extern "C" {
#endif

#include "base/base.h"

#define ADCGS_POINTS_MAX (1u << 26)

typedef struct adcgs_points {
    uint32_t n;
    double (*position)[3]; /**< finite; numbers of binary32, unless the cloud is too far from the origin for them */
    uint8_t (*colour)[3];
    int coloured;         /**< 0: the file has no colours, and they are mid-grey */
} adcgs_points;

/** Uninitialised positions, grey colours. */
adcgs_status adcgs_points_alloc(adcgs_points *points, uint64_t n, const char *path, adcgs_error *error);
void adcgs_points_free(adcgs_points *points);
/**
 * Round positions to binary32, except those of a cloud that lies so far from the origin of the world that rounding would move
 * its points against each other: coordinates in metres from the centre of the earth would lose half a metre. Readers of scenes
 * call it once all is in world units.
 */
void adcgs_points_round(adcgs_points *points);

/** Read PLY, Draco or NPY, told by content. Coordinates are at most FLT_MAX, and rounded as adcgs_points_round() does. */
adcgs_status adcgs_points_read(adcgs_points *out, const char *path, adcgs_error *error);

/**
 * PLY in memory: ASCII, binary of either byte order. Positions are x, y, z of the element "vertex"; colours are red, green,
 * blue as integers (full range is white) or floats (1 is white). Other properties and elements are skipped. A zero byte
 * stands behind the data, as adcgs_file_load() gives it; positions need not be finite yet.
 */
adcgs_status adcgs_ply_parse(adcgs_points *out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error);
/** Binary little-endian PLY with float positions and uchar colours. Atomic. */
adcgs_status adcgs_ply_write(const adcgs_points *points, const char *path, adcgs_error *error);

/**
 * NPY in memory, formats 1.0 to 3.0: a little-endian array of binary32 or binary64, shape (n,3), C order, and nothing behind
 * it. A zero byte stands behind the data; positions need not be finite yet.
 */
adcgs_status adcgs_npy_parse(adcgs_points *out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error);

/** Draco in memory, point cloud or mesh (whose vertices are taken). ADCGS_ERR_UNSUPPORTED without the module. */
adcgs_status adcgs_draco_parse(adcgs_points *out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error);

#define ADCGS_DRACO_BITS 16
/**
 * A Draco point cloud: the points in their order, positions rounded to ADCGS_DRACO_BITS bits of the longest edge of the box round
 * them (so off by at most half of edge / (2^16 - 1) along each axis, and the rounding of binary32), colours as they are, left
 * out if points->coloured is 0. The same points give the same bytes. Atomic. ADCGS_ERR_UNSUPPORTED without the module.
 */
adcgs_status adcgs_draco_write(const adcgs_points *points, const char *path, adcgs_error *error);

/** As PLY or Draco, by the name's extension; ADCGS_ERR_USAGE for another. */
adcgs_status adcgs_points_write(const adcgs_points *points, const char *path, adcgs_error *error);
/** The same of points that an offset is to be added to (io/offset.h): PLY names it in a comment, Draco has no place for it. */
adcgs_status adcgs_points_write_from(const adcgs_points *points, const double offset[3], const char *path, adcgs_error *error);

#ifdef __cplusplus
}
#endif
#endif

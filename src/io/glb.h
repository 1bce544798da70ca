/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Splats as GLB, the binary form of glTF 2.0, by Khronos' extension
 * KHR_gaussian_splatting: points with a rotation (x y z w), a scale (a standard
 * deviation), an opacity (0..1) and coefficients of harmonics each. y is up.
 * From its text, https://github.com/KhronosGroup/glTF,
 * extensions/2.0/Khronos/KHR_gaussian_splatting.
 */
#ifndef ADCGS_IO_GLB_H
#define ADCGS_IO_GLB_H

#include "io/splats.h"

#include <stdio.h>

#define ADCGS_GLB_HEADER 12
#define ADCGS_GLB_CHUNK 8             /**< what each chunk begins with: bytes, type */
#define ADCGS_GLB_JSON 0x4e4f534au    /**< types of chunks */
#define ADCGS_GLB_BINARY 0x004e4942u
#define ADCGS_GLB_FLOAT 5126          /**< a type of components */
#define ADCGS_GLB_SPLATS "KHR_gaussian_splatting"
#define ADCGS_GLB_KERNEL "ellipse"
#define ADCGS_GLB_COLOURS "srgb_rec709_display"

/** Whether the bytes begin as GLB does. */
int adcgs_glb_is(const uint8_t *data, size_t bytes);
/**
 * adcgs_splats_parse() of data that adcgs_glb_is(): all primitives of splats in the file, whose attributes may be of any
 * type of components, or which are packed as SPZ (glb_spz.h), wherever a node of the scene and its parents have them.
 * ADCGS_ERR_UNSUPPORTED for harmonics of degree 4, packing by other extensions, other kernels, linear colours, sparse
 * accessors, buffers outside, and parts that are antialiased where others are not. On failure the caller clears *out.
 */
adcgs_status adcgs_glb_parse(adcgs_splats *out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error);
/**
 * To a file that is open; its errors are the caller's to see. The style's comment is the generator's name. ADCGS_ERR_UNSUPPORTED
 * for no splats, and in a build without jansson.
 */
adcgs_status adcgs_glb_put(const adcgs_splats *splats, const adcgs_splats_style *style, FILE *file, const char *path,
                           adcgs_error *error);

#endif

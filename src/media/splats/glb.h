/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Splats as GLB, the binary form of glTF 2.0, with Khronos' extension
 * KHR_gaussian_splatting. Each splat is a point with a rotation (x y z w), a
 * scale (a standard deviation), an opacity (0..1) and coefficients of spherical
 * harmonics. y is up. From its text, https://github.com/KhronosGroup/glTF,
 * extensions/2.0/Khronos/KHR_gaussian_splatting.
 */
#ifndef ADCGS_MEDIA_SPLATS_GLB_H
#define ADCGS_MEDIA_SPLATS_GLB_H

#include "media/splats/splats.h"

#include <stdio.h>

/* Origin: definition (glTF 2.0, "GLB File Format" and accessor.componentType). */
#define ADCGS_GLB_HEADER 12          /**< size of the file's header [bytes] */
#define ADCGS_GLB_CHUNK 8            /**< size of a chunk's header [bytes]: length, type */
#define ADCGS_GLB_JSON 0x4e4f534au   /**< type of a chunk of JSON */
#define ADCGS_GLB_BINARY 0x004e4942u /**< type of a chunk of numbers */
#define ADCGS_GLB_FLOAT 5126         /**< componentType of binary32 */
#define ADCGS_GLB_SPLATS "KHR_gaussian_splatting"
#define ADCGS_GLB_KERNEL "ellipse"
#define ADCGS_GLB_COLOURS "srgb_rec709_display"

/** True if the bytes begin like GLB. */
int adcgs_glb_is(const uint8_t *data, size_t bytes);
/**
 * adcgs_splats_parse() of data that adcgs_glb_is() accepts. Reads all splat primitives of the file, once per node of the scene
 * that has them, with the transforms of its parents applied. Attributes may have any component type, or be packed as SPZ
 * (glb_spz.h). ADCGS_ERR_UNSUPPORTED for harmonics of degree 4, packing by other extensions, other kernels, linear colours,
 * sparse accessors, external buffers, and a mix of antialiased and other parts. On failure the caller clears *out.
 */
adcgs_status adcgs_glb_parse(adcgs_splats *out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error);
/**
 * Write to an open file; the caller checks it for errors. The style's comment is the generator's name. ADCGS_ERR_UNSUPPORTED for
 * zero splats, and in a build without jansson.
 */
adcgs_status adcgs_glb_put(const adcgs_splats *splats, const adcgs_splats_style *style, FILE *file, const char *path,
                           adcgs_error *error);

#endif

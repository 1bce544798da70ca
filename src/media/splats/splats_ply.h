/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The PLY of 3D Gaussian splatting, with one vertex per splat and the
 * properties x y z, nx ny nz (zero, unused), f_dc_0..2, f_rest_*, opacity,
 * scale_0..2 and rot_0..3. Its numbers are those before the activations: colour
 * = 0.5 + ADCGS_SPLATS_DC f_dc, opacity a logit, scales natural logarithms, the
 * quaternion w x y z of any length. Two conventions of comments mark splats
 * trained with antialiasing: Brush's "SplatRenderMode: mip" and Postshot's
 * "antialiased 1". Compressed PLY is read, too (media/splats/ply_packed.h).
 */
#ifndef ADCGS_MEDIA_SPLATS_SPLATS_PLY_H
#define ADCGS_MEDIA_SPLATS_SPLATS_PLY_H

#include "media/splats/splats.h"

#include <stdio.h>

/**
 * adcgs_splats_parse() of data that adcgs_ply_is() accepts: text, or binary of either byte order; float or double properties, in
 * any order. nx, ny, nz and unknown properties are skipped; f_rest_* must be none, 9, 24 or 45. An opacity of +inf is 1, of -inf
 * 0. Scales below -80, down to -inf, are flat, and so is the third axis without scale_2 (surfels of 2DGS). ADCGS_ERR_UNSUPPORTED
 * for splats over time, ADCGS_ERR_DATA also for a scale above e^80. On failure the caller
 * clears *out.
 */
adcgs_status adcgs_splats_parse_ply(adcgs_splats *out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error);
/**
 * Write binary little-endian PLY to an open file; the caller checks it for errors. ADCGS_ERR_UNSUPPORTED for an opacity of 0 or
 * 1.
 */
adcgs_status adcgs_splats_put_ply(const adcgs_splats *splats, const adcgs_splats_style *style, FILE *file, const char *path,
                                  adcgs_error *error);

#endif

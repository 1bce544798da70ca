/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Splats as SOG, PlayCanvas' format: meta.json and lossless WebP images with
 * one pixel per splat, in a ZIP archive. Positions are stored as 16 bits of a
 * logarithm, rotations as 26 bits, opacities as 8 bits, scales and colours as
 * indices into codebooks of 256. y is up. From its text,
 * https://developer.playcanvas.com/user-manual/gaussian-splatting/formats/sog.
 */
#ifndef ADCGS_MEDIA_SPLATS_SOG_H
#define ADCGS_MEDIA_SPLATS_SOG_H

#include "media/splats/splats.h"

#include <stdio.h>

/**
 * Write version 2 to an open file; the caller checks it for errors. The splats are sorted along a Morton curve. The style's
 * comment is the generator's name. ADCGS_ERR_UNSUPPORTED for zero splats, and in a build without libwebp.
 */
adcgs_status adcgs_sog_put(const adcgs_splats *splats, const adcgs_splats_style *style, FILE *file, const char *path,
                           adcgs_error *error);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Splats as SOG, PlayCanvas' format: meta.json and lossless WebP pictures with
 * a pixel for each splat, in a ZIP archive. Positions are 16 bits of a
 * logarithm, rotations 26 bits, opacities 8, scales and colours places in
 * codebooks of 256. y is up. From its text,
 * https://developer.playcanvas.com/user-manual/gaussian-splatting/formats/sog.
 */
#ifndef ADCGS_IO_SOG_H
#define ADCGS_IO_SOG_H

#include "io/splats.h"

#include <stdio.h>

/**
 * Version 2, to a file that is open; its errors are the caller's to see. The splats are sorted along a curve of Morton's. The
 * style's comment is the generator's name. ADCGS_ERR_UNSUPPORTED for no splats, and in a build without libwebp.
 */
adcgs_status adcgs_sog_put(const adcgs_splats *splats, const adcgs_splats_style *style, FILE *file, const char *path,
                           adcgs_error *error);

#endif

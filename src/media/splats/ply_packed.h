/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Splats as compressed PLY, the format of PlayCanvas' SuperSplat. The element
 * "chunk" has the bounds of 256 splats: positions, logarithms of scales and, in
 * newer files, colours. The vertices are four words: the position and the scale
 * in 11, 10 and 11 bits within the bounds; the rotation as the index of its
 * largest component (w x y z) and 10 bits for each other one; colour and opacity
 * in 8 bits each. The element "sh" has the harmonics, f_rest_*, as bytes.
 */
#ifndef ADCGS_MEDIA_SPLATS_PLY_PACKED_H
#define ADCGS_MEDIA_SPLATS_PLY_PACKED_H

#include "media/points/ply.h"
#include "media/splats/splats.h"

/** True if the vertices are packed. */
int adcgs_ply_packed_is(adcgs_ply *ply);
/** adcgs_splats_parse() of a PLY file with packed vertices. On failure the caller clears *out. */
adcgs_status adcgs_ply_packed_parse(adcgs_splats *out, adcgs_ply *ply);

#endif

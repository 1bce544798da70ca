/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Splats transformed by a matrix, as in a scene graph. */
#ifndef ADCGS_MEDIA_SPLATS_SPLATS_MOVE_H
#define ADCGS_MEDIA_SPLATS_SPLATS_MOVE_H

#include "media/splats/splats.h"

/**
 * Transform splats by a row-major 3x4 matrix. Any invertible linear part is allowed, not only a rotation and scale; it changes
 * the shape of ellipsoids. Harmonics turn with the nearest rotation or reflection (the polar decomposition's). ADCGS_ERR_DATA,
 * naming path, for a singular matrix, and for splats that it moves beyond the range of binary32.
 */
adcgs_status adcgs_splats_move(adcgs_splats *splats, const double matrix[12], const char *path, adcgs_error *error);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Splats moved by a matrix, as a scene's graph has them. */
#ifndef ADCGS_IO_SPLATS_MOVE_H
#define ADCGS_IO_SPLATS_MOVE_H

#include "io/splats.h"

/**
 * Move splats by a row-major 3x4 matrix: a rotation, a size and a place, or anything else that does not flatten. What is no
 * rotation and size makes other ellipsoids; harmonics turn with the nearest rotation or reflection (the polar decomposition's).
 * ADCGS_ERR_DATA, naming path, for a matrix that flattens, and for splats that it moves beyond what binary32 holds.
 */
adcgs_status adcgs_splats_move(adcgs_splats *splats, const double matrix[12], const char *path, adcgs_error *error);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The nodes of a GLB file: where they have a mesh. */
#ifndef ADCGS_IO_GLB_NODES_H
#define ADCGS_IO_GLB_NODES_H

#include "io/glb_numbers.h"

/**
 * The row-major 3x4 matrix of the node that uses a mesh, its parents' before it; *moves is 0 where it is the unit matrix, or
 * there is no such node. ADCGS_ERR_UNSUPPORTED for several of them.
 */
adcgs_status adcgs_glb_place(double matrix[12], int *moves, const adcgs_glb *glb, size_t mesh);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The nodes of a GLB file: where they have a mesh. */
#ifndef ADCGS_IO_GLB_NODES_H
#define ADCGS_IO_GLB_NODES_H

#include "io/glb_numbers.h"

#define ADCGS_GLB_PLACES 4096 /**< nodes of one mesh at most */

/** Where the nodes that use a mesh have it: row-major 3x4 matrices, those of parents before a node's own. */
typedef struct adcgs_glb_places {
    size_t n;              /**< 1 and more */
    double (*matrix)[12];
} adcgs_glb_places;

/**
 * The nodes of the file's scene, or where none of these has the mesh of the whole file; the unit matrix where no node has it.
 * ADCGS_ERR_UNSUPPORTED for more than ADCGS_GLB_PLACES nodes, or parents above one of them more than 256 deep. The caller clears
 * *out in any case.
 */
adcgs_status adcgs_glb_places_find(adcgs_glb_places *out, const adcgs_glb *glb, size_t mesh);
void adcgs_glb_places_clear(adcgs_glb_places *places);
/** Whether a matrix is another than the unit matrix. */
int adcgs_glb_moves(const double matrix[12]);

#endif

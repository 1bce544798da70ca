/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Nodes of a GLB file, which place meshes in the scene. */
#ifndef ADCGS_MEDIA_SPLATS_GLB_NODES_H
#define ADCGS_MEDIA_SPLATS_GLB_NODES_H

#include "media/splats/glb_numbers.h"

#define ADCGS_GLB_PLACES 4096 /**< maximum number of nodes per mesh; chosen by hand, not measured */

/** Transforms of the nodes that use a mesh: row-major 3x4 matrices, with the parents' transforms applied. */
typedef struct adcgs_glb_places {
    size_t n; /**< at least 1 */
    double (*matrix)[12];
} adcgs_glb_places;

/**
 * Find the nodes of the file's scene that use a mesh. Without any, find those of the whole file; if no node uses it, return the
 * unit matrix. ADCGS_ERR_UNSUPPORTED for more than ADCGS_GLB_PLACES nodes, or more than 256 parents above a node. The caller
 * clears *out in any case.
 */
adcgs_status adcgs_glb_places_find(adcgs_glb_places *out, const adcgs_glb *glb, size_t mesh);
void adcgs_glb_places_clear(adcgs_glb_places *places);
/** True if a matrix differs from the unit matrix. */
int adcgs_glb_moves(const double matrix[12]);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Columns of a PLY file as arrays of binary32. */
#ifndef ADCGS_MEDIA_DYNAMIC_PLY_COLUMNS_H
#define ADCGS_MEDIA_DYNAMIC_PLY_COLUMNS_H

#include "media/points/ply.h"
#include "media/splats/splats.h"

typedef struct adcgs_ply_column {
    const char *name; /**< of a property of the vertices */
    float *to;        /**< [vertices], `stride` floats apart */
    size_t stride;    /**< 1: no gaps */
} adcgs_ply_column;

#define ADCGS_PLY_SPLAT_COLUMNS 14 /**< definition (3D Gaussian splatting): place, f_dc, opacity, scale, rot */

/** The columns that all splats have, before activation, as arrays of the splats. */
void adcgs_ply_splat_columns(adcgs_ply_column columns[ADCGS_PLY_SPLAT_COLUMNS], const adcgs_splats *splats);
/** True if a header in the first bytes of a PLY file declares a property of this name; for is() of readers. */
int adcgs_ply_declares(const uint8_t *data, size_t bytes, const char *property);
/** A use of a table of columns. */
typedef adcgs_status (*adcgs_ply_columns_fn)(adcgs_ply *ply, const adcgs_ply_column *columns, size_t n);
/**
 * Find all columns, before memory is allocated for them: their `to` may be NULL. ADCGS_ERR_DATA, naming it, for a missing
 * property, or one that is neither float nor double.
 */
adcgs_status adcgs_ply_find_columns(adcgs_ply *ply, const adcgs_ply_column *columns, size_t n);
/** Find all columns and read them at once. Numbers are not checked. */
adcgs_status adcgs_ply_columns(adcgs_ply *ply, const adcgs_ply_column *columns, size_t n);

#endif

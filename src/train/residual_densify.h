/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * What is missing. Anchors grow where primitives already are, so small bright things far from all of them are never found. But
 * where several cameras see one moment, light that is taken and not drawn has a place: the one along a pixel's ray where the
 * other cameras miss it too, and where what is beside it in the picture is missing as well: cameras agree at many places along a
 * ray, above all of lights in rows, and two of them nearly anywhere. Densification by error is that of Rota Bulo, Porzi and
 * Kontschieder (Revising densification in Gaussian splatting, ECCV 2024); that cameras have to agree on a place is
 * photo-consistency (Kutulakos and Seitz 2000, A theory of shape by space carving, IJCV).
 */
#ifndef ADCGS_TRAIN_RESIDUAL_DENSIFY_H
#define ADCGS_TRAIN_RESIDUAL_DENSIFY_H

#include "train/state.h"

typedef struct adcgs_residual {
    float x[3];   /**< scene units */
    float rgb[3];
    float size;   /**< of a pixel there, scene units */
    float score;  /**< difference, summed over the cameras that agree on it */
} adcgs_residual;

/**
 * Places where something is missing in the views nearest to one of the training's moments, the worst first; n of at most `most`.
 * None where fewer than three views share the moment.
 */
adcgs_status adcgs_residual_find(adcgs_trainer *trainer, adcgs_residual *places, uint32_t most, uint32_t *n, adcgs_error *error);

#endif

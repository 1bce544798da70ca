/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Densification from residuals. Anchors grow where primitives already exist, so small bright objects far from all of them are
 * never found. Where several cameras see one frame, light that is recorded but not rendered has a position. It is the point on a
 * pixel's ray where the other cameras miss light as well, and where nearby pixels miss it too. The second condition is needed
 * because cameras agree at many points of a ray, above all for lights in rows, and two cameras nearly anywhere. Densification by
 * error is that of Rota Bulo, Porzi and Kontschieder (Revising densification in Gaussian splatting, ECCV 2024); the agreement of
 * cameras on a position is photo-consistency (Kutulakos and Seitz 2000, A theory of shape by space carving, IJCV).
 */
#ifndef ADCGS_TRAIN_DENSITY_RESIDUAL_DENSIFY_H
#define ADCGS_TRAIN_DENSITY_RESIDUAL_DENSIFY_H

#include "train/state/state.h"

typedef struct adcgs_residual {
    float x[3]; /**< scene units */
    float rgb[3];
    float size;  /**< of a pixel there, scene units */
    float score; /**< residual, summed over the cameras that agree */
} adcgs_residual;

/**
 * Finds positions of missing light in the views of a frame in training, the largest residual first. *n: their number, at most
 * `most`; 0 if fewer than three views share the frame.
 */
adcgs_status adcgs_residual_find(adcgs_trainer *trainer, adcgs_residual *places, uint32_t most, uint32_t *n, adcgs_error *error);

#endif

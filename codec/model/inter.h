/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Inter-segment prediction (spec clause "Anchors that are kept"). A predicted segment is coded relative to the segment before it:
 * each anchor of that segment is dropped, kept unchanged, or kept with differences of f_v, Sigma_v and C_v in whole steps. A kept
 * anchor has the same position, flags, mask, eta and f_g. One walk defines the order and the contexts of both directions.
 */
#ifndef ADCGS_MODEL_INTER_H
#define ADCGS_MODEL_INTER_H

#include "model/model.h"

typedef enum adcgs_keep_mode { ADCGS_KEEP_DROPPED, ADCGS_KEEP_SAME, ADCGS_KEEP_REFINED } adcgs_keep_mode;

/** The groups of latents that have differences; each group has its own contexts. */
typedef enum adcgs_keep_group { ADCGS_KEEP_FV, ADCGS_KEEP_SIGMA, ADCGS_KEEP_COLOUR, ADCGS_KEEP_GROUPS } adcgs_keep_group;

/** Zero-initialise before use. */
typedef struct adcgs_keep {
    uint8_t *mode;                     /**< [anchors before] adcgs_keep_mode */
    int16_t *rows[ADCGS_KEEP_GROUPS];  /**< latents of the model before, with the differences of refined anchors added */
    uint32_t n;                        /**< anchors that are not dropped */
} adcgs_keep;

void adcgs_kept_clear(adcgs_keep *kept, adcgs_memory *memory);

/** Upper bound of the work of decoding the modes after this model (spec "Levels"), in coded values. */
uint64_t adcgs_kept_values(const adcgs_model *before);

/** Decode with a decoder that has been started; the function finishes it. */
adcgs_status adcgs_kept_decode(adcgs_keep *kept, const adcgs_model *before, adcgs_range_dec *range, adcgs_memory *memory,
                               adcgs_error *error);
/** Append the sub-stream to out. */
adcgs_status adcgs_kept_encode(const adcgs_keep *kept, const adcgs_model *before, adcgs_buffer *out, adcgs_error *error);

/**
 * Whether a model can follow another as a predicted segment. It must share parameters, grid, shapes, steps and the prior of eta,
 * and must have every network that the other has. If not, why names the part that differs.
 */
int adcgs_kept_possible(const adcgs_model *before, const adcgs_model *now, adcgs_error *why);
/** Find the anchors of the model before that recur in the next model: same place, and equal where differences do not apply. */
adcgs_status adcgs_kept_find(adcgs_keep *kept, const adcgs_model *before, const adcgs_model *now, adcgs_error *error);
/** Assign anchors of `now` that are not kept to the first tier: new anchors must be of that tier. */
adcgs_status adcgs_kept_renew(adcgs_model *now, const adcgs_model *before, adcgs_error *error);
/** The anchors that are not kept, with the model's networks and steps: the contents of GEOM and layers. The caller clears it. */
adcgs_status adcgs_kept_rest(adcgs_model *rest, const adcgs_keep *kept, const adcgs_model *before, const adcgs_model *now,
                             adcgs_error *error);
/** The kept anchors as a model without networks. The caller clears it, also on failure. */
adcgs_status adcgs_kept_model(adcgs_model *stay, const adcgs_keep *kept, const adcgs_model *before, adcgs_memory *memory,
                              adcgs_error *error);

#endif

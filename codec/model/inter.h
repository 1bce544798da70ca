/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Inter-segment prediction (spec clause "Anchors that are kept"). A predicted segment is coded relative to the segment before it:
 * each anchor of that segment is dropped, kept unchanged, or kept with differences of f_v, Sigma_v and C_v in whole steps. A kept
 * anchor has the same position, flags, mask, eta and f_g. One walk defines the order and the contexts of both directions.
 */
#ifndef ADCGS_MODEL_INTER_H
#define ADCGS_MODEL_INTER_H

#include "model/model.h"

typedef enum adcgs_inter_mode { ADCGS_INTER_DROPPED, ADCGS_INTER_SAME, ADCGS_INTER_REFINED } adcgs_inter_mode;

/** The groups of latents that have differences; each group has its own contexts. */
typedef enum adcgs_inter_group { ADCGS_INTER_FV, ADCGS_INTER_SIGMA, ADCGS_INTER_COLOUR, ADCGS_INTER_GROUPS } adcgs_inter_group;

/** Zero-initialise before use. */
typedef struct adcgs_inter {
    uint8_t *mode;                     /**< [anchors before] adcgs_inter_mode */
    int16_t *rows[ADCGS_INTER_GROUPS]; /**< latents of the model before, with the differences of refined anchors added */
    uint32_t n;                        /**< anchors that are not dropped */
} adcgs_inter;

void adcgs_inter_clear(adcgs_inter *kept, adcgs_memory *memory);

/** Upper bound of the work of decoding the modes after this model (spec "Levels"), in coded values. */
uint64_t adcgs_inter_values(const adcgs_model *before);

/** Decode with a decoder that has been started; the function finishes it. */
adcgs_status adcgs_inter_decode(adcgs_inter *kept, const adcgs_model *before, adcgs_range_dec *range, adcgs_memory *memory,
                                adcgs_error *error);
/** Append the sub-stream to out. */
adcgs_status adcgs_inter_encode(const adcgs_inter *kept, const adcgs_model *before, adcgs_buffer *out, adcgs_error *error);

/**
 * Whether a model can follow another as a predicted segment. It must share parameters, grid, steps and the prior of eta,
 * and must have every network that the other has. If not, why names the part that differs.
 */
int adcgs_inter_possible(const adcgs_model *before, const adcgs_model *now, adcgs_error *why);
/** Find the anchors of the model before that recur in the next model: same place, and equal where differences do not apply. */
adcgs_status adcgs_inter_find(adcgs_inter *kept, const adcgs_model *before, const adcgs_model *now, adcgs_error *error);
/** Assign anchors of `now` that are not kept to the first tier: new anchors must be of that tier. */
adcgs_status adcgs_inter_renew(adcgs_model *now, const adcgs_model *before, adcgs_error *error);
/** The anchors that are not kept, with the model's networks and steps: the contents of GEOM and layers. The caller clears it. */
adcgs_status adcgs_inter_rest(adcgs_model *rest, const adcgs_inter *kept, const adcgs_model *before, const adcgs_model *now,
                              adcgs_error *error);
/** The kept anchors as a model without networks. The caller clears it, also on failure. */
adcgs_status adcgs_inter_model(adcgs_model *stay, const adcgs_inter *kept, const adcgs_model *before, adcgs_memory *memory,
                               adcgs_error *error);

#endif

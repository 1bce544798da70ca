/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * What a predicted segment takes from the segment before it (spec clause "Anchors that are kept"): each of its anchors is
 * dropped, kept as it is, or kept with differences of f_v, Sigma_v and C_v in whole steps. Position, flags, mask, eta and f_g of
 * what is kept stay. One walk defines the order and the contexts of both directions.
 */
#ifndef ADCGS_MODEL_KEEP_H
#define ADCGS_MODEL_KEEP_H

#include "model/model.h"

typedef enum adcgs_keep_mode { ADCGS_KEEP_DROPPED, ADCGS_KEEP_SAME, ADCGS_KEEP_REFINED } adcgs_keep_mode;

/** The groups that differences are of; also their contexts. */
typedef enum adcgs_keep_group { ADCGS_KEEP_FV, ADCGS_KEEP_SIGMA, ADCGS_KEEP_COLOUR, ADCGS_KEEP_GROUPS } adcgs_keep_group;

/** Zero-initialise before use. */
typedef struct adcgs_keep {
    uint8_t *mode;                     /**< [anchors before] adcgs_keep_mode */
    int16_t *rows[ADCGS_KEEP_GROUPS];  /**< latents as in the model before, but with the differences of what is refined */
    uint32_t n;                        /**< anchors that are not dropped */
} adcgs_keep;

void adcgs_kept_clear(adcgs_keep *kept, adcgs_memory *memory);

/** Work that decoding the modes after this model takes at most (spec "Levels"), in coded values. */
uint64_t adcgs_kept_values(const adcgs_model *before);

/** Decode from a decoder that has been started; it is finished here. */
adcgs_status adcgs_kept_decode(adcgs_keep *kept, const adcgs_model *before, adcgs_range_dec *range, adcgs_memory *memory,
                               adcgs_error *error);
/** Append the sub-stream. */
adcgs_status adcgs_kept_encode(const adcgs_keep *kept, const adcgs_model *before, adcgs_buffer *out, adcgs_error *error);

/**
 * Whether a model can follow another as a predicted segment at all: it shares parameters, grid, shapes, steps and the prior of
 * eta, and lacks no network that the other has. If not, why says what is another.
 */
int adcgs_kept_possible(const adcgs_model *before, const adcgs_model *now, adcgs_error *why);
/** What of the model before is found again in the one after it: at its place, with all that differences do not reach. */
adcgs_status adcgs_kept_find(adcgs_keep *kept, const adcgs_model *before, const adcgs_model *now, adcgs_error *error);
/** New anchors are of the first tier: have those be that are not found again. */
adcgs_status adcgs_kept_renew(adcgs_model *now, const adcgs_model *before, adcgs_error *error);
/** The anchors of a model that are not kept, with its networks and steps: what GEOM and layers hold. The caller clears it. */
adcgs_status adcgs_kept_rest(adcgs_model *rest, const adcgs_keep *kept, const adcgs_model *before, const adcgs_model *now,
                             adcgs_error *error);
/** What is kept, as a model without networks. The caller clears it, also on failure. */
adcgs_status adcgs_kept_model(adcgs_model *stay, const adcgs_keep *kept, const adcgs_model *before, adcgs_memory *memory,
                              adcgs_error *error);

#endif

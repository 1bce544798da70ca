/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The latent chain (spec clause "Latent chain"): eta -> f_v -> Sigma_v, C_v ->
 * f_g chunk by chunk. One walk defines the order and the contexts. A visitor
 * defines the operation on each group of values (decode, encode, quantise, count).
 */
#ifndef ADCGS_MODEL_LATENTS_H
#define ADCGS_MODEL_LATENTS_H

#include "model/model.h"
#include "base/thread_pool.h"

#define ADCGS_SLICE_LOG2_MIN 6
#define ADCGS_SLICE_LOG2_MAX 16
#define ADCGS_SLICE_LOG2_DEFAULT 10

/** The values of one group at one anchor (and one primitive, for f_g). */
typedef struct adcgs_latent_site {
    uint32_t anchor;
    int k;             /**< primitive for f_g, else -1 */
    int group;         /**< adcgs_group */
    int first, count;  /**< channels [first, first+count) of the latent's row */
    const int16_t *mu; /**< [count], 1/64 step */
    const uint8_t *si; /**< [count] */
    int16_t *yq;       /**< [count], in the model */
} adcgs_latent_site;

/** Called for every site in coding order within a slice. It must leave yq final, since later values use it as context. */
typedef void (*adcgs_latent_visit)(void *user, const adcgs_latent_site *site);

typedef struct adcgs_latents adcgs_latents;
/** Prepare the entropy networks of a model, which must outlive the result and keep its networks unchanged. */
adcgs_status adcgs_latents_create(adcgs_latents **out, const adcgs_model *model, adcgs_cpu_level cpu, adcgs_memory *memory,
                                  adcgs_error *error);
void adcgs_latents_free(adcgs_latents **latents);
/** Working memory of one walk in bytes: a multiple of the alignment of adcgs_alloc(), so that several fit in a row. */
size_t adcgs_latents_room(const adcgs_latents *latents);

/**
 * Walk one layer (0..4) of anchors [begin, end) in coding order; begin and end are multiples of 64, or end == n.
 * Layer m needs layers < m of the same anchors to be final; layer 0 needs flags, bodies and masks. Layer m > 0 also sets f_g of
 * primitives that do not exist to 0. Threads may walk disjoint ranges concurrently. Fails only on allocation failure.
 */
adcgs_status adcgs_latents_walk(const adcgs_latents *latents, adcgs_model *model, int layer, uint32_t begin, uint32_t end,
                                adcgs_latent_visit visit, void *user, adcgs_error *error);

/** Append the sub-stream of (layer, [begin,end)). ADCGS_ERR_USAGE names a value that the networks cannot represent. */
adcgs_status adcgs_latents_encode(const adcgs_latents *latents, adcgs_model *model, int layer, uint32_t begin, uint32_t end,
                                  adcgs_buffer *out, adcgs_error *error);
/**
 * Decode it with a decoder that has been started. The function finishes it; on success it holds its final state. room has
 * adcgs_latents_room() bytes, aligned as by adcgs_alloc(). The function allocates nothing.
 */
adcgs_status adcgs_latents_decode(const adcgs_latents *latents, adcgs_model *model, int layer, uint32_t begin, uint32_t end,
                                  adcgs_range_dec *range, void *room, adcgs_error *error);
/** Decode only the flags, bodies and masks at the start of the sub-stream of layer 0. */
adcgs_status adcgs_latents_decode_flags(adcgs_model *model, uint32_t begin, uint32_t end, adcgs_range_dec *range,
                                        adcgs_error *error);
/** Fill an absent layer: every n = 0, so yq = mu. For layer 0 also masks and flags: all present, none static, no bodies. */
adcgs_status adcgs_latents_conceal(const adcgs_latents *latents, adcgs_model *model, int layer, uint32_t begin, uint32_t end);

#endif

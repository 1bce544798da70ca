/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Parts of the latent chain that decoding and encoding share. */
#ifndef ADCGS_MODEL_LATENTS_PRIV_H
#define ADCGS_MODEL_LATENTS_PRIV_H

#include "model/latents.h"

/** Code one flag with its context: a decoder returns the bit that it read, an encoder writes and returns bit. */
typedef int (*adcgs_flag_fn)(void *user, adcgs_adaptive *context, int bit);

/**
 * Walk static flags, bodies and masks of anchors [begin, end) in coding order; the model receives the values that code returns.
 * Fails if code returns an impossible body.
 */
adcgs_status adcgs_latents_flags(adcgs_model *model, uint32_t begin, uint32_t end, adcgs_flag_fn code, void *user,
                                 adcgs_error *error);

/** adcgs_latents_walk() in working memory of the caller, adcgs_latents_room() bytes. */
void adcgs_latents_walk_in(const adcgs_latents *latents, adcgs_model *model, int layer, uint32_t begin, uint32_t end,
                           adcgs_latent_visit visit, void *user, void *room);

#endif

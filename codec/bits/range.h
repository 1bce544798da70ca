/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The range coder: 64-bit range, 32-bit renormalisation, 16-bit
 * probabilities (decision D4; spec clause "Parsing process"). One engine
 * serves features, geometry and weights.
 *
 * Decoder errors are sticky: a damaged sub-stream decodes to arbitrary values
 * in bounded time, and adcgs_range_dec_finish() reports the damage.
 */
#ifndef ADCGS_BITS_RANGE_H
#define ADCGS_BITS_RANGE_H

#include "base/base.h"
#include "bits/bytes.h"

typedef struct adcgs_range_dec {
    uint64_t range, value;
    const uint8_t *next, *end;
    int zeros;  /**< virtual zero bytes consumed past the end, saturating */
    int broken; /**< value was out of range at the start or more than 8 virtual bytes were used */
} adcgs_range_dec;

void adcgs_range_dec_init(adcgs_range_dec *d, const uint8_t *data, size_t bytes);
/** cdf: n+1 entries, cdf[0] = 0 < ... < cdf[n] = 65536. Returns the symbol in [0, n). */
int adcgs_range_dec_symbol(adcgs_range_dec *d, const uint32_t *cdf, int n);
/** n raw bits, 1..16. */
uint32_t adcgs_range_dec_bits(adcgs_range_dec *d, int n);
/** One binary decision with P(1) = p1/65536, p1 in 1..65535. */
int adcgs_range_dec_bit(adcgs_range_dec *d, uint32_t p1);
/** ADCGS_ERR_DATA unless the decoder consumed the sub-stream exactly (spec "End of a sub-stream"). */
adcgs_status adcgs_range_dec_finish(const adcgs_range_dec *d, adcgs_error *error);

typedef struct adcgs_range_enc {
    uint64_t low, range;
    adcgs_buffer *out; /**< appended to */
    size_t start;      /**< size of out when coding began */
} adcgs_range_enc;

void adcgs_range_enc_init(adcgs_range_enc *e, adcgs_buffer *out);
void adcgs_range_enc_symbol(adcgs_range_enc *e, const uint32_t *cdf, int n, int symbol);
void adcgs_range_enc_bits(adcgs_range_enc *e, uint32_t value, int n);
void adcgs_range_enc_bit(adcgs_range_enc *e, uint32_t p1, int bit);
/** Write the shortest tail that a decoder completes with zeros. */
void adcgs_range_enc_finish(adcgs_range_enc *e);

/** Adaptive probability of a binary decision: 16-bit P(1) and a hit count that sets the adaptation rate. */
typedef struct adcgs_adaptive {
    uint16_t p1;
    uint16_t count;
} adcgs_adaptive;

/* clang-format off */
#define ADCGS_ADAPTIVE_INIT { 32768, 0 }
/* clang-format on */
/** p1 = 32768, count = 0 for n contexts. */
void adcgs_adaptive_init(adcgs_adaptive *contexts, size_t n);
/** The rule of clause "Adaptive decisions" (decision D4); shared by coder and decoder. */
void adcgs_adaptive_update(adcgs_adaptive *context, int bit);
int adcgs_adaptive_dec(adcgs_range_dec *d, adcgs_adaptive *context);
void adcgs_adaptive_enc(adcgs_range_enc *e, adcgs_adaptive *context, int bit);
/** Cost of a bit in 1/65536 bit under the current state, from an integer table; for encoder decisions. */
uint32_t adcgs_bit_cost(uint32_t p1, int bit);

#endif

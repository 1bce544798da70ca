/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The range encoder: the interval [low, low + range); a carry propagates into bytes already written. */
#include "bits/range.h"

static void put_word(adcgs_range_enc *e, uint32_t word)
{
    const uint8_t big[4] = {(uint8_t)(word >> 24), (uint8_t)(word >> 16), (uint8_t)(word >> 8), (uint8_t)word};
    adcgs_write_bytes(e->out, big, 4);
}

static void propagate_carry(adcgs_range_enc *e)
{
    for (size_t i = e->out->size; i > e->start; i--)
        if (++e->out->data[i - 1])
            return;
}

static void advance(adcgs_range_enc *e, uint64_t below, uint64_t range)
{
    e->low += below;
    if (e->low < below)
        propagate_carry(e);
    e->range = range;
    if (range >> 32)
        return;
    put_word(e, (uint32_t)(e->low >> 32));
    e->low <<= 32;
    e->range <<= 32;
}

void adcgs_range_enc_init(adcgs_range_enc *e, adcgs_buffer *out)
{
    *e = (adcgs_range_enc){.range = UINT64_MAX, .out = out, .start = out->size};
}

void adcgs_range_enc_symbol(adcgs_range_enc *e, const uint32_t *cdf, int n, int symbol)
{
    const uint64_t r = e->range >> 16, below = r * cdf[symbol];
    advance(e, below, symbol + 1 == n ? e->range - below : r * (cdf[symbol + 1] - cdf[symbol]));
}

void adcgs_range_enc_bits(adcgs_range_enc *e, uint32_t value, int n)
{
    const uint64_t r = e->range >> n;
    advance(e, r * value, r);
}

void adcgs_range_enc_bit(adcgs_range_enc *e, uint32_t p1, int bit)
{
    const uint64_t split = (e->range >> 16) * p1;
    if (bit)
        advance(e, 0, split);
    else
        advance(e, split, e->range - split);
}

void adcgs_range_enc_finish(adcgs_range_enc *e)
{
    uint64_t value = e->low;
    int kept = 8;
    /* Try the fewest leading bytes first: round low up to a multiple of 2^(64 - 8 kept); it must stay below low + range. */
    for (int bytes = 0; bytes < 8; bytes++) {
        const uint64_t mask = bytes ? UINT64_MAX >> 8 * bytes : UINT64_MAX;
        const uint64_t add = -e->low & mask;
        if (add < e->range) {
            value = e->low + add;
            kept = bytes;
            break;
        }
    }
    if (value < e->low)
        propagate_carry(e);
    for (int i = 0; i < kept; i++)
        adcgs_write_uint(e->out, value >> (56 - 8 * i) & 255, 1);
}

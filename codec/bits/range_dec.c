/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The range decoder. State: value V < range R, both unsigned 64-bit;
 * R >= 2^32 before every symbol, so one refill of four bytes is enough.
 */
#include "bits/range.h"

/* A decoder may read this many bytes past the end of its sub-stream, as zeros. */
#define VIRTUAL_BYTES_MAX 8

static uint32_t next_word_at_end(adcgs_range_dec *d)
{
    uint32_t word = 0;
    for (int i = 0; i < 4; i++) {
        word <<= 8;
        if (d->next < d->end)
            word |= *d->next++;
        else if (d->zeros <= VIRTUAL_BYTES_MAX)
            d->zeros++;
    }
    return word;
}

/* Four bytes, most significant first. */
static inline uint32_t next_word(adcgs_range_dec *d)
{
    if (d->end - d->next < 4)
        return next_word_at_end(d);
    const uint8_t *p = d->next;
    d->next += 4;
    return (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3];
}

static inline void renormalise(adcgs_range_dec *d)
{
    if (d->range >> 32)
        return;
    d->range <<= 32;
    d->value = d->value << 32 | next_word(d);
}

void adcgs_range_dec_init(adcgs_range_dec *d, const uint8_t *data, size_t bytes)
{
    static const uint8_t nothing[1];
    if (!data)
        data = nothing;
    *d = (adcgs_range_dec){.range = UINT64_MAX, .next = data, .end = data + bytes};
    const uint64_t high = next_word(d);
    d->value = high << 32 | next_word(d);
    d->broken = d->value == UINT64_MAX;
}

/* Largest k with r * cdf[k] <= value; quotient <= 65535 stands for value / r. */
static inline int search(const uint32_t *cdf, int n, uint32_t quotient)
{
    int k = 0;
    for (int width = n; width > 1;) {
        const int half = width / 2;
        k = quotient >= cdf[k + half] ? k + half : k;
        width -= half;
    }
    return k;
}

int adcgs_range_dec_symbol(adcgs_range_dec *d, const uint32_t *cdf, int n)
{
    const uint64_t r = d->range >> 16;
    /* The tables of values peak in the middle: at small sigma this test usually saves the division. */
    int k = (n - 2) / 2;
    if (n < 2 || d->value < r * cdf[k] || d->value >= r * cdf[k + 1]) {
        const uint64_t quotient = d->value / r;
        k = search(cdf, n, quotient > 65535 ? 65535 : (uint32_t)quotient);
    }
    const uint64_t below = r * cdf[k];
    d->value -= below;
    d->range = k + 1 == n ? d->range - below : r * (cdf[k + 1] - cdf[k]);
    renormalise(d);
    return k;
}

uint32_t adcgs_range_dec_bits(adcgs_range_dec *d, int n)
{
    const uint64_t r = d->range >> n, largest = (UINT64_C(1) << n) - 1;
    uint64_t v = d->value / r;
    if (v > largest) {
        /* Only damaged data gets here: no encoder uses the remainder R - 2^n r. */
        v = largest;
        d->broken = 1;
    }
    d->value -= r * v;
    d->range = r;
    renormalise(d);
    return (uint32_t)v;
}

int adcgs_range_dec_bit(adcgs_range_dec *d, uint32_t p1)
{
    const uint64_t split = (d->range >> 16) * p1;
    const int bit = d->value < split;
    if (bit) {
        d->range = split;
    } else {
        d->value -= split;
        d->range -= split;
    }
    renormalise(d);
    return bit;
}

adcgs_status adcgs_range_dec_finish(const adcgs_range_dec *d, adcgs_error *error)
{
    if (d->broken)
        return adcgs_fail(error, ADCGS_ERR_DATA, "sub-stream holds a value that no encoder produces");
    if (d->zeros > VIRTUAL_BYTES_MAX)
        return adcgs_fail(error, ADCGS_ERR_DATA, "sub-stream is too short: its symbols need more than %d bytes past its end",
                          VIRTUAL_BYTES_MAX);
    if (d->next != d->end)
        return adcgs_fail(error, ADCGS_ERR_DATA, "sub-stream is too long: %zu bytes are left over", (size_t)(d->end - d->next));
    return ADCGS_OK;
}

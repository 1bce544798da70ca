/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * One quantised value: a table symbol, or the escape symbol followed by a
 * sign and an Exp-Golomb code. The code's prefix has at most 15 ones, so that
 * damaged data cannot make it longer.
 */
#include "net/net.h"

#define PREFIX_MAX 15

int32_t adcgs_value_max(int si)
{
    return adcgs_table_support(si) + 1 + 2 * ((1 << PREFIX_MAX) - 1);
}

int32_t adcgs_excess_dec(adcgs_range_dec *d)
{
    int prefix = 0;
    while (prefix < PREFIX_MAX && adcgs_range_dec_bits(d, 1))
        prefix++;
    return (1 << prefix) - 1 + (prefix ? (int32_t)adcgs_range_dec_bits(d, prefix) : 0);
}

int32_t adcgs_value_dec(adcgs_range_dec *d, int si)
{
    const int support = adcgs_table_support(si);
    const int symbol = adcgs_range_dec_symbol(d, adcgs_table_cdf(si), 2 * support + 2);
    if (symbol <= 2 * support)
        return symbol - support;
    const uint32_t negative = adcgs_range_dec_bits(d, 1);
    const int32_t magnitude = support + 1 + adcgs_excess_dec(d);
    return negative ? -magnitude : magnitude;
}

/* Length of the prefix for magnitude support + 1 + excess. */
static int prefix_of(int32_t excess)
{
    int prefix = 0;
    while (excess >= (2 << prefix) - 1)
        prefix++;
    return prefix;
}

void adcgs_excess_enc(adcgs_range_enc *e, int32_t excess)
{
    const int prefix = prefix_of(excess);
    for (int i = 0; i < prefix; i++)
        adcgs_range_enc_bits(e, 1, 1);
    if (prefix < PREFIX_MAX)
        adcgs_range_enc_bits(e, 0, 1);
    if (prefix)
        adcgs_range_enc_bits(e, (uint32_t)(excess - ((1 << prefix) - 1)), prefix);
}

void adcgs_value_enc(adcgs_range_enc *e, int si, int32_t value)
{
    const int support = adcgs_table_support(si), symbols = 2 * support + 2;
    const int32_t magnitude = value < 0 ? -value : value;
    const uint32_t *cdf = adcgs_table_cdf(si);
    if (magnitude <= support) {
        adcgs_range_enc_symbol(e, cdf, symbols, value + support);
        return;
    }
    adcgs_range_enc_symbol(e, cdf, symbols, symbols - 1);
    adcgs_range_enc_bits(e, value < 0, 1);
    adcgs_excess_enc(e, magnitude - support - 1);
}

uint32_t adcgs_value_cost(int si, int32_t value)
{
    const int support = adcgs_table_support(si);
    const int32_t magnitude = value < 0 ? -value : value;
    const uint32_t *cdf = adcgs_table_cdf(si);
    if (magnitude <= support)
        return adcgs_bit_cost(cdf[value + support + 1] - cdf[value + support], 1);
    const int prefix = prefix_of(magnitude - support - 1);
    const int raw = 1 + 2 * prefix + (prefix < PREFIX_MAX);
    return adcgs_bit_cost(65536 - cdf[2 * support + 1], 1) + ((uint32_t)raw << 16);
}

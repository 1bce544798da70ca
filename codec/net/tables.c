/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The value tables: one cumulative distribution per sigma level,
 * symmetric around the value 0. The compiler builds them from their left
 * halves. Everything is constant data.
 */
#include "net/net.h"

#include "net/tables_data.h"

/* Entry j steps left of the centre, and its mirror image. */
#define G1(centre, total, j, v) [(centre) - (j)] = (v), [(centre) + 1 + (j)] = (total) - (v),
#define G8(centre, total, j, a, b, c, d, e, f, g, h) \
    G1(centre, total, (j), a)                        \
    G1(centre, total, (j) + 1, b)                    \
    G1(centre, total, (j) + 2, c)                    \
    G1(centre, total, (j) + 3, d)                    \
    G1(centre, total, (j) + 4, e) G1(centre, total, (j) + 5, f) G1(centre, total, (j) + 6, g) G1(centre, total, (j) + 7, h)

static const uint32_t entries[VALUE_ENTRIES] = {VALUE_TABLES};
static const uint16_t offsets[ADCGS_SIGMA_LEVELS] = {VALUE_OFFSETS};
static const uint8_t supports[ADCGS_SIGMA_LEVELS] = {VALUE_SUPPORTS};

int adcgs_table_support(int level)
{
    return supports[level];
}

const uint32_t *adcgs_table_cdf(int level)
{
    return entries + offsets[level];
}

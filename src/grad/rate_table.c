/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Cost of a value by the coder's tables, and its derivatives with respect to the value and its sigma level: the rate in training
 * once it rounds.
 */
#include "grad/dsp.h"

#include <stdlib.h>

/**
 * Bits near the table's smallest probability, at which its differences are meaningless; arithmetic: probabilities have 16 bits.
 */
#define FLAT_BITS 13
#define SIGMA_LEAST 0.11 /* steps: sigma of level 0; definition of the format */
#define SIGMA_MOST 64    /* steps: sigma of the last level; definition of the format */
#define ASIDE 0.01       /* steps, and levels, to either side of a difference; chosen by hand, not measured */

static double sigma_of(double level)
{
    return SIGMA_LEAST * pow(SIGMA_MOST / SIGMA_LEAST, level / (ADCGS_SIGMA_LEVELS - 1));
}

static double upper_tail(double x)
{
    return 0.5 * erfc(x * 0.70710678118654752);
}

/** Bits of magnitude a at a fractional level, under the density used in training before rounding. */
static double smooth_bits(double a, double level)
{
    const double sigma = sigma_of(level), width = 1 + 4 * sigma;
    const double inside = upper_tail((a - 0.5) / sigma) - upper_tail((a + 0.5) / sigma);
    return -log2(inside * (1 - 0x1p-12) + 0x1p-14 * width / (width * width + a * a));
}

static double table_bits(int level, int a)
{
    return adcgs_value_cost(level, a) * 0x1p-16;
}

/** True if the table's differences are meaningful at this cell. */
static int is_live(int level, int a)
{
    return a <= adcgs_table_support(level) && table_bits(level, a) < FLAT_BITS;
}

/**
 * Difference over a quarter of sigma to both sides, because adjacent entries of a wide table differ by less than their rounding.
 */
static double by_value(int level, int a)
{
    const int reach = (int)fmax(1, sigma_of(level) / 4);
    if (a == 0)
        return 0;
    if (!is_live(level, a))
        return (smooth_bits(a + ASIDE, level) - smooth_bits(a - ASIDE, level)) / 0.02;
    int high = a + reach;
    while (!is_live(level, high))
        high--;
    return (table_bits(level, high) - table_bits(level, abs(a - reach))) / (high - (a - reach));
}

static double by_level(int level, int a)
{
    const int low = level > 0 && is_live(level - 1, a) ? level - 1 : level;
    const int high = level < ADCGS_SIGMA_LEVELS - 1 && is_live(level + 1, a) ? level + 1 : level;
    if (!is_live(level, a) || low == high)
        return (smooth_bits(a, level + ASIDE) - smooth_bits(a, level - ASIDE)) / 0.02;
    return (table_bits(high, a) - table_bits(low, a)) / (high - low);
}

void adcgs_rate_table_init(adcgs_rate_table *table)
{
    for (int level = 0; level < ADCGS_SIGMA_LEVELS; level++)
        for (int a = 0; a < ADCGS_RATE_CELLS; a++) {
            adcgs_rate_cell *cell = &table->cell[level][a];
            cell->bits = level > 0 ? (float)table_bits(level, a) : 0;
            cell->by_value = (float)by_value(level, a);
            cell->by_level = (float)by_level(level, a);
        }
}

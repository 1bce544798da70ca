/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The choice of one value's level by rate and distortion, with the prices of the tables that code it. */
#ifndef ADCGS_ENCODE_RDO_H
#define ADCGS_ENCODE_RDO_H

#include "net/net.h"

/**
 * The level n between 0 and nearest, both included, with the least weight * (n - wanted)^2 + lambda_bit * bits(n).
 * wanted: where the value lies, in levels; nearest: the level that would be taken without a price of bits, 0 if si is 0;
 * weight: loss per squared level, >= 0.
 */
int32_t adcgs_rdo_level(int shape, int si, double wanted, int32_t nearest, double weight, double lambda_bit);

#endif

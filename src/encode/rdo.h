/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Chooses a value's level by rate and distortion, with the bit costs of the tables that code it. */
#ifndef ADCGS_ENCODE_RDO_H
#define ADCGS_ENCODE_RDO_H

#include "net/net.h"

/**
 * Returns the level n between 0 and nearest, both included, with the least weight * (n - wanted)^2 + lambda_bit * bits(n).
 * wanted: position of the value, in levels; nearest: the level chosen if bits were free, 0 if si is 0; weight: loss per squared
 * level, >= 0.
 */
int32_t adcgs_rdo_level(int si, double wanted, int32_t nearest, double weight, double lambda_bit);

#endif

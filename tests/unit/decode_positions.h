/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Decoding of positions that stand alone. */
#ifndef ADCGS_TESTS_DECODE_POSITIONS_H
#define ADCGS_TESTS_DECODE_POSITIONS_H

#include "geom/geom.h"

static inline adcgs_status decode_positions(const uint8_t *data, size_t bytes, uint32_t n, int depth, uint32_t *voxels,
                                            adcgs_error *error)
{
    adcgs_range_dec d;
    adcgs_range_dec_init(&d, data, bytes);
    return adcgs_geom_decode(&d, n, depth, voxels, NULL, error);
}

#endif

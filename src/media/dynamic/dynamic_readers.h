/* SPDX-License-Identifier: BSD-2-Clause */
/** \file All readers of splats over time, in the order in which they are tried. */
#ifndef ADCGS_MEDIA_DYNAMIC_DYNAMIC_READERS_H
#define ADCGS_MEDIA_DYNAMIC_DYNAMIC_READERS_H

#include "media/dynamic/dynamic_reader.h"

extern const adcgs_dynamic_reader adcgs_dynamic_stg;
extern const adcgs_dynamic_reader adcgs_dynamic_ftgs;
extern const adcgs_dynamic_reader adcgs_dynamic_splatv;
extern const adcgs_dynamic_reader adcgs_dynamic_d3dg;
extern const adcgs_dynamic_reader adcgs_dynamic_tsog;
extern const adcgs_dynamic_reader adcgs_dynamic_splat4d;
extern const adcgs_dynamic_reader adcgs_dynamic_fourdgs;

/* clang-format off */
#define ADCGS_DYNAMIC_READERS \
    &adcgs_dynamic_stg, \
    &adcgs_dynamic_ftgs, \
    &adcgs_dynamic_splatv, \
    &adcgs_dynamic_d3dg, \
    &adcgs_dynamic_tsog, \
    &adcgs_dynamic_splat4d, \
    &adcgs_dynamic_fourdgs,
/* clang-format on */

#endif

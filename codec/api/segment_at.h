/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Splats at a time with the segment that they belong to, for the library and its programs. */
#ifndef ADCGS_API_SEGMENT_AT_H
#define ADCGS_API_SEGMENT_AT_H

#include "base/base.h"

#include <adcgs/decoder.h>

/** adcgs_get_primitives() with the number of the segment. Within a segment, a slot is the same splat at all times. */
adcgs_status adcgs_decoder_primitives(adcgs_decoder *d, double time, uint32_t *segment, adcgs_primitives *out,
                                      adcgs_error *error);

#endif

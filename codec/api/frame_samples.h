/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Declarations about frames that the library and its programs share. */
#ifndef ADCGS_API_FRAME_SAMPLES_H
#define ADCGS_API_FRAME_SAMPLES_H

#include "base/digest.h"

#include <adcgs/frame.h>

/** Convert a sample to 8 bits (spec clause "Output conversion"). */
static inline uint8_t adcgs_sample_u8(float v)
{
    const float clipped = v > 0.0f ? v < 1.0f ? v : 1.0f : 0.0f;
    return (uint8_t)(clipped * 255.0f + 0.5f); /* not negative: truncation is floor */
}

/** Add a frame's values, as bytes of the spec's frame digest, to a digest that may hold several frames. */
void adcgs_frame_digest_add(adcgs_md5 *md5, const adcgs_frame *frame);

#endif

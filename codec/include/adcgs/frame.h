/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Conversion and digest of rendered frames.
 */
#ifndef ADCGS_FRAME_H
#define ADCGS_FRAME_H

#include <adcgs/types.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * Convert to 8 bits: q = floor(clip(v, 0, 1) * 255 + 0.5) in binary32 (clause "Output conversion").
 * \param frame RGB samples
 * \param out receives [height][width][3]
 */
ADCGS_API void adcgs_frame_to_u8(const adcgs_frame *frame, uint8_t *out);

/**
 * Conformance point R: MD5 over the samples in memory order, each as a little-endian binary32 (clause "Frame digest").
 * \param frame RGB samples
 * \param digest receives 16 bytes
 */
ADCGS_API void adcgs_frame_digest(const adcgs_frame *frame, uint8_t digest[16]);

#ifdef __cplusplus
}
#endif
#endif

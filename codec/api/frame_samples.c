/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Conversion and digest of frames (spec clause "Output conversion"). */
#include "api/frame_samples.h"

void adcgs_frame_to_u8(const adcgs_frame *frame, uint8_t *out)
{
    const size_t n = 3 * (size_t)frame->width * (size_t)frame->height;
    for (size_t i = 0; i < n; i++)
        out[i] = adcgs_sample_u8(frame->rgb[i]);
}

void adcgs_frame_digest_add(adcgs_md5 *md5, const adcgs_frame *frame)
{
    uint8_t bytes[4096];
    const size_t n = 3 * (size_t)frame->width * (size_t)frame->height, step = sizeof bytes / 4;
    for (size_t i = 0; i < n; i += step) {
        const size_t count = ADCGS_MIN(step, n - i);
        for (size_t j = 0; j < count; j++)
            adcgs_store_le32(bytes + 4 * j, adcgs_float_bits(frame->rgb[i + j]));
        adcgs_md5_update(md5, bytes, 4 * count);
    }
}

void adcgs_frame_digest(const adcgs_frame *frame, uint8_t digest[16])
{
    adcgs_md5 md5;
    adcgs_md5_init(&md5);
    adcgs_frame_digest_add(&md5, frame);
    adcgs_md5_final(&md5, digest);
}

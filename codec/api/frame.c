/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Frames leaving the decoder (spec clause "Output conversion"). */
#include <adcgs/camera.h>

void adcgs_frame_to_u8(const adcgs_frame *frame, uint8_t *out)
{
    const size_t n = 3 * (size_t)frame->width * (size_t)frame->height;
    for (size_t i = 0; i < n; i++) {
        const float v = frame->rgb[i] > 0.0f ? frame->rgb[i] < 1.0f ? frame->rgb[i] : 1.0f : 0.0f;
        out[i] = (uint8_t)(v * 255.0f + 0.5f); /* not negative: truncation is floor */
    }
}

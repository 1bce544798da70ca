/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Writing Y4M. */
#include "config.h"

#include "media/video/y4m.h"

#include "media/video/fps.h"
#include "media/video/ycbcr.h"

#include <stdlib.h>

void adcgs_y4m_write_header(FILE *file, int width, int height, double frame_rate)
{
    const adcgs_fps rate = adcgs_fps_of(frame_rate);
    fprintf(file, "YUV4MPEG2 W%d H%d F%lu:%lu Ip A1:1 C444 XCOLORRANGE=LIMITED\n", width, height, (unsigned long)rate.num,
            (unsigned long)rate.den);
}

static float clip(float v)
{
    const float low = v > 0.0f ? v : 0.0f;
    return low < 1.0f ? low : 1.0f;
}

adcgs_status adcgs_y4m_write_frame(FILE *file, const adcgs_frame *frame, adcgs_error *error)
{
    const size_t n = (size_t)frame->width * (size_t)frame->height;
    uint8_t *planes = malloc(3 * n);
    if (!planes)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for a frame of %dx%d pixels", frame->width, frame->height);
    for (size_t i = 0; i < n; i++) {
        const float rgb[3] = {clip(frame->rgb[3 * i]), clip(frame->rgb[3 * i + 1]), clip(frame->rgb[3 * i + 2])};
        float y, cb, cr;
        adcgs_ycbcr_from_rgb((adcgs_ycbcr)ADCGS_YCBCR_709, rgb, &y, &cb, &cr);
        planes[i] = (uint8_t)(16.5f + 219.0f * y);
        planes[n + i] = (uint8_t)(128.5f + 224.0f * cb);
        planes[2 * n + i] = (uint8_t)(128.5f + 224.0f * cr);
    }
    fputs("FRAME\n", file);
    fwrite(planes, 1, 3 * n, file);
    free(planes);
    return ADCGS_OK;
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Writing Y4M. */
#include "config.h"

#include "io/y4m.h"

#include <math.h>
#include <stdlib.h>

/* BT.709: the weights of luma, and the ranges of limited ("video") coding. */
#define KR 0.2126f
#define KB 0.0722f
#define KG (1.0f - KR - KB)

/** Whole rates as N:1, the 1000/1001 family exactly, all others in thousandths. */
static void make_ratio(double rate, long *numerator, long *denominator)
{
    const double whole = floor(rate + 0.5), ntsc = floor(rate * 1001.0 / 1000.0 + 0.5);
    *numerator = (long)whole;
    *denominator = 1;
    if (fabs(rate - whole) < 1e-6)
        return;
    const int is_ntsc = fabs(rate - ntsc * 1000.0 / 1001.0) < 1e-4;
    *numerator = is_ntsc ? (long)ntsc * 1000 : (long)floor(rate * 1000.0 + 0.5);
    *denominator = is_ntsc ? 1001 : 1000;
}

void adcgs_y4m_write_header(FILE *file, int width, int height, double frame_rate)
{
    long numerator, denominator;
    make_ratio(frame_rate, &numerator, &denominator);
    fprintf(file, "YUV4MPEG2 W%d H%d F%ld:%ld Ip A1:1 C444 XCOLORRANGE=LIMITED\n", width, height, numerator, denominator);
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
        const float r = clip(frame->rgb[3 * i]), g = clip(frame->rgb[3 * i + 1]), b = clip(frame->rgb[3 * i + 2]);
        const float y = KR * r + KG * g + KB * b;
        planes[i] = (uint8_t)(16.5f + 219.0f * y);
        planes[n + i] = (uint8_t)(128.5f + 112.0f * ((b - y) / (1.0f - KB)));
        planes[2 * n + i] = (uint8_t)(128.5f + 112.0f * ((r - y) / (1.0f - KR)));
    }
    fputs("FRAME\n", file);
    fwrite(planes, 1, 3 * n, file);
    free(planes);
    return ADCGS_OK;
}

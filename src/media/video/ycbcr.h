/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Luma and chroma of video, in binary32: Y 0..1, Cb and Cr -0.5..0.5. */
#ifndef ADCGS_MEDIA_VIDEO_YCBCR_H
#define ADCGS_MEDIA_VIDEO_YCBCR_H

/** Weights of red and blue in luma. */
typedef struct adcgs_ycbcr {
    float red, blue;
} adcgs_ycbcr;

/* clang-format off */
#define ADCGS_YCBCR_709 {0.2126f, 0.0722f}
#define ADCGS_YCBCR_601 {0.299f, 0.114f}
/* clang-format on */

static inline void adcgs_ycbcr_from_rgb(adcgs_ycbcr w, const float rgb[3], float *y, float *cb, float *cr)
{
    *y = w.red * rgb[0] + (1.0f - w.red - w.blue) * rgb[1] + w.blue * rgb[2];
    *cb = 0.5f * ((rgb[2] - *y) / (1.0f - w.blue));
    *cr = 0.5f * ((rgb[0] - *y) / (1.0f - w.red));
}

static inline void adcgs_ycbcr_to_rgb(adcgs_ycbcr w, float y, float cb, float cr, float rgb[3])
{
    rgb[0] = y + 2.0f * (1.0f - w.red) * cr;
    rgb[2] = y + 2.0f * (1.0f - w.blue) * cb;
    rgb[1] = (y - w.red * rgb[0] - w.blue * rgb[2]) / (1.0f - w.red - w.blue);
}

#endif

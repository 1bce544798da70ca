/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Colours of high dynamic range in video as colours of an ordinary screen. */
#include "config.h"

#include "media/video/hdr.h"

#include <math.h>
#include <stddef.h>

/* Origin, unless a line states one: literature (ITU-R BT.2100 and BT.2408). */
#define WHITE 203.0f          /* cd/m2 of white paper, BT.2408 */
#define HLG_SCREEN 1000.0f    /* cd/m2 of the brightest white */
#define HLG_GAMMA 1.2f        /* system gamma of such a screen */
#define UNCHANGED 0.7f        /* light up to this share of white is not compressed; chosen by hand, not measured */
#define PQ_BRIGHTEST 10000.0f /* cd/m2 of the highest signal of PQ */

const char *adcgs_hdr_name(adcgs_hdr kind)
{
    static const char *const names[] = {NULL, "HLG", "PQ"};
    return names[kind];
}

/** Light of the screen in cd/m2 for PQ (BT.2100, table 4). */
static float pq_light(float signal)
{
    static const float m1 = 2610.0f / 16384.0f, m2 = 2523.0f / 32.0f, c1 = 3424.0f / 4096.0f, c2 = 2413.0f / 128.0f,
                       c3 = 2392.0f / 128.0f;
    const float p = powf(signal, 1.0f / m2);
    return PQ_BRIGHTEST * powf(fmaxf(p - c1, 0.0f) / (c2 - c3 * p), 1.0f / m1);
}

/** Light of the scene, 0 to 1, for HLG (BT.2100, table 5). */
static float hlg_light(float signal)
{
    static const float a = 0.17883277f, b = 0.28466892f, c = 0.55991073f;
    return signal <= 0.5f ? signal * signal / 3.0f : (expf((signal - c) / a) + b) / 12.0f;
}

/** Light of the screen, 1 for white paper. */
static void decode_light(adcgs_hdr kind, float rgb[3])
{
    for (int i = 0; i < 3; i++) {
        const float signal = fminf(fmaxf(rgb[i], 0.0f), 1.0f);
        rgb[i] = kind == ADCGS_HDR_PQ ? pq_light(signal) / WHITE : hlg_light(signal);
    }
    if (kind != ADCGS_HDR_HLG)
        return;
    const float luminance = 0.2627f * rgb[0] + 0.6780f * rgb[1] + 0.0593f * rgb[2];
    const float gain = luminance > 0.0f ? HLG_SCREEN / WHITE * powf(luminance, HLG_GAMMA - 1.0f) : 0.0f;
    for (int i = 0; i < 3; i++)
        rgb[i] *= gain;
}

/** From the primaries of BT.2020 to those of BT.709 (BT.2087). */
static void narrow_gamut(float rgb[3])
{
    const float r = rgb[0], g = rgb[1], b = rgb[2];
    rgb[0] = fmaxf(1.6605f * r - 0.5876f * g - 0.0728f * b, 0.0f);
    rgb[1] = fmaxf(-0.1246f * r + 1.1329f * g - 0.0083f * b, 0.0f);
    rgb[2] = fmaxf(-0.0182f * r - 0.1006f * g + 1.1187f * b, 0.0f);
}

/** Scales a colour so that its largest component is below 1. The curve continues the unchanged part smoothly. */
static void compress(float rgb[3])
{
    const float most = fmaxf(rgb[0], fmaxf(rgb[1], rgb[2])), rest = 1.0f - UNCHANGED;
    if (most <= UNCHANGED)
        return;
    const float scale = (1.0f - rest * expf((UNCHANGED - most) / rest)) / most;
    for (int i = 0; i < 3; i++)
        rgb[i] *= scale;
}

static float encode_srgb(float light)
{
    return light <= 0.0031308f ? 12.92f * light : 1.055f * powf(light, 1.0f / 2.4f) - 0.055f;
}

void adcgs_hdr_convert(adcgs_hdr kind, int is_wide, float rgb[3])
{
    if (kind == ADCGS_HDR_NONE)
        return;
    decode_light(kind, rgb);
    if (is_wide)
        narrow_gamut(rgb);
    compress(rgb);
    for (int i = 0; i < 3; i++)
        rgb[i] = fminf(encode_srgb(rgb[i]), 1.0f);
}

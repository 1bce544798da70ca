/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Colours of high dynamic range in video (ITU-R BT.2100) as colours of an
 * ordinary screen: BT.709 primaries, sRGB's curve, values of 0 to 1. White of
 * paper, 203 cd/m2 (BT.2408), stays bright; brighter light is compressed, with
 * its hue.
 */
#ifndef ADCGS_MEDIA_VIDEO_HDR_H
#define ADCGS_MEDIA_VIDEO_HDR_H

/** The transfer curve of a video. */
typedef enum adcgs_hdr {
    ADCGS_HDR_NONE, /**< of ordinary range */
    ADCGS_HDR_HLG,  /**< hybrid log-gamma, shown on a screen of 1000 cd/m2 */
    ADCGS_HDR_PQ    /**< perceptual quantiser, SMPTE ST 2084 */
} adcgs_hdr;

/** "HLG" or "PQ"; NULL for an ordinary range. */
const char *adcgs_hdr_name(adcgs_hdr kind);
/** Convert a colour in place; it is clipped to 0..1 first. is_wide: its primaries are those of BT.2020. */
void adcgs_hdr_convert(adcgs_hdr kind, int is_wide, float rgb[3]);

#endif

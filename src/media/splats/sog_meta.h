/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The meta.json of SOG, versions 1 and 2: names of images, and the meaning of their bytes. */
#ifndef ADCGS_MEDIA_SPLATS_SOG_META_H
#define ADCGS_MEDIA_SPLATS_SOG_META_H

#include "media/splats/splats.h"

#define ADCGS_SOG_BYTES 256 /**< values of a byte; definition */
#define ADCGS_SOG_NAME 128  /**< bytes of an image's name, with its final zero; chosen by hand, not measured */

/** The images. */
typedef enum adcgs_sog_image {
    ADCGS_SOG_MEANS_LOW, /**< low bytes of the positions */
    ADCGS_SOG_MEANS_HIGH,
    ADCGS_SOG_SCALES,
    ADCGS_SOG_ROTATIONS,
    ADCGS_SOG_COLOURS,   /**< and opacities */
    ADCGS_SOG_CENTROIDS, /**< of harmonics; these two only with harmonics */
    ADCGS_SOG_LABELS,
    ADCGS_SOG_IMAGES
} adcgs_sog_image;

/** Values of bytes are NAN where a codebook has no entry. */
typedef struct adcgs_sog_meta {
    uint32_t n; /**< 1 to ADCGS_SPLATS_MAX */
    int antialiased;
    double low[3], high[3]; /**< of the positions' logarithms */
    double scale[3][ADCGS_SOG_BYTES];
    double colour[3][ADCGS_SOG_BYTES]; /**< 0.5 + ADCGS_SPLATS_DC f_dc */
    double opacity[ADCGS_SOG_BYTES];
    double harmonic[ADCGS_SOG_BYTES];
    int has_harmonics, degree; /**< degree 0: the width of the centroids' image gives it (version 1) */
    uint32_t centroids;        /**< their number; 0: that of the image (version 1) */
    char name[ADCGS_SOG_IMAGES][ADCGS_SOG_NAME];
} adcgs_sog_meta;

/**
 * Parse meta.json; over_time: of TSOG, whose splats are stored as in version 2. ADCGS_ERR_UNSUPPORTED for another version, and
 * for splats over time unless they are expected. ADCGS_ERR_DATA, naming the member, for a missing one, and for a name of an image
 * that lies in another folder.
 */
adcgs_status adcgs_sog_meta_parse(adcgs_sog_meta *out, const uint8_t *text, size_t bytes, int over_time, const char *path,
                                  adcgs_error *error);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The members of a TSOG's meta.json that SOG does not have. */
#ifndef ADCGS_MEDIA_DYNAMIC_TSOG_META_H
#define ADCGS_MEDIA_DYNAMIC_TSOG_META_H

#include "media/video/fps.h"

#define ADCGS_TSOG_TEXT_MAX \
    ((uint64_t)1 << 20)     /**< bytes of meta.json; chosen by hand, not measured: three codebooks need 20 KB */
#define ADCGS_TSOG_NAME 128 /**< bytes of an image's name, with its final zero; chosen by hand, not measured */

/** How splats change: without a timeline, and its types 0 and 1. */
typedef enum adcgs_tsog_kind { ADCGS_TSOG_STATIC, ADCGS_TSOG_DISCRETE, ADCGS_TSOG_CONTINUOUS } adcgs_tsog_kind;

/** One or two images: low bytes, high bytes. */
typedef struct adcgs_tsog_image {
    int n; /**< 0: none */
    char name[2][ADCGS_TSOG_NAME];
    double low[3], high[3]; /**< values of the smallest and the largest number of each channel */
} adcgs_tsog_image;

typedef struct adcgs_tsog_meta {
    adcgs_tsog_kind kind;
    adcgs_tsog_image timeline; /**< discrete: 65536ths of the clip; continuous: centre and standard deviation, of the clip */
    adcgs_tsog_image velocity; /**< units per clip */
    uint32_t frames, delta;    /**< discrete: their number, and the 65536ths of a frame */
    adcgs_fps rate;            /**< frames per second */
    double seconds;            /**< of the clip; 0: unstated */
    int has_sound;
} adcgs_tsog_meta;

/** True if a text is a meta.json of splats over time. */
int adcgs_tsog_meta_is(const uint8_t *text, size_t bytes);
/**
 * Parse it. ADCGS_ERR_UNSUPPORTED for another profile of playback, another type of timeline, and a change over time that is not
 * read. ADCGS_ERR_DATA, naming it, for a member that is missing or wrong.
 */
adcgs_status adcgs_tsog_meta_parse(adcgs_tsog_meta *out, const uint8_t *text, size_t bytes, const char *path, adcgs_error *error);

#endif

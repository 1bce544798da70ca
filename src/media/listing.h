/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Sorted contents of a folder. */
#ifndef ADCGS_MEDIA_LISTING_H
#define ADCGS_MEDIA_LISTING_H

#include "base/base.h"

/** Names without their folder, sorted byte by byte. */
typedef struct adcgs_listing {
    char **names;
    size_t n;
} adcgs_listing;

/** Lists the entries that keep() accepts, at most a million. ADCGS_ERR_IO if the folder cannot be read. */
adcgs_status adcgs_listing_read(adcgs_listing *out, const char *folder, int (*keep)(const char *name), adcgs_error *error);
void adcgs_listing_free(adcgs_listing *listing);

/** True for names that do not begin with a dot. */
int adcgs_is_visible_name(const char *name);
/** True if a name ends like that of an image. */
int adcgs_is_image_name(const char *name);
/** Copies a name without folder and extension, truncated to the size of out. */
void adcgs_stem(char *out, size_t size, const char *path);

/** Names that are added one after another. All zero: none yet. */
typedef struct adcgs_counting {
    char before[64];      /**< common prefix of the names */
    long long last, step; /**< last number and step between numbers */
    uint32_t n;
    int is_other; /**< a name is no prefix with a number, or not the next */
} adcgs_counting;

void adcgs_counting_add(adcgs_counting *counting, const char *stem);
/** True if there are enough names, and they are one prefix with numbers that rise in equal steps, like those of frames. */
int adcgs_counting_holds(const adcgs_counting *counting);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file What is in a folder, in order. */
#ifndef ADCGS_LAYOUTS_LISTING_H
#define ADCGS_LAYOUTS_LISTING_H

#include "base/base.h"

/** Names without their folder, sorted byte by byte. */
typedef struct adcgs_listing {
    char **names;
    size_t n;
} adcgs_listing;

/** The entries that keep() likes. ADCGS_ERR_IO if it is no folder that can be read; at most a million. */
adcgs_status adcgs_listing_read(adcgs_listing *out, const char *folder, int (*keep)(const char *name), adcgs_error *error);
void adcgs_listing_free(adcgs_listing *listing);

/** Does a name end like that of an image? */
int adcgs_is_image_name(const char *name);
/** A name without folder and extension, cut where out ends. */
void adcgs_stem(char *out, size_t size, const char *path);

/** Names that come one after the other. All zero: none yet. */
typedef struct adcgs_counting {
    char before[64];       /**< what they all begin with */
    long long last, step;  /**< of their numbers */
    uint32_t n;
    int is_other;          /**< one of them is no text with a number behind it, or not the next */
} adcgs_counting;

void adcgs_counting_add(adcgs_counting *counting, const char *stem);
/** Whether there are some, and they are one text with numbers behind it that go up in even steps, as those of frames. */
int adcgs_counting_holds(const adcgs_counting *counting);

#endif

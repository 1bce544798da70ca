/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Decoding what a feed brings, a little at a time: first as far as there is
 * something to draw, then for a moment each time, so that pictures come in
 * between and become sharper. A fault ends it; what was there stays.
 */
#ifndef ADCGS_PLAY_INTAKE_H
#define ADCGS_PLAY_INTAKE_H

#include "play/feed.h"

#include <adcgs/types.h>

/** How much has come. */
typedef struct adcgs_come {
    adcgs_info info;    /**< of what has been decoded */
    uint64_t bytes;     /**< that have been */
    int drawable;       /**< there is something to draw */
    int over;           /**< nothing more will come, or be decoded */
    adcgs_error fault;  /**< why, unless its status is ADCGS_OK */
} adcgs_come;

typedef struct adcgs_intake {
    adcgs_feed *feed;
    adcgs_config config;
    adcgs_decoder *decoder; /**< NULL until the first adcgs_intake_take() */
    int layers;             /**< that it was opened with */
    adcgs_come come;
    uint8_t piece[65536];   /**< bytes of the feed, from come.bytes on: n of them, at at */
    size_t at, n;
} adcgs_intake;

/** config->layers is not looked at. */
void adcgs_intake_init(adcgs_intake *intake, adcgs_feed *feed, const adcgs_config *config);
void adcgs_intake_clear(adcgs_intake *intake);
/**
 * With another number of layers than before, decode what had been once more; with `more`, some of what has come since. *changed:
 * something else is to be drawn. A fault of the stream is noted, and no failure.
 */
adcgs_status adcgs_intake_take(adcgs_intake *intake, int layers, int more, int *changed, adcgs_error *error);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Decodes the bytes of a feed in small steps: first up to the first renderable segment, then for a short time in each step, so
 * that images come in between and become sharper. A fault ends it; earlier results stay.
 */
#ifndef ADCGS_PLAY_INTAKE_H
#define ADCGS_PLAY_INTAKE_H

#include "play/feed.h"

#include <adcgs/types.h>

/** Progress of decoding. */
typedef struct adcgs_come {
    adcgs_info info;   /**< of the decoded part */
    uint64_t bytes;    /**< decoded bytes */
    int drawable;      /**< something can be rendered */
    int over;          /**< nothing more will arrive, or be decoded */
    adcgs_error fault; /**< the reason, unless its status is ADCGS_OK */
} adcgs_come;

typedef struct adcgs_intake {
    adcgs_feed *feed;
    adcgs_config config;
    adcgs_decoder *decoder; /**< NULL until the first adcgs_intake_take() */
    int layers;             /**< with which the decoder was opened */
    adcgs_come come;
    uint8_t piece[65536]; /**< n bytes of the feed, from come.bytes on, at position at */
    size_t at, n;
} adcgs_intake;

/** config->layers is ignored. */
void adcgs_intake_init(adcgs_intake *intake, adcgs_feed *feed, const adcgs_config *config);
void adcgs_intake_clear(adcgs_intake *intake);
/**
 * Decodes the earlier bytes again if the number of layers has changed. With `more`, decodes some of the bytes that have arrived
 * since. *changed: the rendered result differs. A fault of the stream is noted, and is no failure.
 */
adcgs_status adcgs_intake_take(adcgs_intake *intake, int layers, int more, int *changed, adcgs_error *error);

#endif

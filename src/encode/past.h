/* SPDX-License-Identifier: BSD-2-Clause */
/** \file What there is of a stream that is to go on: its segments, one after the other, as far as they are whole. */
#ifndef ADCGS_ENCODE_PAST_H
#define ADCGS_ENCODE_PAST_H

#include "stream/push.h"

#include <stdio.h>

typedef struct adcgs_past {
    adcgs_stream stream;   /**< what is true of all segments, once there was one; else none of it counts */
    adcgs_push_reader *reader;
    const char *path;
    FILE *file;
    uint8_t *bytes;        /**< that were read, and not yet decoded: from at on, n of them */
    size_t at, n;
    uint32_t given;        /**< segments so far, but for one that nothing follows */
    int over;              /**< nothing more can be read */
    int is_done;           /**< nor given */
    adcgs_error fault;     /**< why, if it was damage */
} adcgs_past;

/** path outlives it. On failure, too, adcgs_past_close(). */
adcgs_status adcgs_past_open(adcgs_past *past, const char *path, adcgs_cpu_level cpu, adcgs_pool *pool, adcgs_error *error);
void adcgs_past_close(adcgs_past *past);
/**
 * The next segment of which every byte is there: a model of the caller's; n 0: there is none any more, since the stream ends
 * here, was cut off or is damaged (fault). ADCGS_ERR_IO, ADCGS_ERR_MEMORY.
 */
adcgs_status adcgs_past_next(adcgs_past *past, adcgs_model *model, adcgs_error *error);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Reads back a stream that is to be continued: its segments in order, as far as they are whole. */
#ifndef ADCGS_SESSION_RESUME_READER_H
#define ADCGS_SESSION_RESUME_READER_H

#include "stream/push.h"

#include <stdio.h>

typedef struct adcgs_resume_reader {
    adcgs_stream stream; /**< values that all segments share; valid after the first segment */
    adcgs_push_reader *reader;
    const char *path;
    FILE *file;
    uint8_t *bytes; /**< read and not yet decoded: n bytes, from `at` on */
    size_t at, n;
    uint32_t given;    /**< segments returned so far, without a last one that no other follows */
    int over;          /**< nothing more can be read */
    int is_done;       /**< nothing more can be returned */
    adcgs_error fault; /**< the reason, if it was damage */
} adcgs_resume_reader;

/** path outlives it. Call adcgs_resume_reader_close() on failure, too. */
adcgs_status adcgs_resume_reader_open(adcgs_resume_reader *resumed, const char *path, adcgs_cpu_level cpu, adcgs_pool *pool,
                                      adcgs_error *error);
void adcgs_resume_reader_close(adcgs_resume_reader *resumed);
/**
 * Returns the next complete segment as a model that the caller owns. n 0: no more segments, since the stream ends here, was cut
 * off or is damaged (fault). ADCGS_ERR_IO, ADCGS_ERR_MEMORY.
 */
adcgs_status adcgs_resume_reader_next(adcgs_resume_reader *resumed, adcgs_model *model, adcgs_error *error);

#endif

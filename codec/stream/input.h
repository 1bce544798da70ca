/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Input of stream readers, from a file or from memory, and a trace function that sums up the trace. */
#ifndef ADCGS_STREAM_INPUT_H
#define ADCGS_STREAM_INPUT_H

#include "base/digest.h"

#include <adcgs/types.h>

/** Bytes in memory that remain to be read. */
typedef struct adcgs_span {
    const uint8_t *next;
    size_t left;
    int step, turn; /**< step > 0: return 1, 2, .. step bytes in turn, as a slow pipe might; turn starts at 0 */
} adcgs_span;

/** An adcgs_read_fn; user is an adcgs_span. */
int64_t adcgs_span_read(void *user, void *buffer, size_t bytes);
/** An adcgs_read_fn; user is a FILE open for reading. */
int64_t adcgs_file_read(void *user, void *buffer, size_t bytes);
/** An adcgs_read_at_fn; user is a FILE open for reading that can seek. */
int64_t adcgs_file_read_at(void *user, uint64_t offset, void *buffer, size_t bytes);

/** Number of lines and digest of the text of a trace (conformance point P). */
typedef struct adcgs_trace_sum {
    adcgs_md5 md5;
    uint32_t lines;
} adcgs_trace_sum;

void adcgs_trace_sum_init(adcgs_trace_sum *sum);
/** An adcgs_trace_fn; user is an adcgs_trace_sum. */
void adcgs_trace_sum_add(void *user, uint64_t bit, const char *element, const char *value);
/** The digest in hexadecimal; nothing can be added after it. */
void adcgs_trace_sum_final(adcgs_trace_sum *sum, char hex[33]);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A stream as a list of chunks that can be edited: for vectors that the writer
 * does not produce. Checksums and the end chunk are made right again on request.
 */
#ifndef ADCGS_CONFORMANCE_CHUNKS_H
#define ADCGS_CONFORMANCE_CHUNKS_H

#include "bits/bytes.h"

#define ADCGS_CHUNK_LIST_MAX 64

typedef struct adcgs_raw_chunk {
    uint8_t header[12]; /**< type, length, segment, flags, version */
    adcgs_buffer payload;
} adcgs_raw_chunk;

typedef struct adcgs_chunk_list {
    int n;
    adcgs_raw_chunk chunk[ADCGS_CHUNK_LIST_MAX];
} adcgs_chunk_list;

/** Cut a valid stream into chunks. */
adcgs_status adcgs_chunk_list_read(adcgs_chunk_list *list, const uint8_t *data, size_t bytes, adcgs_error *error);
void adcgs_chunk_list_clear(adcgs_chunk_list *list);
/** First chunk of a type ("GEOM"), -1 if there is none. */
int adcgs_chunk_list_find(const adcgs_chunk_list *list, const char *type);
/** Insert a chunk before index at. */
adcgs_status adcgs_chunk_list_insert(adcgs_chunk_list *list, int at, const char *type, const char *text, adcgs_error *error);
/** Put the list together as a stream, with all checksums, lengths and the end chunk as the specification wants them. */
void adcgs_chunk_list_write(adcgs_chunk_list *list, adcgs_buffer *out);

#endif

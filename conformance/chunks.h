/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A stream as a list of chunks that can be edited and assembled, either valid
 * or with one error.
 */
#ifndef ADCGS_CONFORMANCE_CHUNKS_H
#define ADCGS_CONFORMANCE_CHUNKS_H

#include "bits/bytes.h"

#define ADCGS_CHUNK_LIST_MAX 256
#define ADCGS_CHUNK_FRAME 20 /**< bytes of a chunk in addition to its payload; 16 of them precede it */

typedef struct adcgs_raw_chunk {
    char type[5];
    uint16_t segment;
    uint8_t flags, version;
    adcgs_buffer payload;
    int as_is;      /**< INDX, ENDC: the payload is kept when the list is assembled */
    int has_length; /**< the header holds the member length instead of the payload's size */
    uint32_t length;
    uint32_t header_damage, payload_damage; /**< XORed to the checksums */
    size_t at;                              /**< position of the chunk in the last written stream */
} adcgs_raw_chunk;

typedef struct adcgs_chunk_list {
    int n;
    adcgs_raw_chunk chunk[ADCGS_CHUNK_LIST_MAX];
} adcgs_chunk_list;

void adcgs_chunk_list_clear(adcgs_chunk_list *list);
/** The chunk that "GEOM" or, counted from 0, "GEOM#2" names. */
adcgs_status adcgs_chunk_list_find(const adcgs_chunk_list *list, const char *name, int *index, adcgs_error *error);
/** Insert an empty chunk before index at. */
adcgs_status adcgs_chunk_list_insert(adcgs_chunk_list *list, int at, const char *type, adcgs_error *error);
void adcgs_chunk_list_remove(adcgs_chunk_list *list, int at);
/** Assemble the stream: checksums, lengths, the index and the end chunk are right unless a chunk's members override them. */
adcgs_status adcgs_chunk_list_write(adcgs_chunk_list *list, adcgs_buffer *out, adcgs_error *error);

#endif

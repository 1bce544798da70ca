/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Where the segments of a stream are that can be read anywhere: by its index, or by the headers of its chunks. */
#ifndef ADCGS_STREAM_SEEK_TABLE_H
#define ADCGS_STREAM_SEEK_TABLE_H

#include "stream/reader.h"

/** All segments of a stream, one behind the other in bytes and in time. */
typedef struct adcgs_seek_table {
    uint32_t n, capacity;
    adcgs_syn_index *entry; /**< [n] */
} adcgs_seek_table;

void adcgs_seek_table_clear(adcgs_seek_table *table, adcgs_memory *memory);
/** Whether both tell of the same segments at the same places. */
int adcgs_seek_table_equal(const adcgs_seek_table *a, const adcgs_seek_table *b);

/*
 * Below, reader is one of an adcgs_seekable (reader->source.user), which has read HEAD unless it says otherwise; its error says
 * why. first: position of the first segment. A table that is filled is empty before. The caller clears it, after a failure too.
 */

/** The header of a chunk, if the source has all its bytes and the level allows them. HEAD may not be read yet. */
adcgs_status adcgs_seek_look(adcgs_stream_reader *reader, uint64_t position, adcgs_chunk *chunk);
/** The position behind a chunk. */
uint64_t adcgs_seek_behind(const adcgs_chunk *chunk);

/** Take the index where it is expected. ADCGS_ERR_DATA: there is none, or it is none. */
adcgs_status adcgs_seek_table_index(adcgs_seek_table *table, adcgs_stream_reader *reader, uint64_t first);
/** Find the segments by the headers of all chunks. */
adcgs_status adcgs_seek_table_scan(adcgs_seek_table *table, adcgs_stream_reader *reader, uint64_t first);

#endif

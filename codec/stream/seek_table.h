/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Positions of the segments of a stream with random access, from its index or from the headers of its chunks. */
#ifndef ADCGS_STREAM_SEEK_TABLE_H
#define ADCGS_STREAM_SEEK_TABLE_H

#include "stream/reader.h"

/** All segments of a stream, in order of position and of time. */
typedef struct adcgs_seek_table {
    uint32_t n, capacity;
    adcgs_syn_index *entry; /**< [n] */
} adcgs_seek_table;

void adcgs_seek_table_clear(adcgs_seek_table *table, adcgs_memory *memory);
/** Whether both tables have the same segments at the same positions. */
int adcgs_seek_table_equal(const adcgs_seek_table *a, const adcgs_seek_table *b);

/*
 * Below, the user of the reader's source is an adcgs_seekable, and the reader has read HEAD unless a function says otherwise. Its
 * error says why a function failed. first: position of the first segment. A table to fill must be empty. The caller clears it,
 * also after a failure.
 */

/** Read the header of a chunk, if the source has all its bytes and the level allows them. HEAD may not have been read yet. */
adcgs_status adcgs_seek_look(adcgs_stream_reader *reader, uint64_t position, adcgs_chunk *chunk);
/** The position after a chunk. */
uint64_t adcgs_seek_behind(const adcgs_chunk *chunk);

/** Read the index from its expected position. ADCGS_ERR_DATA: it is missing or invalid. */
adcgs_status adcgs_seek_table_index(adcgs_seek_table *table, adcgs_stream_reader *reader, uint64_t first);
/** Find the segments by the headers of all chunks. */
adcgs_status adcgs_seek_table_scan(adcgs_seek_table *table, adcgs_stream_reader *reader, uint64_t first);

#endif

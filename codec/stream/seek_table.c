/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Finding the segments of a stream. */
#include "stream/seek_table.h"

#include "base/digest.h"

#define ENDC_BYTES 32  /**< of the whole chunk */
#define ENTRY_BYTES 37 /**< of one segment in INDX */
#define TIMES_BYTES 20 /**< at the start of SEGM: start, end and reach */

static uint64_t size_of(const adcgs_stream_reader *r)
{
    return ((const adcgs_seekable *)r->source.user)->size;
}

/** Read exactly this number of bytes; a source that ends earlier is a failure. */
static adcgs_status fetch(adcgs_stream_reader *r, uint64_t position, void *to, size_t bytes)
{
    const uint64_t size = size_of(r);
    size_t got = 0;
    if (position > size || bytes > size - position)
        return adcgs_fail(r->error, ADCGS_ERR_TRUNCATED, "stream: ends at byte %llu, before ENDC", (unsigned long long)size);
    adcgs_source_move(&r->source, position);
    ADCGS_TRY(adcgs_source_read(&r->source, to, bytes, &got, r->error));
    return got == bytes
               ? ADCGS_OK
               : adcgs_fail(r->error, ADCGS_ERR_IO, "stream: reading failed at byte %llu", (unsigned long long)(position + got));
}

/** Read the header of the chunk at a position, and check that the whole chunk is present. */
static adcgs_status look_whole(adcgs_stream_reader *r, uint64_t position, adcgs_chunk *chunk)
{
    uint8_t bytes[ADCGS_CHUNK_HEADER_BYTES];
    ADCGS_TRY(fetch(r, position, bytes, sizeof bytes));
    ADCGS_TRY(adcgs_chunk_header(bytes, position, chunk, r->error));
    const uint64_t size = size_of(r), wanted = ADCGS_CHUNK_BYTES + (uint64_t)chunk->header.length;
    if (wanted > size - position)
        return adcgs_fail(r->error, ADCGS_ERR_TRUNCATED, "stream: ends at byte %llu, inside %s", (unsigned long long)size,
                          chunk->name);
    return ADCGS_OK;
}

adcgs_status adcgs_seek_look(adcgs_stream_reader *r, uint64_t position, adcgs_chunk *chunk)
{
    ADCGS_TRY(look_whole(r, position, chunk));
    return adcgs_chunk_check_limits(chunk, r->segment.limits, r->error);
}

uint64_t adcgs_seek_behind(const adcgs_chunk *chunk)
{
    return chunk->origin + ADCGS_CHUNK_BYTES + chunk->header.length;
}

void adcgs_seek_table_clear(adcgs_seek_table *t, adcgs_memory *memory)
{
    adcgs_free(memory, t->entry);
    *t = (adcgs_seek_table){0};
}

static int same_entry(const adcgs_syn_index *a, const adcgs_syn_index *b)
{
    return a->start_ticks == b->start_ticks && a->end_ticks == b->end_ticks && a->reach_ticks == b->reach_ticks &&
           a->offset == b->offset && a->bytes == b->bytes && a->key == b->key;
}

int adcgs_seek_table_equal(const adcgs_seek_table *a, const adcgs_seek_table *b)
{
    int same = a->n == b->n;
    for (uint32_t i = 0; same && i < a->n; i++)
        same = same_entry(&a->entry[i], &b->entry[i]);
    return same;
}

static adcgs_status add_entry(adcgs_seek_table *t, adcgs_stream_reader *r, const adcgs_syn_index *entry)
{
    const uint32_t most = r->segment.limits->segments;
    if (t->n >= most)
        return adcgs_fail(r->error, ADCGS_ERR_LIMIT, "SEGM: more than %u segments, the level's limit", most);
    if (t->n == t->capacity) {
        const uint32_t capacity = t->capacity ? 2 * t->capacity : 16;
        adcgs_syn_index *entries = adcgs_alloc(r->options->memory, capacity, sizeof *entries, r->error);
        if (!entries)
            return adcgs_alloc_status(r->error);
        if (t->n > 0)
            memcpy(entries, t->entry, t->n * sizeof *entries);
        adcgs_free(r->options->memory, t->entry);
        t->entry = entries;
        t->capacity = capacity;
    }
    t->entry[t->n++] = *entry;
    return ADCGS_OK;
}

/** Whether a segment may follow those in the table. */
static int follows(const adcgs_seek_table *t, const adcgs_syn_index *entry)
{
    return entry->end_ticks >= entry->start_ticks && (t->n == 0 || entry->start_ticks > t->entry[t->n - 1].start_ticks);
}

/** Number of bytes of a `var`. */
static uint64_t var_bytes(uint32_t value)
{
    uint64_t n = 1;
    while (value >>= 7)
        n++;
    return n;
}

/** Position of INDX if only INDX and ENDC follow the segments; 0 if that is impossible. */
static uint64_t index_position(const adcgs_stream_reader *r)
{
    const uint64_t n = r->head.segments, payload = var_bytes((uint32_t)n) + ENTRY_BYTES * n;
    const uint64_t behind_it = ENDC_BYTES + ADCGS_CHUNK_BYTES + payload;
    return n > 0 && size_of(r) > behind_it ? size_of(r) - behind_it : 0;
}

/** Parse the payload of INDX: all segments, in order of position and of time. */
static adcgs_status parse_entries(adcgs_seek_table *t, adcgs_stream_reader *r, const uint8_t *payload, size_t bytes,
                                  uint64_t first, uint64_t end)
{
    adcgs_parse p = {.chunk = "INDX", .error = r->error};
    uint32_t n;
    adcgs_reader_init(&p.r, payload, bytes);
    ADCGS_TRY(adcgs_parse_varint(&p, "segments", r->head.segments, r->head.segments, &n));
    for (uint32_t i = 0; i < n; i++) {
        adcgs_syn_index entry;
        ADCGS_TRY(adcgs_syn_index_parse(&p, &entry));
        if (entry.offset < first || entry.offset >= end || entry.bytes > end - entry.offset || !follows(t, &entry))
            return adcgs_fail(r->error, ADCGS_ERR_DATA, "INDX: does not match the stream");
        first = entry.offset + entry.bytes;
        ADCGS_TRY(add_entry(t, r, &entry));
    }
    return adcgs_parse_end(&p);
}

/** Read the payload of INDX, check its checksum, and parse it. */
static adcgs_status use_index(adcgs_seek_table *t, adcgs_stream_reader *r, const adcgs_chunk *chunk, uint8_t *payload,
                              uint64_t first)
{
    const size_t length = chunk->header.length;
    uint8_t crc[4];
    ADCGS_TRY(fetch(r, chunk->origin + ADCGS_CHUNK_HEADER_BYTES, payload, length));
    ADCGS_TRY(fetch(r, adcgs_seek_behind(chunk) - sizeof crc, crc, sizeof crc));
    if (adcgs_load_le32(crc) != adcgs_crc32c(0, payload, length))
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "INDX: checksum is wrong");
    return parse_entries(t, r, payload, length, first, chunk->origin);
}

adcgs_status adcgs_seek_table_index(adcgs_seek_table *t, adcgs_stream_reader *r, uint64_t first)
{
    const uint64_t at = index_position(r);
    adcgs_chunk chunk;
    if (at < first)
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "INDX: the stream has none");
    ADCGS_TRY(look_whole(r, at, &chunk)); /* not limited by the level: it may not be a chunk of the stream */
    if (chunk.type != ADCGS_TYPE_INDX || chunk.header.version > 0 || adcgs_seek_behind(&chunk) != size_of(r) - ENDC_BYTES)
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "INDX: the stream has none");
    uint8_t *payload = adcgs_alloc(r->options->memory, chunk.header.length, 1, r->error);
    if (!payload)
        return adcgs_alloc_status(r->error);
    const adcgs_status status = use_index(t, r, &chunk, payload, first);
    adcgs_free(r->options->memory, payload);
    return status;
}

static int is_tick(int64_t ticks)
{
    return ticks >= -(int64_t)ADCGS_TICKS_MAX && ticks <= (int64_t)ADCGS_TICKS_MAX;
}

/** Add the segment of a SEGM, which ends the previous one. */
static adcgs_status meet_segment(adcgs_seek_table *t, adcgs_stream_reader *r, const adcgs_chunk *chunk)
{
    uint8_t times[TIMES_BYTES] = {0};
    ADCGS_TRY(fetch(r, chunk->origin + ADCGS_CHUNK_HEADER_BYTES, times, ADCGS_MIN(sizeof times, (size_t)chunk->header.length)));
    const adcgs_syn_index entry = {.start_ticks = (int64_t)adcgs_load_le64(times),
                                   .end_ticks = (int64_t)adcgs_load_le64(times + 8),
                                   .reach_ticks = adcgs_load_le32(times + 16),
                                   .offset = chunk->origin,
                                   .key = chunk->header.flags & ADCGS_CHUNK_KEY};
    if (chunk->header.length < sizeof times || !is_tick(entry.start_ticks) || !is_tick(entry.end_ticks) || !follows(t, &entry))
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "SEGM: too short, or not later than the previous segment");
    return add_entry(t, r, &entry);
}

adcgs_status adcgs_seek_table_scan(adcgs_seek_table *t, adcgs_stream_reader *r, uint64_t first)
{
    for (uint64_t at = first;;) {
        adcgs_chunk chunk;
        ADCGS_TRY(adcgs_seek_look(r, at, &chunk));
        const int ends = chunk.type == ADCGS_TYPE_SEGM || chunk.type == ADCGS_TYPE_INDX || chunk.type == ADCGS_TYPE_ENDC;
        if (ends && t->n > 0 && t->entry[t->n - 1].bytes == 0)
            t->entry[t->n - 1].bytes = at - t->entry[t->n - 1].offset;
        if (chunk.type == ADCGS_TYPE_SEGM)
            ADCGS_TRY(meet_segment(t, r, &chunk));
        if (chunk.type == ADCGS_TYPE_ENDC && t->n == 0)
            return adcgs_fail(r->error, ADCGS_ERR_DATA, "stream: has no segment before its end");
        if (chunk.type == ADCGS_TYPE_ENDC)
            return ADCGS_OK;
        at = adcgs_seek_behind(&chunk);
    }
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Seeking in a stream. */
#include "stream/seek.h"

#include "base/digest.h"
#include "model/model_priv.h"
#include "stream/reader.h"

#define ENDC_BYTES 32  /**< of the chunk */
#define ENTRY_BYTES 37 /**< of a segment in INDX */
#define TIMES_BYTES 20 /**< of SEGM: start, end and reach, with which it begins */

struct adcgs_seek {
    adcgs_seekable input;
    adcgs_read_options options;
    adcgs_error error;   /**< of the reader */
    adcgs_stream_reader reader;
    adcgs_stream *stream;
    uint32_t n, capacity;
    adcgs_syn_index *entry; /**< [n] */
    uint64_t first;      /**< position of the first segment */
    int by_index;        /**< the entries are those of INDX, and not yet doubted */
    uint32_t first_nets; /**< networks that stand before the first segment */
    int keeps_nets;      /**< some segment names what was sent before its key: reading began at the beginning, all is kept */
};

/** The reader's failure, to whoever called. */
static adcgs_status pass_on(const adcgs_seek *s, adcgs_status status, adcgs_error *error)
{
    if (status != ADCGS_OK && error)
        *error = s->error;
    return status;
}

/** Read some bytes, all of which are there. */
static adcgs_status fetch(adcgs_seek *s, uint64_t position, void *to, size_t bytes)
{
    size_t got = 0;
    if (position > s->input.size || bytes > s->input.size - position)
        return adcgs_fail(&s->error, ADCGS_ERR_TRUNCATED, "stream: ends at byte %llu, before ENDC",
                          (unsigned long long)s->input.size);
    adcgs_source_move(&s->reader.source, position);
    ADCGS_TRY(adcgs_source_read(&s->reader.source, to, bytes, &got, &s->error));
    return got == bytes ? ADCGS_OK :
                          adcgs_fail(&s->error, ADCGS_ERR_IO, "stream: reading failed at byte %llu",
                                     (unsigned long long)(position + got));
}

/** The header of the chunk at a position, and whether all of the chunk is there. */
static adcgs_status look_at(adcgs_seek *s, uint64_t position, adcgs_chunk *chunk)
{
    uint8_t bytes[ADCGS_CHUNK_HEADER_BYTES];
    ADCGS_TRY(fetch(s, position, bytes, sizeof bytes));
    ADCGS_TRY(adcgs_chunk_header(bytes, position, chunk, &s->error));
    if (chunk->header.length > s->input.size || position + ADCGS_CHUNK_BYTES + chunk->header.length > s->input.size)
        return adcgs_fail(&s->error, ADCGS_ERR_TRUNCATED, "stream: ends at byte %llu, inside %s",
                          (unsigned long long)s->input.size, chunk->name);
    return ADCGS_OK;
}

static uint64_t behind(const adcgs_chunk *chunk)
{
    return chunk->origin + ADCGS_CHUNK_BYTES + chunk->header.length;
}

static adcgs_status use_chunk(adcgs_seek *s, uint64_t position)
{
    int truncated;
    adcgs_source_move(&s->reader.source, position);
    ADCGS_TRY(adcgs_stream_reader_chunk(&s->reader, &truncated));
    return truncated ? adcgs_fail(&s->error, ADCGS_ERR_TRUNCATED, "stream: ends at byte %llu, inside a chunk",
                                  (unsigned long long)s->input.size) :
                       ADCGS_OK;
}

/** All that stands before the first segment. first: its position. */
static adcgs_status read_front(adcgs_seek *s, uint64_t *first)
{
    adcgs_source_move(&s->reader.source, 0);
    ADCGS_TRY(adcgs_stream_reader_signature(&s->reader));
    for (uint64_t at = ADCGS_SIGNATURE_BYTES;;) {
        adcgs_chunk chunk;
        ADCGS_TRY(look_at(s, at, &chunk));
        *first = at;
        if (chunk.type == ADCGS_TYPE_SEGM && s->reader.head_payload)
            break;
        ADCGS_TRY(use_chunk(s, at)); /* which refuses what may not stand here */
        if (s->reader.ended || s->reader.indexed)
            return adcgs_fail(&s->error, ADCGS_ERR_DATA, "stream: no segment stands before its end");
        at = behind(&chunk);
    }
    s->first_nets = s->reader.nets.n;
    s->reader.nets.has_gaps = 1;
    return ADCGS_OK;
}

static adcgs_status add_entry(adcgs_seek *s, const adcgs_syn_index *entry)
{
    if (s->n >= s->reader.segment.limits->segments)
        return adcgs_fail(&s->error, ADCGS_ERR_LIMIT, "SEGM: more than %u segments, the level's limit",
                          s->reader.segment.limits->segments);
    if (s->n == s->capacity) {
        const uint32_t capacity = s->capacity ? 2 * s->capacity : 16;
        adcgs_syn_index *entries = adcgs_alloc(s->options.memory, capacity, sizeof *entries, &s->error);
        if (!entries)
            return adcgs_alloc_status(&s->error);
        if (s->n > 0)
            memcpy(entries, s->entry, s->n * sizeof *entries);
        adcgs_free(s->options.memory, s->entry);
        s->entry = entries;
        s->capacity = capacity;
    }
    s->entry[s->n++] = *entry;
    return ADCGS_OK;
}

/** Bytes that a `var` has. */
static uint64_t var_bytes(uint32_t value)
{
    uint64_t n = 1;
    while (value >>= 7)
        n++;
    return n;
}

/** Where INDX stands if nothing but it and ENDC follows the segments; 0 if that cannot be. */
static uint64_t index_position(const adcgs_seek *s)
{
    const uint64_t n = s->reader.head.segments, payload = var_bytes((uint32_t)n) + ENTRY_BYTES * n;
    const uint64_t behind_it = ENDC_BYTES + ADCGS_CHUNK_BYTES + payload;
    return n > 0 && s->input.size > behind_it ? s->input.size - behind_it : 0;
}

/** The payload of INDX: all segments, one behind the other in the stream and in time. */
static adcgs_status parse_entries(adcgs_seek *s, const uint8_t *payload, size_t bytes, uint64_t first, uint64_t end)
{
    adcgs_parse p = { .chunk = "INDX", .error = &s->error };
    uint32_t n;
    adcgs_reader_init(&p.r, payload, bytes);
    ADCGS_TRY(adcgs_parse_varint(&p, "segments", s->reader.head.segments, s->reader.head.segments, &n));
    for (uint32_t i = 0; i < n; i++) {
        adcgs_syn_index entry;
        ADCGS_TRY(adcgs_syn_index_parse(&p, &entry));
        if (entry.offset < first || entry.offset >= end || entry.bytes > end - entry.offset ||
            (i > 0 && entry.start_ticks <= s->entry[i - 1].start_ticks))
            return adcgs_fail(&s->error, ADCGS_ERR_DATA, "INDX: not what the stream holds");
        first = entry.offset + entry.bytes;
        ADCGS_TRY(add_entry(s, &entry));
    }
    return adcgs_parse_end(&p);
}

/** Take the index where it is expected. ADCGS_ERR_DATA: there is none, or it is none. */
static adcgs_status read_index(adcgs_seek *s, uint64_t first)
{
    const uint64_t at = index_position(s);
    adcgs_chunk chunk;
    uint8_t crc[4];
    if (at < first)
        return adcgs_fail(&s->error, ADCGS_ERR_DATA, "INDX: there is none");
    ADCGS_TRY(look_at(s, at, &chunk));
    if (chunk.type != ADCGS_TYPE_INDX || chunk.header.version > 0 || behind(&chunk) != s->input.size - ENDC_BYTES)
        return adcgs_fail(&s->error, ADCGS_ERR_DATA, "INDX: there is none");
    uint8_t *payload = adcgs_alloc(s->options.memory, chunk.header.length, 1, &s->error);
    if (!payload)
        return adcgs_alloc_status(&s->error);
    adcgs_status status = fetch(s, at + ADCGS_CHUNK_HEADER_BYTES, payload, chunk.header.length);
    if (status == ADCGS_OK)
        status = fetch(s, behind(&chunk) - sizeof crc, crc, sizeof crc);
    if (status == ADCGS_OK && adcgs_load_le32(crc) != adcgs_crc32c(0, payload, chunk.header.length))
        status = adcgs_fail(&s->error, ADCGS_ERR_DATA, "INDX: checksum is wrong");
    if (status == ADCGS_OK)
        status = parse_entries(s, payload, chunk.header.length, first, at);
    adcgs_free(s->options.memory, payload);
    return status;
}

/** A SEGM that was met: it ends the segment before it. */
static adcgs_status meet_segment(adcgs_seek *s, const adcgs_chunk *chunk)
{
    uint8_t times[TIMES_BYTES] = { 0 };
    ADCGS_TRY(fetch(s, chunk->origin + ADCGS_CHUNK_HEADER_BYTES, times, ADCGS_MIN(sizeof times, (size_t)chunk->header.length)));
    const adcgs_syn_index entry = { .start_ticks = (int64_t)adcgs_load_le64(times),
                                    .end_ticks = (int64_t)adcgs_load_le64(times + 8),
                                    .reach_ticks = adcgs_load_le32(times + 16),
                                    .offset = chunk->origin,
                                    .key = chunk->header.flags & ADCGS_CHUNK_KEY };
    if (chunk->header.length < sizeof times || (s->n > 0 && entry.start_ticks <= s->entry[s->n - 1].start_ticks))
        return adcgs_fail(&s->error, ADCGS_ERR_DATA, "SEGM: too short, or not later than the segment in front of it");
    return add_entry(s, &entry);
}

/** Find the segments by the headers of all chunks. */
static adcgs_status scan(adcgs_seek *s, uint64_t first)
{
    s->n = 0;
    for (uint64_t at = first;;) {
        adcgs_chunk chunk;
        ADCGS_TRY(look_at(s, at, &chunk));
        const int ends = chunk.type == ADCGS_TYPE_SEGM || chunk.type == ADCGS_TYPE_INDX || chunk.type == ADCGS_TYPE_ENDC;
        if (ends && s->n > 0 && s->entry[s->n - 1].bytes == 0)
            s->entry[s->n - 1].bytes = at - s->entry[s->n - 1].offset;
        if (chunk.type == ADCGS_TYPE_SEGM)
            ADCGS_TRY(meet_segment(s, &chunk));
        if (chunk.type == ADCGS_TYPE_ENDC)
            return ADCGS_OK;
        at = behind(&chunk);
    }
}

static adcgs_status open_seek(adcgs_seek *s)
{
    ADCGS_TRY(read_front(s, &s->first));
    const adcgs_status status = read_index(s, s->first);
    s->by_index = status == ADCGS_OK;
    if (status == ADCGS_ERR_DATA || status == ADCGS_ERR_TRUNCATED)
        return scan(s, s->first);
    return status;
}

adcgs_status adcgs_seek_open(adcgs_seek **out, adcgs_stream *stream, adcgs_read_at_fn read, void *user, uint64_t size,
                             const adcgs_read_options *options, adcgs_error *error)
{
    adcgs_seek *s = adcgs_alloc(NULL, 1, sizeof *s, error);
    *out = NULL;
    if (!s)
        return adcgs_alloc_status(error);
    s->input = (adcgs_seekable){ .read = read, .user = user, .size = size };
    s->options = *options;
    s->stream = stream;
    adcgs_stream_reader_init(&s->reader, stream, adcgs_seekable_read, &s->input, &s->options, &s->error);
    const adcgs_status status = pass_on(s, open_seek(s), error);
    if (status != ADCGS_OK)
        adcgs_seek_free(&s);
    *out = s;
    return status;
}

void adcgs_seek_free(adcgs_seek **seek)
{
    adcgs_seek *s = *seek;
    if (!s)
        return;
    adcgs_stream_reader_clear(&s->reader);
    adcgs_free(s->options.memory, s->entry);
    adcgs_free(NULL, s);
    *seek = NULL;
}

uint32_t adcgs_seek_segments(const adcgs_seek *s)
{
    return s->n;
}

void adcgs_seek_times(const adcgs_seek *s, uint32_t number, int64_t ticks[3])
{
    ticks[0] = s->entry[number].start_ticks;
    ticks[1] = s->entry[number].end_ticks;
    ticks[2] = s->entry[number].reach_ticks;
}

const adcgs_model *adcgs_seek_at_hand(const adcgs_seek *s, uint32_t number)
{
    const uint32_t index = number - s->stream->first_segment;
    return index < s->stream->n_segments ? &s->stream->segments[index] : NULL;
}

uint64_t adcgs_seek_bytes(const adcgs_seek *s)
{
    return s->input.bytes;
}

/** Of the models in memory, keep the last, so many at most. */
static void forget(adcgs_seek *s, uint32_t kept)
{
    const uint32_t n = s->stream->n_segments;
    adcgs_stream_forget(s->stream, n - ADCGS_MIN(n, kept), s->options.memory);
}

/** Networks of segments that are past. */
static void forget_networks(adcgs_seek *s)
{
    adcgs_net_table *table = &s->reader.nets;
    for (uint32_t i = s->first_nets; i < table->n; i++) {
        table->weights -= table->nets[i].present ? adcgs_net_weights(&table->nets[i]) : 0;
        adcgs_net_release(&table->nets[i], table->memory);
    }
}

/** Decode the next segment, of which that before it is in memory unless it is a key; no other stays. */
static adcgs_status decode(adcgs_seek *s, uint32_t number)
{
    forget(s, 1);
    const adcgs_syn_index *e = &s->entry[number];
    const uint64_t end = e->offset + e->bytes;
    adcgs_segment *segment = &s->reader.segment;
    /* Whoever plays on and on needs no more than a part at a time: the level's bounds are on what is at hand. */
    segment->left = (adcgs_cost){ segment->limits->model_bytes, segment->limits->work };
    segment->index.size = 0;
    uint64_t at = e->offset;
    while (at < end) {
        adcgs_chunk chunk;
        ADCGS_TRY(look_at(s, at, &chunk));
        if (chunk.name[0] < 'a' || chunk.type == ADCGS_TYPE_hash) /* cameras and texts are those in front */
            ADCGS_TRY(use_chunk(s, at));
        at = behind(&chunk);
    }
    if (at != end)
        return adcgs_fail(&s->error, ADCGS_ERR_DATA, "INDX: segment %u does not end at byte %llu", number,
                          (unsigned long long)end);
    const uint32_t before = s->stream->n_segments;
    ADCGS_TRY(adcgs_segment_finish(segment, end, 0));
    if (s->stream->n_segments != before + 1)
        return adcgs_fail(&s->error, ADCGS_ERR_DATA, "INDX: no segment %u at byte %llu", number, (unsigned long long)e->offset);
    return ADCGS_OK;
}

/** Begin anew in front of a segment. */
static void begin_at(adcgs_seek *s, uint32_t number)
{
    forget(s, 0);
    adcgs_segment_drop(&s->reader.segment);
    s->stream->first_segment = number;
    s->reader.indexed = s->reader.ended = 0;
    if (!s->keeps_nets)
        forget_networks(s);
}

/** From the last key at or before the first of the segments that are wanted, or from what is in memory, to the last. */
static adcgs_status go_to(adcgs_seek *s, uint32_t number, int before)
{
    const adcgs_stream *stream = s->stream;
    uint32_t next = number - (before != 0);
    while (next > 0 && (s->keeps_nets || !s->entry[next].key))
        next--;
    const uint32_t behind = stream->first_segment + stream->n_segments; /* what is in memory, if anything */
    if (stream->n_segments > 0 && behind > next && behind <= number)
        next = behind;
    else
        begin_at(s, next);
    for (; next <= number; next++) {
        if (s->entry[next].key && !s->keeps_nets)
            forget_networks(s);
        ADCGS_TRY(decode(s, next));
    }
    forget(s, 1 + (before != 0));
    return ADCGS_OK;
}

/** Whether the headers of all chunks tell of the same segments at other places than the index, which is forgotten then. */
static int doubts_index(adcgs_seek *s)
{
    const uint32_t n = s->n;
    const adcgs_error why = s->error;
    if (!s->by_index)
        return 0;
    s->by_index = 0;
    if (scan(s, s->first) == ADCGS_OK && s->n == n)
        return 1;
    s->error = why;
    return 0;
}

adcgs_status adcgs_seek_to(adcgs_seek *s, uint32_t number, int before, adcgs_error *error)
{
    adcgs_status status = go_to(s, number, before);
    if (status == ADCGS_ERR_DATA && !s->keeps_nets) { /* perhaps it names a network that was sent before its key */
        const adcgs_error first = s->error;
        s->keeps_nets = 1;
        begin_at(s, 0);
        if (go_to(s, number, before) == ADCGS_OK) {
            status = ADCGS_OK;
        } else {
            s->keeps_nets = 0;
            s->error = first;
        }
    }
    if (status == ADCGS_ERR_DATA && doubts_index(s)) {
        begin_at(s, 0);
        status = go_to(s, number, before);
    }
    if (status != ADCGS_OK)
        begin_at(s, 0);
    return pass_on(s, status, error);
}

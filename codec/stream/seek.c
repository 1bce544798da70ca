/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Seeking in a stream. */
#include "stream/seek.h"

#include "model/model_priv.h"
#include "stream/seek_table.h"

struct adcgs_seek {
    adcgs_seekable input;
    adcgs_read_options options;
    adcgs_error error; /**< failure of the reader */
    adcgs_stream_reader reader;
    adcgs_stream *stream;
    adcgs_seek_table table; /**< never empty once open; the number of segments is fixed */
    adcgs_cost *spent;      /**< [table.n] cost of each segment decoded so far; 0: not yet decoded */
    adcgs_cost left;        /**< bounds of the level, less the costs of the front and of all of spent */
    uint64_t first;         /**< position of the first segment */
    int by_index;           /**< the table comes from INDX and has not been compared with the chunks yet */
    uint32_t first_nets;    /**< number of networks before the first segment */
    int keeps_nets; /**< a segment refers to networks sent before its key: read from the beginning and keep all networks */
    int passes;     /**< decoding began at, or passed, a later key: networks sent before it are not in memory */
};

/** Report the reader's failure to the caller. */
static adcgs_status pass_on(const adcgs_seek *s, adcgs_status status, adcgs_error *error)
{
    if (status != ADCGS_OK && error)
        *error = s->error;
    return status;
}

static adcgs_status use_chunk(adcgs_seek *s, uint64_t position)
{
    int truncated;
    adcgs_source_move(&s->reader.source, position);
    ADCGS_TRY(adcgs_stream_reader_chunk(&s->reader, &truncated));
    return truncated ? adcgs_fail(&s->error, ADCGS_ERR_TRUNCATED, "stream: ends at byte %llu, inside a chunk",
                                  (unsigned long long)s->input.size)
                     : ADCGS_OK;
}

/** Read everything before the first segment. */
static adcgs_status read_front(adcgs_seek *s)
{
    adcgs_stream_reader *r = &s->reader;
    adcgs_source_move(&r->source, 0);
    ADCGS_TRY(adcgs_stream_reader_signature(r));
    for (uint64_t at = ADCGS_SIGNATURE_BYTES;;) {
        adcgs_chunk chunk;
        ADCGS_TRY(adcgs_seek_look(r, at, &chunk));
        s->first = at;
        if (chunk.type == ADCGS_TYPE_SEGM && r->head_payload)
            break;
        ADCGS_TRY(use_chunk(s, at)); /* refuses chunks that must not be here */
        if (r->ended || r->indexed)
            return adcgs_fail(&s->error, ADCGS_ERR_DATA, "stream: has no segment before its end");
        if (r->segment.stage != ADCGS_SEGMENT_NONE)
            return adcgs_fail(&s->error, ADCGS_ERR_DATA, "stream: %s at byte %llu changed during reading", chunk.name,
                              (unsigned long long)at);
        at = adcgs_seek_behind(&chunk);
    }
    s->first_nets = r->nets.n;
    r->nets.has_gaps = 1;
    s->left = r->segment.left;
    return ADCGS_OK;
}

/** Find the segments by the index, or else by the headers of chunks. */
static adcgs_status find_segments(adcgs_seek *s)
{
    const adcgs_status status = adcgs_seek_table_index(&s->table, &s->reader, s->first);
    s->by_index = status == ADCGS_OK;
    if (status != ADCGS_ERR_DATA && status != ADCGS_ERR_TRUNCATED)
        return status;
    adcgs_seek_table_clear(&s->table, s->options.memory);
    return adcgs_seek_table_scan(&s->table, &s->reader, s->first);
}

static adcgs_status open_seek(adcgs_seek *s)
{
    ADCGS_TRY(read_front(s));
    ADCGS_TRY(find_segments(s));
    s->spent = adcgs_alloc(s->options.memory, s->table.n, sizeof *s->spent, &s->error);
    return s->spent ? ADCGS_OK : adcgs_alloc_status(&s->error);
}

adcgs_status adcgs_seek_open(adcgs_seek **out, adcgs_stream *stream, adcgs_read_at_fn read, void *user, uint64_t size,
                             const adcgs_read_options *options, adcgs_error *error)
{
    adcgs_seek *s = adcgs_alloc(NULL, 1, sizeof *s, error);
    *out = NULL;
    if (!s)
        return adcgs_alloc_status(error);
    s->input = (adcgs_seekable){.read = read, .user = user, .size = size};
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
    adcgs_seek_table_clear(&s->table, s->options.memory);
    adcgs_free(s->options.memory, s->spent);
    adcgs_free(NULL, s);
    *seek = NULL;
}

uint32_t adcgs_seek_segments(const adcgs_seek *s)
{
    return s->table.n;
}

void adcgs_seek_times(const adcgs_seek *s, uint32_t number, int64_t ticks[3])
{
    ticks[0] = s->table.entry[number].start_ticks;
    ticks[1] = s->table.entry[number].end_ticks;
    ticks[2] = s->table.entry[number].reach_ticks;
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

/** Keep at most the last `kept` models in memory. */
static void forget(adcgs_seek *s, uint32_t kept)
{
    const uint32_t n = s->stream->n_segments;
    adcgs_stream_forget(s->stream, n - ADCGS_MIN(n, kept), s->options.memory);
}

/** Free the networks of past segments. */
static void forget_networks(adcgs_seek *s)
{
    adcgs_net_table *table = &s->reader.nets;
    for (uint32_t i = s->first_nets; i < table->n; i++) {
        table->weights -= table->nets[i].present ? adcgs_net_weights(&table->nets[i]) : 0;
        adcgs_net_release(&table->nets[i], table->memory);
    }
}

/** Use all chunks of a segment. */
static adcgs_status use_chunks(adcgs_seek *s, const adcgs_syn_index *e, uint64_t end)
{
    uint64_t at = e->offset;
    while (at < end) {
        adcgs_chunk chunk;
        ADCGS_TRY(adcgs_seek_look(&s->reader, at, &chunk));
        if (chunk.name[0] < 'a' || chunk.type == ADCGS_TYPE_hash) /* cameras and texts come from the front */
            ADCGS_TRY(use_chunk(s, at));
        at = adcgs_seek_behind(&chunk);
    }
    return at == end ? ADCGS_OK
                     : adcgs_fail(&s->error, ADCGS_ERR_DATA, "INDX: the segment at byte %llu does not end at byte %llu",
                                  (unsigned long long)e->offset, (unsigned long long)end);
}

/** Decode the next segment. Unless it is a key, the previous one must be in memory; all others are freed. */
static adcgs_status decode(adcgs_seek *s, uint32_t number)
{
    forget(s, 1);
    const adcgs_syn_index *e = &s->table.entry[number];
    const uint64_t end = e->offset + e->bytes;
    adcgs_segment *segment = &s->reader.segment;
    /* Each segment counts once, however often it is decoded: the sum is that of reading the whole stream (REQ-STRM-052). */
    const adcgs_cost most = {s->left.bytes + s->spent[number].bytes, s->left.work + s->spent[number].work};
    segment->left = most;
    segment->index.size = 0;
    ADCGS_TRY(use_chunks(s, e, end));
    const uint32_t before = s->stream->n_segments;
    ADCGS_TRY(adcgs_segment_finish(segment, end, 0));
    if (s->stream->n_segments != before + 1)
        return adcgs_fail(&s->error, ADCGS_ERR_DATA, "INDX: no segment %u at byte %llu", number, (unsigned long long)e->offset);
    if (segment->ticks[0] != e->start_ticks || segment->ticks[1] != e->end_ticks || segment->ticks[2] != e->reach_ticks)
        return adcgs_fail(&s->error, ADCGS_ERR_DATA, "INDX: segment %u has other times in its SEGM", number);
    s->left = segment->left;
    s->spent[number] = (adcgs_cost){most.bytes - s->left.bytes, most.work - s->left.work};
    return ADCGS_OK;
}

/** Reset, so that decoding can begin at this segment. */
static void begin_at(adcgs_seek *s, uint32_t number)
{
    forget(s, 0);
    adcgs_segment_drop(&s->reader.segment);
    s->stream->first_segment = number;
    s->reader.indexed = s->reader.ended = 0;
    forget_networks(s); /* with keeps_nets, too: decoding then reads them again from the beginning */
}

/** Decode up to segment `number`, from the segments in memory or from the last key at or before the first requested segment. */
static adcgs_status go_to(adcgs_seek *s, uint32_t number, int before)
{
    const adcgs_stream *stream = s->stream;
    uint32_t next = number - (before != 0);
    while (next > 0 && (s->keeps_nets || !s->table.entry[next].key))
        next--;
    const uint32_t behind = stream->first_segment + stream->n_segments; /* end of the segments in memory, if any */
    s->passes = next > 0;
    if (stream->n_segments > 0 && behind > next && behind <= number)
        next = behind;
    else
        begin_at(s, next);
    for (; next <= number; next++) {
        if (next > 0 && s->table.entry[next].key && !s->keeps_nets) {
            s->passes = 1;
            forget_networks(s);
        }
        ADCGS_TRY(decode(s, next));
    }
    forget(s, 1 + (before != 0));
    return ADCGS_OK;
}

/**
 * Whether the headers of all chunks show as many segments as the index, but at other positions or times. If so, they replace the
 * index; otherwise the table stays. So the number of segments never changes.
 */
static int doubts_index(adcgs_seek *s)
{
    const adcgs_error why = s->error;
    adcgs_seek_table found = {0};
    if (!s->by_index)
        return 0;
    s->by_index = 0;
    const int differs = adcgs_seek_table_scan(&found, &s->reader, s->first) == ADCGS_OK && found.n == s->table.n &&
                        !adcgs_seek_table_equal(&found, &s->table);
    if (differs) {
        const adcgs_seek_table doubted = s->table;
        s->table = found;
        found = doubted;
    }
    adcgs_seek_table_clear(&found, s->options.memory);
    s->error = why;
    return differs;
}

/** As go_to(). A segment that refers to a network sent before its key is decoded from the beginning of the stream. */
static adcgs_status go_to_with_nets(adcgs_seek *s, uint32_t number, int before)
{
    const adcgs_status status = go_to(s, number, before);
    if (status != ADCGS_ERR_DATA || s->keeps_nets || !s->passes)
        return status;
    const adcgs_error first = s->error;
    s->keeps_nets = 1;
    begin_at(s, 0);
    const adcgs_status again = go_to(s, number, before);
    if (again == ADCGS_OK)
        return again;
    s->keeps_nets = 0;
    if (again != ADCGS_ERR_DATA)
        return again;
    s->error = first;
    return status;
}

adcgs_status adcgs_seek_to(adcgs_seek *s, uint32_t number, int before, adcgs_error *error)
{
    adcgs_status status = go_to_with_nets(s, number, before);
    if (status == ADCGS_ERR_DATA && doubts_index(s)) {
        begin_at(s, 0);
        status = go_to_with_nets(s, number, before);
    }
    if (status != ADCGS_OK)
        begin_at(s, 0);
    return pass_on(s, status, error);
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Reading a stream from pushed bytes. */
#include "stream/push.h"

#include "base/digest.h"
#include "stream/reader.h"

#define READ_BYTES 65536 /* read from a source at a time */

/** Target of the search before chunks are used. */
typedef enum search { SEARCH_OVER, SEARCH_HEAD, SEARCH_KEY } search;

struct adcgs_push_reader {
    adcgs_read_options options;
    adcgs_error error; /**< of the reader; a failure is final */
    adcgs_stream_reader reader;
    uint8_t *held;              /**< bytes received of the current chunk, or of the signature */
    size_t n, capacity, wanted; /**< bytes held; room for; bytes needed to continue */
    size_t given;               /**< bytes of held already passed to the reader */
    int has_signature, has_start, is_over;
    int64_t start;      /**< tick at which the first segment begins */
    int64_t end_before; /**< tick at which the segment before the current one ends */
    search search;      /**< state of tuning in */
};

/** Read callback of the reader: returns held bytes. */
static int64_t read_held(void *user, void *buffer, size_t bytes)
{
    adcgs_push_reader *p = user;
    const size_t n = ADCGS_MIN(bytes, p->n - p->given);
    if (n > 0)
        memcpy(buffer, p->held + p->given, n);
    p->given += n;
    return (int64_t)n;
}

adcgs_status adcgs_push_create(adcgs_push_reader **out, adcgs_stream *stream, const adcgs_read_options *options,
                               adcgs_error *error)
{
    adcgs_push_reader *p = adcgs_alloc(NULL, 1, sizeof *p, error);
    *out = p;
    if (!p)
        return adcgs_alloc_status(error);
    p->options = *options;
    p->wanted = ADCGS_SIGNATURE_BYTES;
    adcgs_stream_reader_init(&p->reader, stream, read_held, p, &p->options, &p->error);
    return ADCGS_OK;
}

void adcgs_push_free(adcgs_push_reader **reader)
{
    adcgs_push_reader *p = *reader;
    if (!p)
        return;
    adcgs_stream_reader_clear(&p->reader);
    adcgs_free(p->options.memory, p->held);
    adcgs_free(NULL, p);
    *reader = NULL;
}

/** Reserve memory for held bytes. It grows with the bytes that arrive, not with the length in a header. */
static adcgs_status reserve(adcgs_push_reader *p, size_t bytes)
{
    if (bytes <= p->capacity)
        return ADCGS_OK;
    const size_t capacity = ADCGS_MAX(bytes, 2 * p->capacity);
    uint8_t *held = adcgs_alloc(p->options.memory, capacity, 1, &p->error);
    if (!held)
        return adcgs_alloc_status(&p->error);
    if (p->n > 0)
        memcpy(held, p->held, p->n);
    adcgs_free(p->options.memory, p->held);
    p->held = held;
    p->capacity = capacity;
    return ADCGS_OK;
}

/** Discard the held bytes; the header of the next chunk is needed first. */
static void next_chunk(adcgs_push_reader *p)
{
    p->n = p->given = 0;
    p->wanted = ADCGS_CHUNK_HEADER_BYTES;
}

/** Chunks with a segment's number, and networks: the search for a key skips them. */
static int is_of_segment(uint32_t type)
{
    return type == ADCGS_TYPE_SEGM || type == ADCGS_TYPE_KEEP || type == ADCGS_TYPE_GEOM || type == ADCGS_TYPE_hash ||
           type == ADCGS_TYPE_NETW || adcgs_type_layer(type) >= 0;
}

/** Skip held bytes. */
static void pass_over(adcgs_push_reader *p, size_t bytes)
{
    p->reader.source.pos += bytes;
    p->n -= bytes;
    memmove(p->held, p->held + bytes, p->n);
}

/** Whether the held bytes begin with the header of a HEAD. */
static int is_head(const adcgs_push_reader *p, size_t *bytes)
{
    adcgs_chunk chunk;
    if (adcgs_load_le32(p->held) != ADCGS_TYPE_HEAD || adcgs_chunk_header(p->held, 0, &chunk, NULL) != ADCGS_OK)
        return 0;
    *bytes = ADCGS_CHUNK_BYTES + chunk.header.length;
    return chunk.header.length <= ADCGS_HEAD_BYTES_MAX;
}

static int is_whole(const uint8_t *chunk, size_t bytes)
{
    return adcgs_load_le32(chunk + bytes - 4) == adcgs_crc32c(0, chunk + ADCGS_CHUNK_HEADER_BYTES, bytes - ADCGS_CHUNK_BYTES);
}

/** Tune in at an arbitrary byte: skip to the next HEAD and use it. */
static adcgs_status search_head(adcgs_push_reader *p, adcgs_arrival *arrived)
{
    size_t bytes = 0;
    int truncated;
    p->wanted = ADCGS_CHUNK_HEADER_BYTES;
    while (p->n >= ADCGS_CHUNK_HEADER_BYTES && !is_head(p, &bytes))
        pass_over(p, 1);
    if (p->n < ADCGS_CHUNK_HEADER_BYTES)
        return ADCGS_OK;
    p->wanted = bytes;
    if (p->n < bytes)
        return ADCGS_OK;
    if (!is_whole(p->held, bytes)) {
        pass_over(p, p->n);
        p->wanted = ADCGS_CHUNK_HEADER_BYTES;
        return ADCGS_OK;
    }
    p->search = SEARCH_KEY;
    p->reader.joined = p->reader.nets.has_gaps = 1;
    ADCGS_TRY(adcgs_stream_reader_chunk(&p->reader, &truncated));
    *arrived = ADCGS_ARRIVED_HEADER;
    next_chunk(p);
    return ADCGS_OK;
}

/** Handle a chunk during the search for a key: *use becomes 0 if the chunk is skipped. */
static adcgs_status search_key(adcgs_push_reader *p, int *use)
{
    adcgs_chunk chunk;
    ADCGS_TRY(adcgs_chunk_header(p->held, p->reader.source.pos, &chunk, &p->error));
    if (chunk.type == ADCGS_TYPE_ENDC)
        return adcgs_fail(&p->error, ADCGS_ERR_TRUNCATED, "stream: ends before a key segment");
    const int is_key = chunk.type == ADCGS_TYPE_SEGM && chunk.header.flags & ADCGS_CHUNK_KEY;
    *use = is_key || (!is_of_segment(chunk.type) && chunk.type != ADCGS_TYPE_INDX);
    if (is_key) {
        p->search = SEARCH_OVER;
        p->reader.stream->first_segment = chunk.header.segment;
    }
    return ADCGS_OK;
}

/** Check a complete header and get its chunk's length. The reader will check the same bytes again. */
static adcgs_status measure_chunk(adcgs_push_reader *p)
{
    adcgs_chunk chunk;
    ADCGS_TRY(adcgs_chunk_header(p->held, p->reader.source.pos, &chunk, &p->error));
    ADCGS_TRY(adcgs_chunk_check_limits(&chunk, p->reader.segment.limits, &p->error));
    p->wanted = ADCGS_CHUNK_BYTES + chunk.header.length;
    return ADCGS_OK;
}

/** The arrival to report for a chunk that was used. */
static adcgs_arrival arrival_of(const adcgs_push_reader *p, uint32_t type, int had_head, uint32_t segments_before)
{
    const adcgs_stream_reader *r = &p->reader;
    if (r->ended)
        return ADCGS_ARRIVED_END;
    if (type == ADCGS_TYPE_HEAD)
        return had_head ? ADCGS_ARRIVED_NOTHING : ADCGS_ARRIVED_HEADER;
    if (type == ADCGS_TYPE_cams)
        return ADCGS_ARRIVED_CAMERAS;
    const int draws = adcgs_segment_is_drawable(&r->segment);
    const int part = adcgs_type_layer(type) >= 0 || type == ADCGS_TYPE_GEOM;
    return (part && draws) || r->stream->n_segments > segments_before ? ADCGS_ARRIVED_SEGMENT : ADCGS_ARRIVED_NOTHING;
}

/** A segment has begun. end_before: tick at which the previous one, if any, ends. */
static void note_start(adcgs_push_reader *p, int64_t end_before)
{
    if (!p->has_start)
        p->start = p->reader.segment.ticks[0];
    p->has_start = 1;
    p->end_before = end_before;
}

static adcgs_status use_held(adcgs_push_reader *p, adcgs_arrival *arrived)
{
    int truncated, use = 1;
    if (!p->has_signature && p->options.tune_in && memcmp(p->held, ADCGS_SIGNATURE, ADCGS_SIGNATURE_BYTES) != 0) {
        p->has_signature = 1;
        p->search = SEARCH_HEAD;
    }
    if (p->search == SEARCH_HEAD)
        return search_head(p, arrived);
    if (!p->has_signature) {
        ADCGS_TRY(adcgs_stream_reader_signature(&p->reader));
        p->has_signature = 1;
        next_chunk(p);
        return ADCGS_OK;
    }
    if (p->n == ADCGS_CHUNK_HEADER_BYTES)
        return measure_chunk(p);
    if (p->search == SEARCH_KEY)
        ADCGS_TRY(search_key(p, &use));
    if (!use) {
        pass_over(p, p->n);
        next_chunk(p);
        return ADCGS_OK;
    }
    const uint32_t type = adcgs_load_le32(p->held), before = p->reader.stream->n_segments;
    const int64_t end = p->reader.segment.ticks[1];
    const int had_head = adcgs_push_has_head(p);
    ADCGS_TRY(adcgs_stream_reader_chunk(&p->reader, &truncated));
    if (type == ADCGS_TYPE_SEGM)
        note_start(p, end);
    *arrived = arrival_of(p, type, had_head, before);
    p->is_over = p->reader.ended;
    next_chunk(p);
    return p->is_over ? adcgs_stream_reader_rest(&p->reader) : ADCGS_OK; /* nothing is left to read; this computes the totals */
}

/** Report the reader's failure to the caller, in this call and in all later ones. */
static adcgs_status pass_on(const adcgs_push_reader *p, adcgs_status status, adcgs_error *error)
{
    if (status != ADCGS_OK && error)
        *error = p->error;
    return status;
}

static adcgs_status take_bytes(adcgs_push_reader *p, const uint8_t *data, size_t bytes, size_t *used, adcgs_arrival *arrived)
{
    while (*used < bytes && *arrived == ADCGS_ARRIVED_NOTHING && !p->is_over) {
        const size_t n = ADCGS_MIN(bytes - *used, p->wanted - p->n);
        ADCGS_TRY(reserve(p, p->n + n));
        memcpy(p->held + p->n, data + *used, n);
        p->n += n;
        *used += n;
        if (p->n < p->wanted)
            return ADCGS_OK;
        const int ends_chunk = p->n > ADCGS_CHUNK_HEADER_BYTES;
        ADCGS_TRY(use_held(p, arrived));
        if (ends_chunk)
            return ADCGS_OK;
    }
    return ADCGS_OK;
}

adcgs_status adcgs_push_take(adcgs_push_reader *p, const uint8_t *data, size_t bytes, size_t *used, adcgs_arrival *arrived,
                             adcgs_error *error)
{
    *used = 0;
    *arrived = p->is_over && p->error.status == ADCGS_OK ? ADCGS_ARRIVED_END : ADCGS_ARRIVED_NOTHING;
    if (p->error.status == ADCGS_OK && !p->is_over)
        p->error.status = take_bytes(p, data, bytes, used, arrived);
    return pass_on(p, p->error.status, error);
}

/** Fail: the stream had no header, or no key, at which decoding could begin. */
static adcgs_status end_search(adcgs_push_reader *p)
{
    const unsigned long long bytes = p->reader.source.pos + p->n;
    if (p->search == SEARCH_HEAD)
        return adcgs_fail(&p->error, ADCGS_ERR_DATA, "stream: not an adcgs stream: its %llu bytes contain no header", bytes);
    return adcgs_fail(&p->error, ADCGS_ERR_TRUNCATED, "stream: ends at byte %llu, before a key segment", bytes);
}

adcgs_status adcgs_push_finish(adcgs_push_reader *p, adcgs_error *error)
{
    if (p->error.status == ADCGS_OK && !p->is_over) {
        p->is_over = 1;
        p->error.status = p->search == SEARCH_OVER ? adcgs_stream_reader_rest(&p->reader) : end_search(p);
    }
    return pass_on(p, p->error.status, error);
}

/** Read the needed bytes. *over: the source or the stream has ended. */
static adcgs_status read_wanted(adcgs_push_reader *p, adcgs_read_fn read, void *user, int *over)
{
    adcgs_arrival arrived = ADCGS_ARRIVED_NOTHING;
    const size_t wanted = ADCGS_MIN(p->wanted - p->n, (size_t)READ_BYTES);
    ADCGS_TRY(reserve(p, p->n + wanted));
    const int64_t got = read(user, p->held + p->n, wanted);
    if (got < 0 || (uint64_t)got > wanted)
        return adcgs_fail(&p->error, ADCGS_ERR_IO, "stream: reading failed at byte %llu",
                          (unsigned long long)(p->reader.source.pos + p->n));
    p->n += (size_t)got;
    *over = got == 0;
    if (p->n == p->wanted)
        ADCGS_TRY(use_held(p, &arrived));
    *over |= p->is_over;
    return ADCGS_OK;
}

adcgs_status adcgs_push_read(adcgs_stream *stream, adcgs_read_fn read, void *user, const adcgs_read_options *options,
                             adcgs_error *error)
{
    adcgs_push_reader *p;
    int over = 0;
    adcgs_stream_init(stream);
    ADCGS_TRY(adcgs_push_create(&p, stream, options, error));
    adcgs_status status = ADCGS_OK;
    while (status == ADCGS_OK && !over)
        status = p->error.status = read_wanted(p, read, user, &over);
    status = status == ADCGS_OK ? adcgs_push_finish(p, error) : pass_on(p, status, error);
    adcgs_push_free(&p);
    if (status != ADCGS_OK)
        adcgs_stream_clear(stream, options->memory);
    return status;
}

int adcgs_push_has_head(const adcgs_push_reader *p)
{
    return p->reader.head_payload != NULL;
}

/** The tick before which no further byte can change any content. */
static int64_t committed_tick(const adcgs_push_reader *p)
{
    const adcgs_stream_reader *r = &p->reader;
    if (p->is_over || p->error.status != ADCGS_OK || r->indexed)
        return INT64_MAX;
    if (r->segment.stage != ADCGS_SEGMENT_NONE && adcgs_segment_is_whole(&r->segment))
        return r->segment.ticks[1];
    return r->stream->n_segments > 0 ? r->segment.ticks[0] : INT64_MIN;
}

/** End of the content that can be rendered. */
static int64_t available_tick(const adcgs_push_reader *p)
{
    const adcgs_segment *s = &p->reader.segment;
    if (adcgs_segment_is_drawable(s))
        return s->ticks[1];
    if (p->reader.stream->n_segments == 0)
        return INT64_MIN;
    return s->stage == ADCGS_SEGMENT_NONE ? s->ticks[1] : p->end_before;
}

void adcgs_push_get_progress(const adcgs_push_reader *p, adcgs_push_progress *out)
{
    const adcgs_stream_reader *r = &p->reader;
    const adcgs_stream *s = r->stream;
    const int has_segment = r->segment.stage != ADCGS_SEGMENT_NONE;
    *out = (adcgs_push_progress){
        .is_over = p->is_over,
        .bytes = r->source.pos + p->n,
        .start = p->has_start ? p->start : s->start_ticks,
        .end = s->duration_ticks >= 0 ? s->start_ticks + s->duration_ticks : INT64_MAX,
        .committed = committed_tick(p),
        .available = available_tick(p),
        .segments = adcgs_stream_reader_segments(r),
        .total = r->head.segments,
        .tiers = has_segment ? r->segment.model.finest + 1 : 0,
        .tiers_received = has_segment ? adcgs_segment_tiers(&r->segment) : 0,
    };
}

adcgs_status adcgs_push_peek(const adcgs_push_reader *p, adcgs_model *model, int *drawable, adcgs_error *error)
{
    return adcgs_segment_peek(&p->reader.segment, model, drawable, error);
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Reading a damaged stream. */
#include "stream/salvage.h"

#include "base/digest.h"
#include "stream/reader.h"

#include <stdarg.h>
#include <stdio.h>

#define PIECE_BYTES 65536 /* read at a time when searching for a header */
#define READ_AGAIN 16     /* maximum number of times that a stream is read: headers within damaged chunks may chain endlessly */

typedef struct salvage {
    adcgs_seekable input;
    adcgs_stream *stream;
    adcgs_read_options options;
    adcgs_stream_reader reader;
    adcgs_error why; /**< failure of the reader */
    uint64_t left;   /**< bytes that may still be read */
    uint32_t faults;
    int is_cut;     /**< tiers of the current segment were lost: its further chunks are skipped */
    int is_broken;  /**< a segment was lost since the last one that is not predicted */
    uint8_t *piece; /**< [PIECE_BYTES] */
} salvage;

static void warn(salvage *s, const char *format, ...) ADCGS_PRINTF(2, 3);
static void warn(salvage *s, const char *format, ...)
{
    char text[sizeof s->why.text];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    s->faults++;
    adcgs_log_say(&s->options.log, ADCGS_LOG_WARNING, "%s", text);
}

/** Read at most `bytes` bytes from a position, as many as exist. */
static adcgs_status fetch(salvage *s, uint64_t position, void *to, size_t bytes, size_t *got)
{
    adcgs_source_move(&s->reader.source, position);
    return adcgs_source_read(&s->reader.source, to, bytes, got, &s->why);
}

/** Whether these 16 bytes are the header of a chunk. A correct checksum by chance is practically impossible. */
static int is_header(const uint8_t *bytes, uint64_t origin, adcgs_chunk *chunk)
{
    const uint8_t letter = bytes[0] | 0x20;
    return letter >= 'a' && letter <= 'z' && adcgs_load_le32(bytes + 12) == adcgs_crc32c(0, bytes, 12) &&
           adcgs_chunk_header(bytes, origin, chunk, NULL) == ADCGS_OK;
}

/** Find the next header at or after a position, before `end`. *found: whether one exists. */
static adcgs_status find_header(salvage *s, uint64_t position, uint64_t end, adcgs_chunk *chunk, int *found)
{
    *found = 0;
    while (position + ADCGS_CHUNK_HEADER_BYTES <= end) {
        size_t got;
        ADCGS_TRY(fetch(s, position, s->piece, (size_t)ADCGS_MIN((uint64_t)PIECE_BYTES, end - position), &got));
        if (got < ADCGS_CHUNK_HEADER_BYTES)
            return ADCGS_OK;
        for (size_t i = 0; i + ADCGS_CHUNK_HEADER_BYTES <= got; i++)
            if (is_header(s->piece + i, position + i, chunk)) {
                *found = 1;
                return ADCGS_OK;
            }
        position += got - ADCGS_CHUNK_HEADER_BYTES + 1;
    }
    return ADCGS_OK;
}

/** Whether a fault is damage; other failures end the reading. */
static int is_damage(adcgs_status status)
{
    return status == ADCGS_ERR_DATA || status == ADCGS_ERR_TRUNCATED;
}

static uint32_t number_at_hand(const salvage *s)
{
    return s->stream->first_segment + s->stream->n_segments;
}

static void lose_segment(salvage *s, const char *why)
{
    const int fades = s->reader.segment.stage != ADCGS_SEGMENT_NONE && s->reader.segment.ticks[2] > 0;
    warn(s, "segment %u is lost%s: %.130s", number_at_hand(s), fades ? ", and the crossfade into the next one" : "", why);
    adcgs_segment_drop(&s->reader.segment);
    s->stream->first_segment++;
    s->is_broken = 1;
}

/** Lose the current tier and all finer ones; if it is the first tier, lose the segment. */
static void lose_tier(salvage *s, const char *why)
{
    adcgs_segment *at = &s->reader.segment;
    if (!adcgs_segment_is_drawable(at)) {
        lose_segment(s, why);
        return;
    }
    adcgs_segment_drop_tier(at);
    s->is_cut = 1;
    warn(s, "segment %u: its tiers from %d on are lost: %.150s", number_at_hand(s), at->tier + 1, why);
}

/** Finish the current segment, if any. */
static adcgs_status finish(salvage *s, uint64_t end)
{
    s->is_cut = 0;
    adcgs_segment_drop_tier(&s->reader.segment);
    const adcgs_status status = adcgs_segment_finish(&s->reader.segment, end, 0);
    if (!is_damage(status))
        return status;
    lose_segment(s, s->why.text);
    return ADCGS_OK;
}

/** Let the reader use an intact chunk. */
static adcgs_status use(salvage *s, const adcgs_chunk *chunk)
{
    int truncated;
    adcgs_source_move(&s->reader.source, chunk->origin);
    return adcgs_stream_reader_chunk(&s->reader, &truncated);
}

static adcgs_status use_start(salvage *s, const adcgs_chunk *chunk)
{
    ADCGS_TRY(finish(s, chunk->origin));
    const uint32_t ahead = (uint32_t)(uint16_t)(chunk->header.segment - number_at_hand(s));
    if (ahead) {
        warn(s, "segments %u to %u are lost: no part of them can be used", number_at_hand(s), number_at_hand(s) + ahead - 1);
        s->stream->first_segment += ahead;
        s->is_broken = 1;
    }
    const adcgs_status status = use(s, chunk);
    if (is_damage(status))
        lose_segment(s, s->why.text);
    else if (status != ADCGS_OK)
        return status;
    else if (!s->reader.segment.model.predicted)
        s->is_broken = 0;
    else if (s->is_broken)
        lose_segment(s, "it is predicted from a lost segment");
    return ADCGS_OK;
}

/** Use a damaged layer, as far as its slices are intact. */
static adcgs_status use_damaged_layer(salvage *s, const adcgs_chunk *chunk, size_t available)
{
    adcgs_parse p = {.origin = chunk->origin + ADCGS_CHUNK_HEADER_BYTES, .chunk = chunk->name, .error = &s->why};
    adcgs_reader_init(&p.r, s->reader.source.payload, available);
    return adcgs_segment_features(&s->reader.segment, &p, adcgs_type_layer(chunk->type), 0);
}

/** Use a chunk of the current segment. Without its base the segment is lost; higher layers and the digest are dispensable. */
static adcgs_status use_part(salvage *s, const adcgs_chunk *chunk, int whole, size_t available)
{
    const int layer = adcgs_type_layer(chunk->type);
    adcgs_status status = ADCGS_OK;
    if (s->reader.segment.stage == ADCGS_SEGMENT_NONE || chunk->header.segment != (number_at_hand(s) & 0xffff) || s->is_cut)
        return ADCGS_OK; /* its segment is lost */
    if (whole)
        status = use(s, chunk);
    else if (layer >= 0 && ADCGS_CHUNK_TIER(chunk->header.flags) == adcgs_segment_tier(&s->reader.segment, 0))
        status = use_damaged_layer(s, chunk, available);
    else if (chunk->type == ADCGS_TYPE_GEOM)
        lose_tier(s, "its positions are damaged");
    else if (chunk->type == ADCGS_TYPE_KEEP)
        lose_segment(s, "its KEEP is damaged");
    const adcgs_segment *at = &s->reader.segment;
    if (status == ADCGS_OK && layer == 0 && !whole && at->stage == ADCGS_SEGMENT_PLACED && at->done[0] < at->n_slices)
        lose_tier(s, "its base layer is damaged");
    if (!is_damage(status))
        return status;
    if (layer > 0 || chunk->type == ADCGS_TYPE_hash)
        warn(s, "segment %u: %.160s", number_at_hand(s), s->why.text);
    else if (chunk->type == ADCGS_TYPE_KEEP)
        lose_segment(s, s->why.text);
    else
        lose_tier(s, s->why.text);
    return ADCGS_OK;
}

/** Use a chunk that belongs to no segment. */
static adcgs_status use_other(salvage *s, const adcgs_chunk *chunk, int whole)
{
    if (!whole || chunk->type == ADCGS_TYPE_INDX) /* the index is not needed, and lists segments that may be lost */
        return ADCGS_OK;
    const adcgs_status status = use(s, chunk);
    if (!is_damage(status))
        return status;
    warn(s, "%.200s", s->why.text);
    return ADCGS_OK;
}

/** Handle ENDC. If it is intact, segments that HEAD counts but that were not found before it are lost. */
static adcgs_status use_end(salvage *s, const adcgs_chunk *chunk, int whole)
{
    ADCGS_TRY(finish(s, chunk->origin));
    s->reader.ended = 1;
    if (!whole)
        return ADCGS_OK;
    if (chunk->origin + ADCGS_CHUNK_BYTES + chunk->header.length != s->input.size)
        adcgs_log_say(&s->options.log, ADCGS_LOG_INFO, "stream: there are bytes after its end");
    const uint32_t expected = s->reader.head.segments;
    if (expected > number_at_hand(s)) {
        warn(s, "segments %u to %u are lost: no part of them can be used", number_at_hand(s), expected - 1);
        s->stream->first_segment = expected - s->stream->n_segments;
    }
    return ADCGS_OK;
}

static adcgs_status dispatch(salvage *s, const adcgs_chunk *chunk, int whole, size_t available)
{
    const uint32_t type = chunk->type;
    if (!s->reader.head_payload && type != ADCGS_TYPE_HEAD)
        return ADCGS_OK; /* useless before HEAD */
    if (type == ADCGS_TYPE_SEGM && !whole)
        return finish(s, chunk->origin); /* the gap in segment numbers will show the loss */
    if (type == ADCGS_TYPE_SEGM)
        return use_start(s, chunk);
    if (type == ADCGS_TYPE_ENDC)
        return use_end(s, chunk, whole);
    if (type == ADCGS_TYPE_KEEP || type == ADCGS_TYPE_GEOM || type == ADCGS_TYPE_hash || adcgs_type_layer(type) >= 0)
        return use_part(s, chunk, whole, available);
    return use_other(s, chunk, whole);
}

/** Whether a chunk is intact. available: bytes of its payload that are present, in the reader's memory. */
static adcgs_status look_whole(salvage *s, const adcgs_chunk *chunk, int *whole, size_t *available)
{
    adcgs_chunk read;
    adcgs_source_move(&s->reader.source, chunk->origin);
    const adcgs_status status = adcgs_chunk_read(&s->reader.source, s->reader.segment.limits, &read, &s->why);
    *whole = status == ADCGS_OK && read.complete;
    *available = read.available;
    return is_damage(status) ? ADCGS_OK : status;
}

/** Use the current chunk. *next: position to search for the next one, inside this chunk if it swallowed another header. */
static adcgs_status use_chunk(salvage *s, const adcgs_chunk *chunk, uint64_t *next)
{
    int whole, swallowed = 0;
    size_t available;
    adcgs_chunk inside;
    ADCGS_TRY(look_whole(s, chunk, &whole, &available));
    *next = chunk->origin + ADCGS_CHUNK_BYTES + chunk->header.length;
    if (whole)
        return dispatch(s, chunk, 1, available);
    warn(s, "%s at byte %llu is damaged", chunk->name, (unsigned long long)chunk->origin);
    ADCGS_TRY(dispatch(s, chunk, 0, available));
    const uint64_t end = ADCGS_MIN(*next, s->input.size);
    ADCGS_TRY(find_header(s, chunk->origin + ADCGS_CHUNK_HEADER_BYTES, end, &inside, &swallowed));
    *next = swallowed ? inside.origin : end;
    return ADCGS_OK;
}

static adcgs_status check_signature(salvage *s)
{
    uint8_t bytes[ADCGS_SIGNATURE_BYTES];
    size_t got;
    ADCGS_TRY(fetch(s, 0, bytes, sizeof bytes, &got));
    if (got < sizeof bytes || memcmp(bytes, ADCGS_SIGNATURE, sizeof bytes) != 0)
        warn(s, "stream: its signature is damaged");
    return ADCGS_OK;
}

static adcgs_status salvage_chunks(salvage *s)
{
    ADCGS_TRY(check_signature(s));
    for (uint64_t at = ADCGS_SIGNATURE_BYTES; !s->reader.ended;) {
        adcgs_chunk chunk;
        int found;
        ADCGS_TRY(find_header(s, at, s->input.size, &chunk, &found));
        const uint64_t cost = found ? chunk.header.length + (chunk.origin - at) + PIECE_BYTES / 64 : 0;
        if (cost > s->left)
            return adcgs_fail(&s->why, ADCGS_ERR_DATA, "stream: too many damaged chunks, the search ends at byte %llu",
                              (unsigned long long)at);
        s->left -= cost;
        if (found && chunk.origin > at)
            warn(s, "stream: %llu bytes from byte %llu on are not a chunk", (unsigned long long)(chunk.origin - at),
                 (unsigned long long)at);
        if (!found)
            break;
        ADCGS_TRY(use_chunk(s, &chunk, &at));
    }
    return ADCGS_OK;
}

/** Finish when no more chunks follow. */
static adcgs_status end(salvage *s)
{
    if (!s->reader.ended && s->reader.head_payload) {
        ADCGS_TRY(adcgs_segment_finish(&s->reader.segment, s->input.size, 1));
        warn(s, "stream: ends at byte %llu, before ENDC", (unsigned long long)s->input.size);
        s->stream->truncated = 1;
    }
    if (s->stream->n_segments == 0)
        return adcgs_fail(&s->why, ADCGS_ERR_DATA, "stream: no segment can be used");
    s->stream->first_segment = 0;
    s->stream->weights = (uint32_t)s->reader.nets.weights;
    adcgs_bytes_finish(&s->stream->bytes, s->input.size);
    return ADCGS_OK;
}

uint64_t adcgs_salvage_bytes(const uint8_t *data, size_t bytes)
{
    const size_t least = ADCGS_SIGNATURE_BYTES + ADCGS_CHUNK_BYTES;
    adcgs_parse p = {.chunk = "HEAD"};
    adcgs_syn_version version;
    adcgs_chunk chunk;
    if (bytes < least || !is_header(data + ADCGS_SIGNATURE_BYTES, ADCGS_SIGNATURE_BYTES, &chunk) ||
        chunk.type != ADCGS_TYPE_HEAD || chunk.header.length > bytes - least)
        return ADCGS_SALVAGE_BYTES;
    const uint8_t *const payload = data + ADCGS_SIGNATURE_BYTES + ADCGS_CHUNK_HEADER_BYTES;
    adcgs_reader_init(&p.r, payload, chunk.header.length);
    if (adcgs_load_le32(payload + chunk.header.length) != adcgs_crc32c(0, payload, chunk.header.length) ||
        adcgs_syn_version_parse(&p, &version) != ADCGS_OK || version.level < 1 || version.level > ADCGS_LEVELS)
        return ADCGS_SALVAGE_BYTES;
    return adcgs_level_get(version.level)->file_bytes;
}

adcgs_status adcgs_stream_salvage(adcgs_stream *stream, adcgs_read_at_fn read, void *user, uint64_t size,
                                  const adcgs_read_options *options, uint32_t *faults, adcgs_error *error)
{
    salvage s = {.input = {.read = read, .user = user, .size = size}, .stream = stream, .options = *options};
    s.options.conceal = 1;
    s.left = READ_AGAIN * size + PIECE_BYTES;
    adcgs_stream_init(stream);
    adcgs_stream_reader_init(&s.reader, stream, adcgs_seekable_read, &s.input, &s.options, &s.why);
    s.reader.nets.has_gaps = 1;
    s.piece = adcgs_alloc(options->memory, PIECE_BYTES, 1, &s.why);
    adcgs_status status = s.piece ? salvage_chunks(&s) : adcgs_alloc_status(&s.why);
    if (status == ADCGS_OK)
        status = end(&s);
    adcgs_free(options->memory, s.piece);
    adcgs_stream_reader_clear(&s.reader);
    *faults = s.faults;
    if (status == ADCGS_OK)
        return status;
    adcgs_stream_clear(stream, options->memory);
    if (error)
        *error = s.why;
    return status;
}

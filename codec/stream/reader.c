/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Reading a stream chunk by chunk from a source that cannot seek. */
#include "stream/reader.h"

#include "base/digest.h"

uint32_t adcgs_stream_reader_segments(const adcgs_stream_reader *s)
{
    return s->stream->first_segment + s->stream->n_segments;
}

adcgs_status adcgs_stream_reader_signature(adcgs_stream_reader *s)
{
    uint8_t bytes[ADCGS_SIGNATURE_BYTES];
    size_t got;
    ADCGS_TRY(adcgs_source_read(&s->source, bytes, sizeof bytes, &got, s->error));
    if (memcmp(bytes, ADCGS_SIGNATURE, got) != 0)
        return adcgs_fail(s->error, ADCGS_ERR_DATA, "stream: not an adcgs stream (the first bytes are not its signature)");
    if (got < sizeof bytes)
        return adcgs_fail(s->error, ADCGS_ERR_TRUNCATED, "stream: ends after %zu bytes, inside the signature", got);
    if (s->trace)
        s->trace(s->trace_user, 0, "stream.signature", "8b4144430d0a1a0a");
    return ADCGS_OK;
}

/** Parser for the elements of a chunk outside its payload. */
static adcgs_parse chunk_parts(const adcgs_stream_reader *s, const adcgs_chunk *chunk)
{
    const adcgs_parse p = {.origin = chunk->origin,
                           .chunk = "chunk",
                           .trace = s->trace,
                           .trace_user = s->trace_user,
                           .error = s->error};
    return p;
}

static adcgs_status skip_payload(adcgs_stream_reader *s, const adcgs_chunk *chunk)
{
    const adcgs_parse p = chunk_parts(s, chunk);
    adcgs_parse_trace(&p, 8 * ADCGS_CHUNK_HEADER_BYTES, "payload", "%u bytes", chunk->header.length);
    return ADCGS_OK;
}

/** Skip an ancillary chunk that this decoder does not know, or knows in an older version. */
static adcgs_status skip_unknown(adcgs_stream_reader *s, const adcgs_chunk *chunk)
{
    adcgs_log_say(&s->options->log, ADCGS_LOG_INFO, "%s: chunk of version %u, %u bytes, is unknown and was skipped", chunk->name,
                  chunk->header.version, chunk->header.length);
    return skip_payload(s, chunk);
}

static adcgs_status repeat_head(adcgs_stream_reader *s, const adcgs_chunk *chunk, const adcgs_parse *p)
{
    if (p->r.size != s->head_bytes || memcmp(p->r.data, s->head_payload, s->head_bytes) != 0)
        return adcgs_fail(s->error, ADCGS_ERR_DATA, "HEAD: repeated with other contents");
    return skip_payload(s, chunk);
}

static adcgs_status read_head(adcgs_stream_reader *s, adcgs_parse *p)
{
    const size_t bytes = p->r.size;
    ADCGS_TRY(adcgs_head_parse(p, &s->head, s->stream));
    s->head_payload = adcgs_alloc(s->options->memory, bytes, 1, s->error);
    if (!s->head_payload)
        return adcgs_alloc_status(s->error);
    memcpy(s->head_payload, p->r.data, bytes);
    s->head_bytes = bytes;
    s->segment.limits = adcgs_level_get(s->stream->level);
    s->segment.max_anchors = s->head.max_anchors;
    s->segment.left = (adcgs_cost){s->segment.limits->model_bytes, s->segment.limits->work};
    return ADCGS_OK;
}

static adcgs_status read_index(adcgs_stream_reader *s, adcgs_parse *p, uint64_t origin)
{
    uint32_t n;
    ADCGS_TRY(adcgs_segment_finish(&s->segment, origin, 0));
    s->indexed |= s->joined;
    if (s->joined)
        return ADCGS_OK;
    const adcgs_buffer *expected = &s->segment.index;
    const uint32_t segments = adcgs_stream_reader_segments(s);
    ADCGS_TRY(adcgs_parse_varint(p, "segments", segments, segments, &n));
    const uint8_t *entries = p->r.data + p->r.pos;
    for (uint32_t i = 0; i < n; i++) {
        adcgs_syn_index entry;
        ADCGS_TRY(adcgs_syn_index_parse(p, &entry));
    }
    if (s->indexed || n == 0 || memcmp(entries, expected->data, expected->size) != 0)
        return adcgs_fail(s->error, ADCGS_ERR_DATA, "INDX: repeated, or does not match the stream");
    s->indexed = 1;
    return adcgs_parse_end(p);
}

static adcgs_status read_end(adcgs_stream_reader *s, adcgs_parse *p, uint64_t origin)
{
    adcgs_syn_endc endc;
    ADCGS_TRY(adcgs_segment_finish(&s->segment, origin, 0));
    ADCGS_TRY(adcgs_syn_endc_parse(p, &endc));
    ADCGS_TRY(adcgs_parse_end(p));
    s->ended = s->joined;
    if (s->joined)
        return ADCGS_OK;
    if (endc.file_bytes != s->source.pos)
        return adcgs_fail(s->error, ADCGS_ERR_DATA, "ENDC: file_bytes is %llu, but the stream has %llu",
                          (unsigned long long)endc.file_bytes, (unsigned long long)s->source.pos);
    if (endc.crc_of_crcs != s->crc_of_crcs)
        return adcgs_fail(s->error, ADCGS_ERR_DATA, "ENDC: checksum over the chunks is wrong: a chunk was lost or exchanged");
    const uint32_t segments = adcgs_stream_reader_segments(s);
    if (segments == 0 || (s->head.segments > 0 && s->head.segments != segments))
        return adcgs_fail(s->error, ADCGS_ERR_DATA, "ENDC: the stream has %u segments, HEAD promises %u", segments,
                          s->head.segments);
    s->ended = 1;
    return ADCGS_OK;
}

static int belongs_to_segment(uint32_t type)
{
    return type == ADCGS_TYPE_SEGM || type == ADCGS_TYPE_KEEP || type == ADCGS_TYPE_GEOM || type == ADCGS_TYPE_hash ||
           adcgs_type_layer(type) >= 0;
}

/** Check the order of chunks and their versions before parsing any payload. */
static adcgs_status check_chunk(adcgs_stream_reader *s, const adcgs_chunk *chunk)
{
    const uint32_t type = chunk->type, number = adcgs_stream_reader_segments(s);
    const int critical = chunk->name[0] >= 'A' && chunk->name[0] <= 'Z';
    if (!s->head_payload && type != ADCGS_TYPE_HEAD)
        return adcgs_fail(s->error, ADCGS_ERR_DATA, "%s: the first chunk must be HEAD", chunk->name);
    if (critical && chunk->header.version > 0)
        return adcgs_fail(s->error, ADCGS_ERR_UNSUPPORTED, "%s: version of the chunk is %u, this decoder knows 0", chunk->name,
                          chunk->header.version);
    if (critical && s->indexed && type != ADCGS_TYPE_ENDC)
        return adcgs_fail(s->error, ADCGS_ERR_DATA, "%s: only ENDC may follow INDX", chunk->name);
    if (belongs_to_segment(type)) {
        const int ends_another = type == ADCGS_TYPE_SEGM && s->segment.stage != ADCGS_SEGMENT_NONE;
        const uint32_t expected = (number + (uint32_t)ends_another) & 0xffff;
        if (chunk->header.segment != expected)
            return adcgs_fail(s->error, ADCGS_ERR_DATA, "%s: segment is %u, expected %u", chunk->name, chunk->header.segment,
                              expected);
    }
    const int is_geom = type == ADCGS_TYPE_GEOM, tier = adcgs_segment_tier(&s->segment, is_geom);
    if ((is_geom || adcgs_type_layer(type) >= 0) && ADCGS_CHUNK_TIER(chunk->header.flags) != tier)
        return adcgs_fail(s->error, ADCGS_ERR_DATA, "%s: tier is %d, expected %d", chunk->name,
                          ADCGS_CHUNK_TIER(chunk->header.flags), tier);
    return ADCGS_OK;
}

static adcgs_status use_chunk(adcgs_stream_reader *s, const adcgs_chunk *chunk, adcgs_parse *p)
{
    const uint32_t type = chunk->type;
    if (adcgs_type_layer(type) >= 0)
        return adcgs_segment_features(&s->segment, p, adcgs_type_layer(type), chunk->complete);
    switch (type) {
    case ADCGS_TYPE_HEAD:
        return s->head_payload ? repeat_head(s, chunk, p) : read_head(s, p);
    case ADCGS_TYPE_NETW:
        ADCGS_TRY(adcgs_netw_parse(p, &s->stream->params, s->segment.limits, &s->segment.left, &s->nets));
        adcgs_segment_networks(&s->segment);
        return ADCGS_OK;
    case ADCGS_TYPE_SEGM:
        ADCGS_TRY(adcgs_segment_finish(&s->segment, chunk->origin, 0));
        return adcgs_segment_start(&s->segment, p, chunk->origin);
    case ADCGS_TYPE_KEEP:
        return adcgs_segment_keep(&s->segment, p);
    case ADCGS_TYPE_GEOM:
        return adcgs_segment_place(&s->segment, p);
    case ADCGS_TYPE_hash:
        return adcgs_segment_hash(&s->segment, p);
    case ADCGS_TYPE_cams:
        return adcgs_cams_parse(p, s->stream, s->options->memory);
    case ADCGS_TYPE_meta:
        return adcgs_meta_parse(p, s->stream, s->options->memory);
    case ADCGS_TYPE_INDX:
        return read_index(s, p, chunk->origin);
    case ADCGS_TYPE_ENDC:
        return read_end(s, p, chunk->origin);
    default:
        if (chunk->name[0] >= 'a') /* ancillary */
            return skip_unknown(s, chunk);
        return adcgs_fail(s->error, ADCGS_ERR_UNSUPPORTED, "%s: unknown critical chunk at byte %llu", chunk->name,
                          (unsigned long long)chunk->origin);
    }
}

/** Ancillary chunks of a newer version are skipped like unknown ones. Of incomplete chunks, only layers are used. */
static adcgs_status use_or_skip(adcgs_stream_reader *s, const adcgs_chunk *chunk, adcgs_parse *p)
{
    if (!chunk->complete && adcgs_type_layer(chunk->type) < 0)
        return ADCGS_OK;
    if (chunk->name[0] >= 'a' && chunk->header.version > 0)
        return skip_unknown(s, chunk);
    return use_chunk(s, chunk, p);
}

/** A complete chunk: include its checksum in ENDC's sum. */
static void end_chunk(adcgs_stream_reader *s, const adcgs_chunk *chunk)
{
    const adcgs_parse p = chunk_parts(s, chunk);
    uint8_t crc[4];
    adcgs_parse_trace(&p, 8 * (ADCGS_CHUNK_HEADER_BYTES + (uint64_t)chunk->header.length), "payload_crc", "%u", chunk->crc);
    adcgs_store_le32(crc, chunk->crc);
    s->crc_of_crcs = adcgs_crc32c(s->crc_of_crcs, crc, sizeof crc);
}

adcgs_status adcgs_stream_reader_chunk(adcgs_stream_reader *s, int *truncated)
{
    adcgs_chunk chunk;
    ADCGS_TRY(adcgs_chunk_read(&s->source, s->segment.limits, &chunk, s->error));
    *truncated = !chunk.complete;
    if (chunk.ended)
        return ADCGS_OK;
    ADCGS_TRY(check_chunk(s, &chunk));
    adcgs_bytes_count(&s->stream->bytes, chunk.type, chunk.available);
    adcgs_parse p = {.origin = chunk.origin + ADCGS_CHUNK_HEADER_BYTES,
                     .chunk = chunk.name,
                     .trace = s->trace,
                     .trace_user = s->trace_user,
                     .error = s->error};
    adcgs_reader_init(&p.r, s->source.payload, chunk.available);
    ADCGS_TRY(use_or_skip(s, &chunk, &p));
    if (chunk.complete)
        end_chunk(s, &chunk);
    return ADCGS_OK;
}

/** The stream ended before ENDC: use its complete part, or fail. */
static adcgs_status end_early(adcgs_stream_reader *s)
{
    const unsigned long long at = s->source.pos;
    if (s->options->strict_end || !s->head_payload)
        return adcgs_fail(s->error, ADCGS_ERR_TRUNCATED, "stream: ends at byte %llu, before %s", at,
                          s->head_payload ? "ENDC" : "HEAD");
    ADCGS_TRY(adcgs_segment_finish(&s->segment, s->source.pos, 1));
    if (s->stream->n_segments == 0)
        return adcgs_fail(s->error, ADCGS_ERR_TRUNCATED, "stream: ends at byte %llu, before the base layer of its first segment",
                          at);
    s->stream->truncated = 1;
    adcgs_log_say(&s->options->log, ADCGS_LOG_WARNING, "stream: ends at byte %llu, before ENDC: %u segments are used", at,
                  (unsigned)adcgs_stream_reader_segments(s));
    return ADCGS_OK;
}

adcgs_status adcgs_stream_reader_rest(adcgs_stream_reader *s)
{
    int truncated = 0;
    if (s->source.pos < ADCGS_SIGNATURE_BYTES)
        ADCGS_TRY(adcgs_stream_reader_signature(s));
    while (!truncated && !s->ended)
        ADCGS_TRY(adcgs_stream_reader_chunk(s, &truncated));
    if (truncated)
        ADCGS_TRY(end_early(s));
    s->stream->weights = (uint32_t)s->nets.weights;
    adcgs_bytes_finish(&s->stream->bytes, s->source.pos);
    return ADCGS_OK;
}

void adcgs_stream_reader_init(adcgs_stream_reader *s, adcgs_stream *stream, adcgs_read_fn read, void *user,
                              const adcgs_read_options *options, adcgs_error *error)
{
    memset(s, 0, sizeof *s);
    s->stream = stream;
    s->options = options;
    s->error = error;
    s->source = (adcgs_source){.read = read, .user = user, .memory = options->memory};
    s->nets.memory = options->memory;
    s->segment = (adcgs_segment){.stream = stream, .options = options, .nets = &s->nets, .error = error};
}

void adcgs_stream_reader_clear(adcgs_stream_reader *s)
{
    adcgs_segment_clear(&s->segment);
    adcgs_net_table_clear(&s->nets);
    adcgs_free(s->options->memory, s->head_payload);
    adcgs_source_clear(&s->source);
}

adcgs_status adcgs_stream_read(adcgs_stream *stream, adcgs_read_fn read, void *user, const adcgs_read_options *options,
                               adcgs_trace_fn trace, void *trace_user, adcgs_error *error)
{
    adcgs_error why = {ADCGS_OK, ""};
    adcgs_stream_reader s;
    adcgs_stream_init(stream);
    adcgs_stream_reader_init(&s, stream, read, user, options, &why);
    s.trace = s.source.trace = trace;
    s.trace_user = s.source.trace_user = trace_user;
    const adcgs_status status = adcgs_stream_reader_rest(&s);
    adcgs_stream_reader_clear(&s);
    if (status != ADCGS_OK) {
        adcgs_stream_clear(stream, options->memory);
        if (error)
            *error = why;
    }
    return status;
}

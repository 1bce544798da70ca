/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Chunk framing in both directions, and levels. */
#include "stream/chunk.h"

#include "base/digest.h"
#include "model/model_priv.h"

#define STEP_BYTES 65536 /* payload memory grows with the bytes that arrive, not with the length in the header */
#define SEGMENT_BYTES 8192
/* Work of operations that take longer than a multiplication and addition, in units of one: a coded value, the splits for one bit
 * of depth of a position, a coded weight. */
#define VALUE_WORK 512
#define DEPTH_WORK 8192
#define WEIGHT_WORK 1024

const adcgs_level *adcgs_level_get(int level)
{
    static const adcgs_level levels[ADCGS_LEVELS] = {
        {.anchors = 4096,
         .segments = 16,
         .depth = 12,
         .weights = UINT32_C(1) << 19,
         .networks = 256,
         .file_bytes = UINT64_C(4) << 20,
         .chunk_bytes = UINT64_C(2) << 20,
         .model_bytes = UINT64_C(32) << 20,
         .work = UINT64_C(1) << 34},
        {.anchors = 65536,
         .segments = 4096,
         .depth = 16,
         .weights = UINT32_C(1) << 21,
         .networks = 4096,
         .file_bytes = UINT64_C(256) << 20,
         .chunk_bytes = UINT64_C(32) << 20,
         .model_bytes = UINT64_C(256) << 20,
         .work = UINT64_C(1) << 36},
        {.anchors = 1048576,
         .segments = 65535,
         .depth = 21,
         .weights = UINT32_C(1) << 24,
         .networks = 65536,
         .file_bytes = UINT64_C(64) << 30,
         .chunk_bytes = UINT64_C(1) << 30,
         .model_bytes = UINT64_C(4) << 30,
         .work = UINT64_C(1) << 40},
    };
    return &levels[level - 1];
}

int adcgs_type_layer(uint32_t type)
{
    for (int layer = 0; layer < ADCGS_LAYERS; layer++)
        if (type == ADCGS_TYPE_FEA(layer))
            return layer;
    return -1;
}

void adcgs_nets_cost_add(adcgs_nets_cost *cost, const adcgs_params *params, int role, const adcgs_net *net)
{
    const uint64_t weights = adcgs_net_weights(net);
    const int per_primitive = (role >= ADCGS_ROLE_ENTROPY_FG && role < ADCGS_ROLE_ENTROPY_STEPS) || role == ADCGS_ROLE_PREDICTION;
    cost->weights += weights;
    if (role != ADCGS_ROLE_TIME)
        cost->evaluated += weights * (per_primitive ? params->k : 1U);
}

adcgs_cost adcgs_segment_cost(const adcgs_params *params, uint64_t anchors, int depth, const adcgs_nets_cost *nets)
{
    const uint64_t values = adcgs_anchor_values(params);
    const adcgs_cost cost = {
        .bytes = SEGMENT_BYTES + anchors * adcgs_anchor_bytes(params) + nets->weights * sizeof(int32_t),
        .work = anchors * (nets->evaluated + VALUE_WORK * values + DEPTH_WORK * (uint64_t)depth),
    };
    return cost;
}

uint64_t adcgs_inter_work(uint64_t values)
{
    return VALUE_WORK * values;
}

uint64_t adcgs_weights_work(uint64_t weights)
{
    return WEIGHT_WORK * weights;
}

adcgs_status adcgs_source_read(adcgs_source *source, void *buffer, size_t bytes, size_t *got, adcgs_error *error)
{
    for (*got = 0; *got < bytes;) {
        const int64_t n = source->read(source->user, (uint8_t *)buffer + *got, bytes - *got);
        if (n < 0 || (uint64_t)n > bytes - *got)
            return adcgs_fail(error, ADCGS_ERR_IO, "stream: reading failed at byte %llu",
                              (unsigned long long)(source->pos + *got));
        if (n == 0)
            break;
        *got += (size_t)n;
    }
    source->pos += *got;
    return ADCGS_OK;
}

static adcgs_status grow_buffer(adcgs_source *source, size_t wanted, adcgs_error *error)
{
    if (wanted <= source->capacity)
        return ADCGS_OK;
    const size_t capacity = ADCGS_MAX(wanted, 2 * source->capacity);
    uint8_t *payload = adcgs_alloc(source->memory, capacity, 1, error);
    if (!payload)
        return adcgs_alloc_status(error);
    if (source->capacity > 0)
        memcpy(payload, source->payload, source->capacity);
    adcgs_free(source->memory, source->payload);
    source->payload = payload;
    source->capacity = capacity;
    return ADCGS_OK;
}

void adcgs_source_clear(adcgs_source *source)
{
    adcgs_free(source->memory, source->payload);
    source->payload = NULL;
    source->capacity = 0;
}

int64_t adcgs_seekable_read(void *user, void *buffer, size_t bytes)
{
    adcgs_seekable *s = user;
    const size_t n = s->at < s->size ? (size_t)ADCGS_MIN((uint64_t)bytes, s->size - s->at) : 0;
    const int64_t got = n > 0 ? s->read(s->user, s->at, buffer, n) : 0;
    if (got > 0 && (uint64_t)got <= n) {
        s->at += (uint64_t)got;
        s->bytes += (uint64_t)got;
    }
    return got;
}

void adcgs_source_move(adcgs_source *source, uint64_t position)
{
    adcgs_seekable *s = source->user;
    s->at = source->pos = position;
}

static adcgs_status read_payload(adcgs_source *source, adcgs_chunk *chunk, adcgs_error *error)
{
    const size_t length = chunk->header.length;
    size_t got = 1;
    ADCGS_TRY(grow_buffer(source, STEP_BYTES, error));
    for (chunk->available = 0; chunk->available < length && got > 0; chunk->available += got) {
        if (chunk->available == source->capacity)
            ADCGS_TRY(grow_buffer(source, ADCGS_MIN(length, 2 * source->capacity), error));
        const size_t room = ADCGS_MIN(length, source->capacity) - chunk->available;
        ADCGS_TRY(adcgs_source_read(source, source->payload + chunk->available, room, &got, error));
    }
    return ADCGS_OK;
}

/** Whether the type has only letters and digits, so that a message can show it. */
static int type_is_text(const char *name)
{
    for (int i = 0; i < 4; i++) {
        const int letter = (name[i] >= 'a' && name[i] <= 'z') || (name[i] >= 'A' && name[i] <= 'Z');
        if (!letter && (i == 0 || name[i] < '0' || name[i] > '9'))
            return 0;
    }
    return 1;
}

static adcgs_status parse_header(const adcgs_source *source, adcgs_chunk *chunk, const uint8_t bytes[ADCGS_CHUNK_HEADER_BYTES],
                                 adcgs_error *error)
{
    adcgs_parse p = {.origin = chunk->origin,
                     .chunk = "chunk",
                     .trace = source->trace,
                     .trace_user = source->trace_user,
                     .error = error};
    adcgs_reader_init(&p.r, bytes, ADCGS_CHUNK_HEADER_BYTES);
    if (adcgs_load_le32(bytes + ADCGS_CHUNK_HEADER_BYTES - 4) != adcgs_crc32c(0, bytes, ADCGS_CHUNK_HEADER_BYTES - 4))
        return adcgs_fail(error, ADCGS_ERR_DATA, "chunk header at byte %llu: checksum is wrong",
                          (unsigned long long)chunk->origin);
    chunk->type = (uint32_t)adcgs_read_uint(&p.r, 4);
    adcgs_store_le32((uint8_t *)chunk->name, chunk->type);
    if (!type_is_text(chunk->name))
        return adcgs_fail(error, ADCGS_ERR_DATA,
                          "chunk header at byte %llu: type %08x is not a letter followed by letters and digits",
                          (unsigned long long)chunk->origin, chunk->type);
    adcgs_parse_trace(&p, 0, "type", "%s", chunk->name);
    return adcgs_syn_chunk_header_parse(&p, &chunk->header);
}

adcgs_status adcgs_chunk_header(const uint8_t bytes[ADCGS_CHUNK_HEADER_BYTES], uint64_t origin, adcgs_chunk *chunk,
                                adcgs_error *error)
{
    const adcgs_source untraced = {.pos = origin};
    *chunk = (adcgs_chunk){.origin = origin};
    return parse_header(&untraced, chunk, bytes, error);
}

adcgs_status adcgs_chunk_check_limits(const adcgs_chunk *chunk, const adcgs_level *limits, adcgs_error *error)
{
    const uint64_t length = chunk->header.length, most = limits ? limits->chunk_bytes : ADCGS_HEAD_BYTES_MAX;
    if (length > most)
        return adcgs_fail(error, ADCGS_ERR_LIMIT, "%s: payload of %llu bytes exceeds the limit of %llu", chunk->name,
                          (unsigned long long)length, (unsigned long long)most);
    if (limits && chunk->origin + ADCGS_CHUNK_BYTES + length > limits->file_bytes)
        return adcgs_fail(error, ADCGS_ERR_LIMIT, "%s: the stream exceeds its level's limit of %llu bytes", chunk->name,
                          (unsigned long long)limits->file_bytes);
    return ADCGS_OK;
}

adcgs_status adcgs_chunk_read(adcgs_source *source, const adcgs_level *limits, adcgs_chunk *chunk, adcgs_error *error)
{
    uint8_t bytes[ADCGS_CHUNK_HEADER_BYTES];
    size_t got;
    *chunk = (adcgs_chunk){.origin = source->pos};
    ADCGS_TRY(adcgs_source_read(source, bytes, sizeof bytes, &got, error));
    chunk->ended = got < sizeof bytes;
    if (chunk->ended)
        return ADCGS_OK;
    ADCGS_TRY(parse_header(source, chunk, bytes, error));
    ADCGS_TRY(adcgs_chunk_check_limits(chunk, limits, error));
    ADCGS_TRY(read_payload(source, chunk, error));
    if (chunk->available < chunk->header.length)
        return ADCGS_OK;
    ADCGS_TRY(adcgs_source_read(source, bytes, 4, &got, error));
    chunk->complete = got == 4;
    if (!chunk->complete)
        return ADCGS_OK;
    chunk->crc = adcgs_load_le32(bytes);
    if (chunk->crc != adcgs_crc32c(0, source->payload, chunk->header.length))
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s at byte %llu: checksum of the payload is wrong", chunk->name,
                          (unsigned long long)chunk->origin);
    return ADCGS_OK;
}

size_t adcgs_chunk_begin(adcgs_buffer *out, uint32_t type, uint32_t segment, int flags)
{
    const size_t begin = out->size;
    adcgs_write_uint(out, type, 4);
    adcgs_write_uint(out, 0, 4); /* the length, filled in at the end */
    adcgs_write_uint(out, segment, 2);
    adcgs_write_uint(out, (uint64_t)flags, 1);
    adcgs_write_uint(out, 0, 1);
    adcgs_write_uint(out, 0, 4);
    return begin;
}

void adcgs_chunk_end(adcgs_buffer *out, size_t begin)
{
    if (out->failed)
        return;
    uint8_t *header = out->data + begin;
    const size_t length = out->size - begin - ADCGS_CHUNK_HEADER_BYTES;
    adcgs_store_le32(header + 4, (uint32_t)length);
    adcgs_store_le32(header + 12, adcgs_crc32c(0, header, 12));
    adcgs_write_uint(out, adcgs_crc32c(0, header + ADCGS_CHUNK_HEADER_BYTES, length), 4);
}

void adcgs_bytes_count(adcgs_bytes *bytes, uint32_t type, uint64_t payload)
{
    if (adcgs_type_layer(type) >= 0)
        bytes->layer[adcgs_type_layer(type)] += payload;
    else if (type == ADCGS_TYPE_NETW)
        bytes->networks += payload;
    else if (type == ADCGS_TYPE_GEOM || type == ADCGS_TYPE_KEEP)
        bytes->geometry += payload;
    else if (type == ADCGS_TYPE_cams)
        bytes->cameras += payload;
    else if (type != ADCGS_TYPE_HEAD && type != ADCGS_TYPE_SEGM && type != ADCGS_TYPE_INDX && type != ADCGS_TYPE_ENDC &&
             type != ADCGS_TYPE_hash)
        bytes->metadata += payload;
}

void adcgs_bytes_finish(adcgs_bytes *bytes, uint64_t total)
{
    uint64_t payloads = bytes->networks + bytes->geometry + bytes->cameras + bytes->metadata;
    for (int i = 0; i < ADCGS_LAYERS; i++)
        payloads += bytes->layer[i];
    bytes->total = total;
    bytes->header = total - payloads;
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Chunks: reading them one by one from a sequential source, framing them when writing, and the levels that bound them. */
#ifndef ADCGS_STREAM_CHUNK_H
#define ADCGS_STREAM_CHUNK_H

#include "stream/syntax.h"

#define ADCGS_SIGNATURE \
    "\x8B"              \
    "ADC\r\n\x1A\n"
#define ADCGS_SIGNATURE_BYTES 8
#define ADCGS_CHUNK_HEADER_BYTES 16 /**< with its CRC */
#define ADCGS_CHUNK_BYTES 20        /**< header and CRC of the payload */
#define ADCGS_HEAD_BYTES_MAX 1024   /**< longest HEAD payload, the only one read before the level is known */

#define ADCGS_TYPE(a, b, c, d) ((uint32_t)(a) | (uint32_t)(b) << 8 | (uint32_t)(c) << 16 | (uint32_t)(d) << 24)
#define ADCGS_TYPE_HEAD ADCGS_TYPE('H', 'E', 'A', 'D')
#define ADCGS_TYPE_NETW ADCGS_TYPE('N', 'E', 'T', 'W')
#define ADCGS_TYPE_SEGM ADCGS_TYPE('S', 'E', 'G', 'M')
#define ADCGS_TYPE_KEEP ADCGS_TYPE('K', 'E', 'E', 'P')
#define ADCGS_TYPE_GEOM ADCGS_TYPE('G', 'E', 'O', 'M')
#define ADCGS_TYPE_FEA0 ADCGS_TYPE('F', 'E', 'A', '0')
#define ADCGS_TYPE_FEA4 ADCGS_TYPE('F', 'E', 'A', '4')
#define ADCGS_TYPE_FEA(layer) (ADCGS_TYPE_FEA0 + ((uint32_t)(layer) << 24))
#define ADCGS_TYPE_INDX ADCGS_TYPE('I', 'N', 'D', 'X')
#define ADCGS_TYPE_ENDC ADCGS_TYPE('E', 'N', 'D', 'C')
#define ADCGS_TYPE_hash ADCGS_TYPE('h', 'a', 's', 'h')
#define ADCGS_TYPE_cams ADCGS_TYPE('c', 'a', 'm', 's')
#define ADCGS_TYPE_meta ADCGS_TYPE('m', 'e', 't', 'a')

#define ADCGS_CHUNK_KEY 1                          /**< flag of SEGM: the segment depends on no earlier one */
#define ADCGS_CHUNK_LAST 2                         /**< flag: last chunk of its segment */
#define ADCGS_CHUNK_TIER(flags) ((flags) >> 4 & 7) /**< bits 4 to 6 of the flags of GEOM and FEAx: the tier */
#define ADCGS_CHUNK_OF_TIER(tier) ((tier) << 4)

/** Layer of a FEAx type, or -1. */
int adcgs_type_layer(uint32_t type);

/** Bounds of a level (spec "Levels"). Every count is checked before anything is allocated for it. */
typedef struct adcgs_level {
    uint32_t anchors; /**< per segment */
    uint32_t segments;
    uint32_t depth;
    uint32_t weights;  /**< over the networks of the stream */
    uint32_t networks; /**< of the stream */
    uint64_t file_bytes, chunk_bytes, model_bytes;
    uint64_t work; /**< for decoding the stream and its primitives; one unit is about a multiplication and addition */
} adcgs_level;
#define ADCGS_LEVELS 3
/** level 1..ADCGS_LEVELS. */
const adcgs_level *adcgs_level_get(int level);
/** Amounts counted towards model_bytes and work, or remaining of them. */
typedef struct adcgs_cost {
    uint64_t bytes, work;
} adcgs_cost;
/** The networks' part of a segment's cost: weights count once per segment, evaluated weights once per anchor. */
typedef struct adcgs_nets_cost {
    uint64_t weights, evaluated;
} adcgs_nets_cost;
void adcgs_nets_cost_add(adcgs_nets_cost *cost, const adcgs_params *params, int role, const adcgs_net *net);
adcgs_cost adcgs_segment_cost(const adcgs_params *params, uint64_t anchors, int depth, const adcgs_nets_cost *nets);
/** Work of decoding the kept anchors of a model with this number of values, adcgs_inter_values(). */
uint64_t adcgs_inter_work(uint64_t values);
/** Work of decoding this number of weights, whether they are new or repeated. */
uint64_t adcgs_weights_work(uint64_t weights);

/** The stream as a sequence of bytes. */
typedef struct adcgs_source {
    adcgs_read_fn read;
    void *user;
    uint64_t pos;     /**< bytes read so far */
    uint8_t *payload; /**< of the last chunk read; reused, grows as data arrives */
    size_t capacity;
    adcgs_memory *memory;
    adcgs_trace_fn trace; /**< receives the elements of chunk headers; may be NULL */
    void *trace_user;
} adcgs_source;

/** A stream of known size with random access; the user argument of adcgs_seekable_read() for a source. */
typedef struct adcgs_seekable {
    adcgs_read_at_fn read;
    void *user;
    uint64_t size, at; /**< total bytes; position of the next read */
    uint64_t bytes;    /**< read so far */
} adcgs_seekable;

/** A chunk as read. The stream may have ended inside it. */
typedef struct adcgs_chunk {
    uint32_t type;
    char name[5]; /**< the type as text */
    adcgs_syn_chunk_header header;
    uint64_t origin;  /**< position of the chunk */
    size_t available; /**< payload bytes that were present */
    int complete;     /**< header, payload and CRC were all present */
    int ended;        /**< the stream ended before the header was complete */
    uint32_t crc;     /**< of the payload */
} adcgs_chunk;

/** Fill buffer, as far as the stream goes. */
adcgs_status adcgs_source_read(adcgs_source *source, void *buffer, size_t bytes, size_t *got, adcgs_error *error);
/** Parse the 16 bytes of a chunk header at position origin. Damage is ADCGS_ERR_DATA. */
adcgs_status adcgs_chunk_header(const uint8_t bytes[ADCGS_CHUNK_HEADER_BYTES], uint64_t origin, adcgs_chunk *chunk,
                                adcgs_error *error);
/** Check that the length and position of a chunk are allowed; limits as below. */
adcgs_status adcgs_chunk_check_limits(const adcgs_chunk *chunk, const adcgs_level *limits, adcgs_error *error);
/** Read the next chunk; limits may be NULL (then a payload has at most ADCGS_HEAD_BYTES_MAX bytes). Damage is ADCGS_ERR_DATA. */
adcgs_status adcgs_chunk_read(adcgs_source *source, const adcgs_level *limits, adcgs_chunk *chunk, adcgs_error *error);
void adcgs_source_clear(adcgs_source *source);
/** An adcgs_read_fn; user is an adcgs_seekable. */
int64_t adcgs_seekable_read(void *user, void *buffer, size_t bytes);
/** Continue at this position; the source's user is an adcgs_seekable. */
void adcgs_source_move(adcgs_source *source, uint64_t position);

/** Frame a chunk: all bytes appended to out between the two calls are its payload. */
size_t adcgs_chunk_begin(adcgs_buffer *out, uint32_t type, uint32_t segment, int flags);
void adcgs_chunk_end(adcgs_buffer *out, size_t begin);
/** Account for a chunk's payload. At the end, all bytes of the total not accounted for count as header. */
void adcgs_bytes_count(adcgs_bytes *bytes, uint32_t type, uint64_t payload);
void adcgs_bytes_finish(adcgs_bytes *bytes, uint64_t total);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Fixed-size syntax structures: one list of elements per structure (syntax.h)
 * drives parsing, range checks, tracing and writing.
 */
#ifndef ADCGS_STREAM_FIELDS_H
#define ADCGS_STREAM_FIELDS_H

#include "bits/range.h"
#include "stream/stream.h"

typedef enum adcgs_field_type {
    ADCGS_U8,
    ADCGS_U16,
    ADCGS_U32,
    ADCGS_U64,
    ADCGS_I16,
    ADCGS_I64,
    ADCGS_F32,
    ADCGS_F64
} adcgs_field_type;

/** One element, or an array of count: its position in the structure and its range. */
typedef struct adcgs_field {
    const char *name;
    uint8_t type, count;
    uint16_t offset;
    double min, max; /**< integers are at most 2^53 in magnitude, so that binary64 compares them exactly */
} adcgs_field;

/** Parsing of one chunk payload. */
typedef struct adcgs_parse {
    adcgs_reader r;
    uint64_t origin;   /**< position of the payload in the stream, bytes */
    const char *chunk; /**< type of the chunk, for messages */
    adcgs_trace_fn trace;
    void *trace_user;
    adcgs_error *error;
} adcgs_parse;

/** Read n elements in order into structure. ADCGS_ERR_DATA names the element that is cut off or out of range. */
adcgs_status adcgs_parse_fields(adcgs_parse *p, const adcgs_field *fields, size_t n, void *structure);
adcgs_status adcgs_parse_varint(adcgs_parse *p, const char *name, uint32_t min, uint32_t max, uint32_t *value);
/** Get the next n bytes, which stay in the payload. The trace shows their number. */
adcgs_status adcgs_parse_bytes(adcgs_parse *p, const char *name, size_t n, const uint8_t **bytes);
/** Parse a varint length in min..max, then as many bytes, none of them zero. *text is allocated and zero-terminated. */
adcgs_status adcgs_parse_text(adcgs_parse *p, const char *name, uint32_t min, uint32_t max, adcgs_memory *memory, char **text);
/** ADCGS_ERR_DATA if bytes of the payload are left. */
adcgs_status adcgs_parse_end(const adcgs_parse *p);
/** Report an element to the trace; bit counts from the start of the payload. */
void adcgs_parse_trace(const adcgs_parse *p, uint64_t bit, const char *name, const char *format, ...) ADCGS_PRINTF(4, 5);
/** Report the final state of a range decoder that has finished its sub-stream; the sub-stream lies in the payload. */
void adcgs_parse_trace_end(const adcgs_parse *p, const adcgs_range_dec *d);

/** Append n elements. ADCGS_ERR_USAGE names one that is out of range. */
adcgs_status adcgs_write_fields(adcgs_buffer *out, const char *chunk, const adcgs_field *fields, size_t n, const void *structure,
                                adcgs_error *error);

#endif

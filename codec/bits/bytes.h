/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Bounded reading and growing writing of byte-aligned little-endian fields.
 * Errors are sticky: reading past the end yields zeros and sets a flag, which
 * callers check once per structure.
 */
#ifndef ADCGS_BITS_BYTES_H
#define ADCGS_BITS_BYTES_H

#include "base/base.h"

typedef struct adcgs_reader {
    const uint8_t *data;
    size_t size, pos;
    int overrun; /**< set once a read went past the end */
} adcgs_reader;

void adcgs_reader_init(adcgs_reader *r, const void *data, size_t size);
uint64_t adcgs_read_uint(adcgs_reader *r, int bytes); /**< 1..8 bytes, little-endian */
/** LEB128, at most 5 bytes and 32 bits, shortest form only; anything else sets overrun. */
uint32_t adcgs_read_varint(adcgs_reader *r);
/** Pointer to the next n bytes, or NULL (and overrun). */
const uint8_t *adcgs_read_bytes(adcgs_reader *r, size_t n);
static inline size_t adcgs_reader_left(const adcgs_reader *r)
{
    return r->size - r->pos;
}

typedef struct adcgs_buffer {
    uint8_t *data;
    size_t size, capacity;
    int failed; /**< set once memory ran out */
} adcgs_buffer;

void adcgs_buffer_init(adcgs_buffer *b);
void adcgs_buffer_clear(adcgs_buffer *b); /**< frees */
void adcgs_write_uint(adcgs_buffer *b, uint64_t value, int bytes);
void adcgs_write_varint(adcgs_buffer *b, uint32_t value);
void adcgs_write_bytes(adcgs_buffer *b, const void *data, size_t n);

#endif

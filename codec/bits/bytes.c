/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Byte-aligned fields: reading within bounds and writing with growth. */
#include "bits/bytes.h"

#include <stdlib.h>

void adcgs_reader_init(adcgs_reader *r, const void *data, size_t size)
{
    static const uint8_t nothing; /* a valid address if there are no bytes */
    *r = (adcgs_reader){.data = size ? data : &nothing, .size = size};
}

const uint8_t *adcgs_read_bytes(adcgs_reader *r, size_t n)
{
    if (r->overrun || n > r->size - r->pos) {
        r->overrun = 1;
        return NULL;
    }
    const uint8_t *p = r->data + r->pos;
    r->pos += n;
    return p;
}

uint64_t adcgs_read_uint(adcgs_reader *r, int bytes)
{
    const uint8_t *p = adcgs_read_bytes(r, (size_t)bytes);
    uint64_t value = 0;
    for (int i = 0; p && i < bytes; i++)
        value |= (uint64_t)p[i] << 8 * i;
    return value;
}

uint32_t adcgs_read_varint(adcgs_reader *r)
{
    uint64_t value = 0;
    for (int i = 0; i < 5; i++) {
        const uint8_t *p = adcgs_read_bytes(r, 1);
        if (!p)
            return 0;
        value |= (uint64_t)(*p & 127) << 7 * i;
        if (*p < 128) {
            if (value > UINT32_MAX || (*p == 0 && i > 0))
                break;
            return (uint32_t)value;
        }
    }
    r->overrun = 1;
    return 0;
}

void adcgs_buffer_init(adcgs_buffer *b)
{
    *b = (adcgs_buffer){0};
}

void adcgs_buffer_clear(adcgs_buffer *b)
{
    free(b->data);
    adcgs_buffer_init(b);
}

/* Make room for n more bytes, or set the failure flag. */
static int reserve(adcgs_buffer *b, size_t n)
{
    if (b->failed)
        return 0;
    if (n <= b->capacity - b->size)
        return 1;
    const size_t least = b->size + n, doubled = b->capacity < SIZE_MAX / 2 ? 2 * b->capacity : SIZE_MAX;
    const size_t capacity = ADCGS_MAX(ADCGS_MAX(least, doubled), 256);
    uint8_t *data = n > SIZE_MAX - b->size ? NULL : realloc(b->data, capacity);
    if (!data) {
        b->failed = 1;
        return 0;
    }
    b->data = data;
    b->capacity = capacity;
    return 1;
}

void adcgs_write_bytes(adcgs_buffer *b, const void *data, size_t n)
{
    if (n == 0 || !reserve(b, n))
        return;
    memcpy(b->data + b->size, data, n);
    b->size += n;
}

void adcgs_write_uint(adcgs_buffer *b, uint64_t value, int bytes)
{
    uint8_t little[8];
    adcgs_store_le64(little, value);
    adcgs_write_bytes(b, little, (size_t)bytes);
}

void adcgs_write_varint(adcgs_buffer *b, uint32_t value)
{
    uint8_t group[5];
    size_t n = 0;
    for (; value >= 128; value >>= 7)
        group[n++] = (uint8_t)(value | 128);
    group[n++] = (uint8_t)value;
    adcgs_write_bytes(b, group, n);
}

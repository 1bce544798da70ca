/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Little-endian numbers of a record, in turn. A cursor that reads beyond its end gives zeros and remembers it. */
#ifndef ADCGS_MEDIA_DYNAMIC_BYTE_CURSOR_H
#define ADCGS_MEDIA_DYNAMIC_BYTE_CURSOR_H

#include "base/base.h"

typedef struct adcgs_byte_cursor {
    const uint8_t *at, *end;
    int failed; /**< true after a read beyond the end */
} adcgs_byte_cursor;

/** The next n bytes; NULL if fewer follow. */
static inline const uint8_t *adcgs_cursor_bytes(adcgs_byte_cursor *c, uint64_t n)
{
    const uint8_t *const at = c->at;
    if (c->failed || n > (uint64_t)(c->end - at)) {
        c->failed = 1;
        return NULL;
    }
    c->at = at + n;
    return at;
}

static inline uint8_t adcgs_cursor_u8(adcgs_byte_cursor *c)
{
    const uint8_t *const p = adcgs_cursor_bytes(c, 1);
    return p ? *p : 0;
}

static inline uint16_t adcgs_cursor_u16(adcgs_byte_cursor *c)
{
    const uint8_t *const p = adcgs_cursor_bytes(c, 2);
    return p ? adcgs_load_le16(p) : 0;
}

static inline uint32_t adcgs_cursor_u32(adcgs_byte_cursor *c)
{
    const uint8_t *const p = adcgs_cursor_bytes(c, 4);
    return p ? adcgs_load_le32(p) : 0;
}

static inline uint64_t adcgs_cursor_u64(adcgs_byte_cursor *c)
{
    const uint8_t *const p = adcgs_cursor_bytes(c, 8);
    return p ? adcgs_load_le64(p) : 0;
}

static inline double adcgs_cursor_f64(adcgs_byte_cursor *c)
{
    return adcgs_bits_double(adcgs_cursor_u64(c));
}

/** A cursor over the next n bytes; empty and failed if fewer follow. */
static inline adcgs_byte_cursor adcgs_cursor_part(adcgs_byte_cursor *c, uint64_t n)
{
    const uint8_t *const p = adcgs_cursor_bytes(c, n);
    return p ? (adcgs_byte_cursor){p, p + n, 0} : (adcgs_byte_cursor){c->at, c->at, 1};
}

#endif

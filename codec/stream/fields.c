/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The drivers of the field lists: parsing with trace, and writing. */
#include "stream/fields.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>

/** Value of a field: its bits as in the stream, and its number for checks and messages. */
typedef struct field_value {
    uint64_t bits;
    double number;
} field_value;

static int type_bytes(int type)
{
    static const uint8_t bytes[] = {1, 2, 4, 8, 2, 8, 4, 8};
    return bytes[type];
}

static double number_of(int type, uint64_t bits)
{
    switch (type) {
    case ADCGS_I16:
        return (double)(int16_t)(uint16_t)bits;
    case ADCGS_I64:
        return (double)(int64_t)bits;
    case ADCGS_F32:
        return (double)adcgs_bits_float((uint32_t)bits);
    case ADCGS_F64:
        return adcgs_bits_double(bits);
    default:
        return (double)bits;
    }
}

/** Load a field's bits from its member; store_member() does the reverse. */
static uint64_t load_member(const void *member, int bytes)
{
    uint8_t u8;
    uint16_t u16;
    uint32_t u32;
    uint64_t u64;
    switch (bytes) {
    case 1:
        memcpy(&u8, member, 1);
        return u8;
    case 2:
        memcpy(&u16, member, 2);
        return u16;
    case 4:
        memcpy(&u32, member, 4);
        return u32;
    default:
        memcpy(&u64, member, 8);
        return u64;
    }
}

static void store_member(void *member, int bytes, uint64_t bits)
{
    const uint8_t u8 = (uint8_t)bits;
    const uint16_t u16 = (uint16_t)bits;
    const uint32_t u32 = (uint32_t)bits;
    const void *from = bytes == 1 ? (const void *)&u8 : bytes == 2 ? (const void *)&u16 : bytes == 4 ? (const void *)&u32 : &bits;
    memcpy(member, from, (size_t)bytes);
}

/** Format the value: integers exactly, a binary32 with 9 and a binary64 with 17 digits, which identify it exactly. */
static void format_value(char *text, size_t size, int type, field_value v)
{
    if (type == ADCGS_F32 || type == ADCGS_F64)
        snprintf(text, size, "%.*g", type == ADCGS_F32 ? 9 : 17, v.number);
    else if (type == ADCGS_I16 || type == ADCGS_I64)
        snprintf(text, size, "%" PRId64, type == ADCGS_I16 ? (int16_t)(uint16_t)v.bits : (int64_t)v.bits);
    else
        snprintf(text, size, "%" PRIu64, v.bits);
}

static adcgs_status check_value(const char *chunk, const adcgs_field *f, field_value v, adcgs_status status, adcgs_error *error)
{
    char text[32];
    if (v.number >= f->min && v.number <= f->max) /* false for NaN */
        return ADCGS_OK;
    format_value(text, sizeof text, f->type, v);
    return adcgs_fail(error, status, "%s: %s is %s, expected %.10g..%.10g", chunk, f->name, text, f->min, f->max);
}

void adcgs_parse_trace(const adcgs_parse *p, uint64_t bit, const char *name, const char *format, ...)
{
    char element[64], text[128];
    if (!p->trace)
        return;
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    snprintf(element, sizeof element, "%s.%s", p->chunk, name);
    p->trace(p->trace_user, 8 * p->origin + bit, element, text);
}

void adcgs_parse_trace_end(const adcgs_parse *p, const adcgs_range_dec *d)
{
    adcgs_parse_trace(p, 8 * (uint64_t)(d->next - p->r.data), "range_end",
                      "range 0x%016" PRIx64 " value 0x%016" PRIx64 " virtual %d", d->range, d->value, d->zeros);
}

/** Trace an element of a list; elements of an array have an index. */
static void trace_field(const adcgs_parse *p, uint64_t bit, const adcgs_field *f, int i, field_value v)
{
    char name[40], text[32];
    if (!p->trace)
        return;
    if (f->count > 1)
        snprintf(name, sizeof name, "%s[%d]", f->name, i);
    else
        snprintf(name, sizeof name, "%s", f->name);
    format_value(text, sizeof text, f->type, v);
    adcgs_parse_trace(p, bit, name, "%s", text);
}

static adcgs_status cut_off(const adcgs_parse *p, const char *name)
{
    return adcgs_fail(p->error, ADCGS_ERR_DATA, "%s: payload of %zu bytes ends inside %s", p->chunk, p->r.size, name);
}

adcgs_status adcgs_parse_fields(adcgs_parse *p, const adcgs_field *fields, size_t n, void *structure)
{
    for (const adcgs_field *f = fields; f < fields + n; f++) {
        const int bytes = type_bytes(f->type);
        for (int i = 0; i < f->count; i++) {
            const uint64_t bit = 8 * (uint64_t)p->r.pos;
            field_value v;
            v.bits = adcgs_read_uint(&p->r, bytes);
            if (p->r.overrun)
                return cut_off(p, f->name);
            v.number = number_of(f->type, v.bits);
            trace_field(p, bit, f, i, v);
            ADCGS_TRY(check_value(p->chunk, f, v, ADCGS_ERR_DATA, p->error));
            store_member((uint8_t *)structure + f->offset + i * bytes, bytes, v.bits);
        }
    }
    return ADCGS_OK;
}

adcgs_status adcgs_write_fields(adcgs_buffer *out, const char *chunk, const adcgs_field *fields, size_t n, const void *structure,
                                adcgs_error *error)
{
    for (const adcgs_field *f = fields; f < fields + n; f++) {
        const int bytes = type_bytes(f->type);
        for (int i = 0; i < f->count; i++) {
            field_value v;
            v.bits = load_member((const uint8_t *)structure + f->offset + i * bytes, bytes);
            v.number = number_of(f->type, v.bits);
            ADCGS_TRY(check_value(chunk, f, v, ADCGS_ERR_USAGE, error));
            adcgs_write_uint(out, v.bits, bytes);
        }
    }
    return ADCGS_OK;
}

static adcgs_status check_varint(const adcgs_parse *p, const char *name, uint32_t min, uint32_t max, uint32_t value)
{
    if (p->r.overrun)
        return cut_off(p, name);
    if (value < min || value > max)
        return adcgs_fail(p->error, ADCGS_ERR_DATA, "%s: %s is %u, expected %u..%u", p->chunk, name, value, min, max);
    return ADCGS_OK;
}

adcgs_status adcgs_parse_varint(adcgs_parse *p, const char *name, uint32_t min, uint32_t max, uint32_t *value)
{
    const uint64_t bit = 8 * (uint64_t)p->r.pos;
    *value = adcgs_read_varint(&p->r);
    if (!p->r.overrun)
        adcgs_parse_trace(p, bit, name, "%u", *value);
    return check_varint(p, name, min, max, *value);
}

adcgs_status adcgs_parse_bytes(adcgs_parse *p, const char *name, size_t n, const uint8_t **bytes)
{
    const uint64_t bit = 8 * (uint64_t)p->r.pos;
    *bytes = adcgs_read_bytes(&p->r, n);
    if (p->r.overrun)
        return cut_off(p, name);
    adcgs_parse_trace(p, bit, name, "%zu bytes", n);
    return ADCGS_OK;
}

/** Trace text from a stream in quotes, with other than printable ASCII characters in hexadecimal. */
static adcgs_status trace_text(const adcgs_parse *p, uint64_t bit, const char *name, const uint8_t *bytes, size_t n)
{
    char element[64];
    if (!p->trace)
        return ADCGS_OK;
    char *text = adcgs_alloc(NULL, 4 * n + 3, 1, p->error), *end = text;
    if (!text)
        return adcgs_alloc_status(p->error);
    *end++ = '"';
    for (size_t i = 0; i < n; i++)
        if (bytes[i] < 32 || bytes[i] > 126 || bytes[i] == '"' || bytes[i] == '\\')
            end += snprintf(end, 5, "\\x%02x", bytes[i]);
        else
            *end++ = (char)bytes[i];
    *end++ = '"';
    *end = 0;
    snprintf(element, sizeof element, "%s.%s", p->chunk, name);
    p->trace(p->trace_user, 8 * p->origin + bit, element, text);
    adcgs_free(NULL, text);
    return ADCGS_OK;
}

adcgs_status adcgs_parse_text(adcgs_parse *p, const char *name, uint32_t min, uint32_t max, adcgs_memory *memory, char **text)
{
    const uint64_t bit = 8 * (uint64_t)p->r.pos;
    const uint8_t *bytes;
    const uint32_t length = adcgs_read_varint(&p->r);
    ADCGS_TRY(check_varint(p, name, min, max, length));
    bytes = adcgs_read_bytes(&p->r, length);
    if (!bytes)
        return cut_off(p, name);
    ADCGS_TRY(trace_text(p, bit, name, bytes, length));
    if (length > 0 && memchr(bytes, 0, length))
        return adcgs_fail(p->error, ADCGS_ERR_DATA, "%s: %s holds a zero byte", p->chunk, name);
    *text = adcgs_alloc(memory, (size_t)length + 1, 1, p->error);
    if (!*text)
        return adcgs_alloc_status(p->error);
    if (length > 0)
        memcpy(*text, bytes, length);
    return ADCGS_OK;
}

adcgs_status adcgs_parse_end(const adcgs_parse *p)
{
    const size_t left = adcgs_reader_left(&p->r);
    if (left > 0)
        return adcgs_fail(p->error, ADCGS_ERR_DATA, "%s: %zu bytes are left over after the last element", p->chunk, left);
    return ADCGS_OK;
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Syntax elements by name: found by a trace of the stream, replaced by their bytes. */
#include "edit.h"

#include "stream/input.h"
#include "stream/stream.h"
#include "stream/syntax.h"

#include <stdio.h>
#include <stdlib.h>

#define ONE(type, name, min, max) {#name, ADCGS_##type},
#define MANY(type, name, count, min, max) {#name, ADCGS_##type},

typedef struct element_type {
    const char *name;
    int type;
} element_type;

static const element_type types[] = {
    /* qualified by the chunk where the plain name would match another element */
    {"NETW.first_id", ADCGS_ELEMENT_VAR},
    {"NETW.networks", ADCGS_ELEMENT_VAR},
    {"NETW.width", ADCGS_ELEMENT_VAR},
    {"NETW.values", ADCGS_ELEMENT_BYTES},
    {"SEGM.network_id", ADCGS_ELEMENT_VAR},
    {"GEOM.positions", ADCGS_ELEMENT_BYTES},
    {"KEEP.modes", ADCGS_ELEMENT_BYTES},
    {"hash.md5", ADCGS_ELEMENT_BYTES},
    {"cams.cameras", ADCGS_ELEMENT_VAR},
    {"cams.name", ADCGS_ELEMENT_TEXT},
    {"meta.entries", ADCGS_ELEMENT_VAR},
    {"meta.key", ADCGS_ELEMENT_TEXT},
    {"meta.value", ADCGS_ELEMENT_TEXT},
    {"INDX.segments", ADCGS_ELEMENT_VAR},
    {"first_slice", ADCGS_ELEMENT_VAR},
    {"slices", ADCGS_ELEMENT_VAR},
    {"slice_bytes", ADCGS_ELEMENT_VAR},
    ADCGS_LIST_VERSION(ONE, MANY) ADCGS_LIST_HEAD(ONE, MANY) ADCGS_LIST_NET(ONE, MANY) ADCGS_LIST_NET_E24(ONE, MANY)
        ADCGS_LIST_NET_PRIOR(ONE, MANY) ADCGS_LIST_LAYER(ONE, MANY) ADCGS_LIST_LAYER_BIAS(ONE, MANY)
            ADCGS_LIST_LAYER_E24(ONE, MANY) ADCGS_LIST_SEGM(ONE, MANY) ADCGS_LIST_TIERS(ONE, MANY) ADCGS_LIST_GROWTH(ONE, MANY)
                ADCGS_LIST_STEP_FORM(ONE, MANY) ADCGS_LIST_STEP(ONE, MANY) ADCGS_LIST_STEP_SHORT(ONE, MANY)
                    ADCGS_LIST_ETA(ONE, MANY) ADCGS_LIST_GEOM(ONE, MANY) ADCGS_LIST_GRID(ONE, MANY)
                        ADCGS_LIST_SLICE_CRC(ONE, MANY) ADCGS_LIST_CAMERA(ONE, MANY) ADCGS_LIST_LENS(ONE, MANY)
                            ADCGS_LIST_POSE(ONE, MANY) ADCGS_LIST_POSE_SHORT(ONE, MANY) ADCGS_LIST_CAMERA_TIME(ONE, MANY)
                                ADCGS_LIST_INDEX(ONE, MANY) ADCGS_LIST_ENDC(ONE, MANY)};

/** Search for the n-th element of a name. */
typedef struct search {
    const char *name;
    size_t length;
    int left, found;
    uint64_t bit;
    char value[192];
} search;

static void on_element(void *user, uint64_t bit, const char *element, const char *value)
{
    search *const s = user;
    if (s->found || strlen(element) != s->length || strncmp(element, s->name, s->length) || s->left-- > 0)
        return;
    s->found = 1;
    s->bit = bit;
    snprintf(s->value, sizeof s->value, "%s", value);
}

static int type_of(const char *name, size_t length)
{
    const char *const dot = memchr(name, '.', length);
    const size_t skip = dot ? (size_t)(dot + 1 - name) : 0;
    const char *const bracket = memchr(name, '[', length);
    const size_t end = bracket ? (size_t)(bracket - name) : length;
    for (size_t i = 0; i < ADCGS_COUNTOF(types); i++) {
        const size_t begin = strchr(types[i].name, '.') ? 0 : skip;
        if (strlen(types[i].name) == end - begin && strncmp(types[i].name, name + begin, end - begin) == 0)
            return types[i].type;
    }
    return -1;
}

static adcgs_status measure(const adcgs_chunk_list *list, adcgs_element *e, adcgs_error *error)
{
    static const uint8_t bytes[] = {1, 2, 4, 8, 2, 8, 4, 8};
    const adcgs_buffer *const payload = &list->chunk[e->chunk].payload;
    adcgs_reader r;
    adcgs_reader_init(&r, payload->data, payload->size);
    r.pos = e->offset;
    if (e->type == ADCGS_ELEMENT_BYTES) {
        e->bytes = payload->size - e->offset; /* always the last element of its chunk */
    } else if (e->type >= ADCGS_ELEMENT_VAR) {
        const uint32_t value = adcgs_read_varint(&r);
        e->bytes = r.pos - e->offset + (e->type == ADCGS_ELEMENT_TEXT ? value : 0);
    } else {
        e->bytes = bytes[e->type];
    }
    return e->offset + e->bytes <= payload->size
               ? ADCGS_OK
               : adcgs_fail(error, ADCGS_ERR_INTERNAL, "an element of %zu bytes does not fit its chunk", e->bytes);
}

adcgs_status adcgs_element_find(adcgs_chunk_list *list, const char *name, adcgs_element *out, adcgs_error *error)
{
    const adcgs_read_options options = {.cpu = ADCGS_CPU_SCALAR};
    const char *const number = strchr(name, '#');
    search s = {.name = name, .length = number ? (size_t)(number - name) : strlen(name), .left = number ? atoi(number + 1) : 0};
    adcgs_stream stream;
    adcgs_buffer bytes;
    adcgs_buffer_init(&bytes);
    const adcgs_status status = adcgs_chunk_list_write(list, &bytes, error);
    adcgs_span source = {.next = bytes.data, .left = bytes.size};
    /* The stream need not be valid: an element found before the first fault counts. */
    if (status == ADCGS_OK && adcgs_stream_read(&stream, adcgs_span_read, &source, &options, on_element, &s, NULL) == ADCGS_OK)
        adcgs_stream_clear(&stream, NULL);
    adcgs_buffer_clear(&bytes);
    ADCGS_TRY(status);
    *out = (adcgs_element){.type = type_of(name, s.length)};
    if (!s.found || out->type < 0)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "the stream has no element %s", name);
    while (out->chunk + 1 < list->n && list->chunk[out->chunk + 1].at <= s.bit / 8)
        out->chunk++;
    out->offset = s.bit / 8 - list->chunk[out->chunk].at - 16;
    memcpy(out->value, s.value, sizeof out->value);
    return measure(list, out, error);
}

adcgs_status adcgs_element_replace(adcgs_chunk_list *list, const adcgs_element *element, const adcgs_buffer *bytes,
                                   adcgs_error *error)
{
    adcgs_raw_chunk *const chunk = &list->chunk[element->chunk];
    adcgs_buffer made;
    adcgs_buffer_init(&made);
    adcgs_write_bytes(&made, chunk->payload.data, element->offset);
    adcgs_write_bytes(&made, bytes->data, bytes->size);
    const size_t behind = element->offset + element->bytes;
    if (behind < chunk->payload.size)
        adcgs_write_bytes(&made, chunk->payload.data + behind, chunk->payload.size - behind);
    adcgs_buffer_clear(&chunk->payload);
    chunk->payload = made;
    chunk->as_is = 1;
    return made.failed ? adcgs_fail(error, ADCGS_ERR_MEMORY, "no memory for a payload") : ADCGS_OK;
}

adcgs_status adcgs_hex_decode(const char *hex, adcgs_buffer *out, adcgs_error *error)
{
    for (; *hex; hex += 2) {
        unsigned byte;
        if (!hex[1] || sscanf(hex, "%2x", &byte) != 1)
            return adcgs_fail(error, ADCGS_ERR_USAGE, "\"%s\": expected pairs of hexadecimal digits", hex);
        adcgs_write_uint(out, byte, 1);
    }
    return ADCGS_OK;
}

adcgs_status adcgs_element_encode(const adcgs_element *element, const char *word, adcgs_buffer *out, adcgs_error *error)
{
    int64_t whole;
    double real;
    if (strncmp(word, "raw:", 4) == 0)
        return adcgs_hex_decode(word + 4, out, error);
    switch (element->type) {
    case ADCGS_ELEMENT_TEXT:
        adcgs_write_varint(out, (uint32_t)strlen(word));
        adcgs_write_bytes(out, word, strlen(word));
        return ADCGS_OK;
    case ADCGS_ELEMENT_BYTES:
        return adcgs_fail(error, ADCGS_ERR_USAGE, "\"%s\": expected raw:HEX", word);
    case ADCGS_F32:
        ADCGS_TRY(adcgs_word_real(word, &real, error));
        adcgs_write_uint(out, adcgs_float_bits((float)real), 4);
        return ADCGS_OK;
    case ADCGS_F64:
        ADCGS_TRY(adcgs_word_real(word, &real, error));
        adcgs_write_uint(out, adcgs_double_bits(real), 8);
        return ADCGS_OK;
    default:
        ADCGS_TRY(adcgs_word_int(word + (*word == '+'), INT64_MIN, INT64_MAX, &whole, error));
        whole += *word == '+' ? strtoll(element->value, NULL, 10) : 0;
        if (element->type == ADCGS_ELEMENT_VAR)
            adcgs_write_varint(out, (uint32_t)whole);
        else
            adcgs_write_uint(out, (uint64_t)whole, (int)element->bytes);
        return ADCGS_OK;
    }
}

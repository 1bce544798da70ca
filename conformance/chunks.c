/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Streams as lists of chunks (spec clause "Stream"), independent of the reader and the writer of the codec. */
#include "chunks.h"

#include "base/digest.h"

#include <stdio.h>
#include <stdlib.h>

enum { SIGNATURE = 8, HEADER = 12, CRC = 4, TIMES = 20 };

void adcgs_chunk_list_clear(adcgs_chunk_list *list)
{
    while (list->n > 0)
        adcgs_buffer_clear(&list->chunk[--list->n].payload);
}

static int is_type(const adcgs_raw_chunk *chunk, const char *type)
{
    return strcmp(chunk->type, type) == 0;
}

adcgs_status adcgs_chunk_list_find(const adcgs_chunk_list *list, const char *name, int *index, adcgs_error *error)
{
    int wanted = strlen(name) > 5 && name[4] == '#' ? atoi(name + 5) : 0;
    for (*index = 0; *index < list->n; ++*index)
        if (strncmp(list->chunk[*index].type, name, 4) == 0 && wanted-- == 0)
            return ADCGS_OK;
    return adcgs_fail(error, ADCGS_ERR_USAGE, "the stream has no chunk %s", name);
}

adcgs_status adcgs_chunk_list_insert(adcgs_chunk_list *list, int at, const char *type, adcgs_error *error)
{
    if (list->n == ADCGS_CHUNK_LIST_MAX)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "more than %d chunks", ADCGS_CHUNK_LIST_MAX);
    memmove(&list->chunk[at + 1], &list->chunk[at], (size_t)(list->n++ - at) * sizeof list->chunk[0]);
    memset(&list->chunk[at], 0, sizeof list->chunk[at]);
    snprintf(list->chunk[at].type, sizeof list->chunk[at].type, "%.4s", type);
    return ADCGS_OK;
}

void adcgs_chunk_list_remove(adcgs_chunk_list *list, int at)
{
    adcgs_buffer_clear(&list->chunk[at].payload);
    memmove(&list->chunk[at], &list->chunk[at + 1], (size_t)(--list->n - at) * sizeof list->chunk[0]);
}

/* Computes the positions of all chunks. The length of the index must be known; it depends on the number of segments only. */
static void place(adcgs_chunk_list *list)
{
    size_t at = SIGNATURE;
    for (int i = 0; i < list->n; i++) {
        list->chunk[i].at = at;
        at += ADCGS_CHUNK_FRAME + list->chunk[i].payload.size;
    }
}

/* True if a NETW between the SEGM at this index and its GEOM holds the network of this id. */
static int is_sent(const adcgs_chunk_list *list, int segm, uint32_t id)
{
    for (int i = segm + 1; i < list->n && !is_type(&list->chunk[i], "GEOM") && !is_type(&list->chunk[i], "SEGM"); i++) {
        adcgs_reader r;
        if (!is_type(&list->chunk[i], "NETW"))
            continue;
        adcgs_reader_init(&r, list->chunk[i].payload.data, list->chunk[i].payload.size);
        const uint32_t first = adcgs_read_varint(&r), n = adcgs_read_varint(&r);
        if (id >= first && id - first < n)
            return 1;
    }
    return 0;
}

/* True if the segment is a key: not predicted, and all networks that it names are sent in it. */
static int is_key(const adcgs_chunk_list *list, int segm)
{
    const adcgs_buffer *const payload = &list->chunk[segm].payload;
    adcgs_reader r;
    adcgs_reader_init(&r, payload->data, payload->size);
    (void)adcgs_read_bytes(&r, TIMES);
    int key = adcgs_read_uint(&r, 1) == 0;
    for (uint64_t roles = adcgs_read_uint(&r, 2); roles && key && !r.overrun; roles >>= 1)
        key = !(roles & 1) || is_sent(list, segm, adcgs_read_varint(&r));
    return key;
}

/* The times of a segment; bytes that its SEGM lacks are zero. */
static void write_times(adcgs_buffer *out, const adcgs_buffer *segm)
{
    const size_t there = ADCGS_MIN(segm->size, TIMES);
    adcgs_write_bytes(out, segm->data, there);
    for (size_t i = there; i < TIMES; i++)
        adcgs_write_uint(out, 0, 1);
}

/* The payload of INDX: the times of each segment are the first elements of its SEGM. */
static void complete_index(adcgs_chunk_list *list, adcgs_raw_chunk *index)
{
    uint32_t segments = 0;
    for (int i = 0; i < list->n; i++)
        segments += is_type(&list->chunk[i], "SEGM");
    for (int pass = 0; pass < 2; pass++) {
        index->payload.size = 0;
        adcgs_write_varint(&index->payload, segments);
        for (int i = 0; i < list->n; i++) {
            int end = i + 1;
            if (!is_type(&list->chunk[i], "SEGM"))
                continue;
            while (end < list->n && !is_type(&list->chunk[end], "SEGM") && !is_type(&list->chunk[end], "INDX"))
                end++;
            const adcgs_raw_chunk *const last = &list->chunk[end - 1];
            write_times(&index->payload, &list->chunk[i].payload);
            adcgs_write_uint(&index->payload, list->chunk[i].at, 8);
            adcgs_write_uint(&index->payload, last->at + ADCGS_CHUNK_FRAME + last->payload.size - list->chunk[i].at, 8);
            adcgs_write_uint(&index->payload, (uint64_t)is_key(list, i), 1);
        }
        place(list);
    }
}

static uint32_t payload_crc(const adcgs_raw_chunk *c)
{
    return adcgs_crc32c(0, c->payload.data, c->payload.size) ^ c->payload_damage;
}

/* The end chunk's payload: bytes of the file, CRC over the payload CRCs of all chunks before it. */
static void complete_end(const adcgs_chunk_list *list, adcgs_raw_chunk *end)
{
    uint32_t crc = 0;
    for (const adcgs_raw_chunk *c = list->chunk; c < end; c++) {
        uint8_t bytes[CRC];
        adcgs_store_le32(bytes, payload_crc(c));
        crc = adcgs_crc32c(crc, bytes, sizeof bytes);
    }
    end->payload.size = 0;
    adcgs_write_uint(&end->payload, end->at + ADCGS_CHUNK_FRAME + 12, 8);
    adcgs_write_uint(&end->payload, crc, 4);
}

static void write_chunk(const adcgs_raw_chunk *c, adcgs_buffer *out)
{
    const size_t begin = out->size;
    adcgs_write_bytes(out, c->type, 4);
    adcgs_write_uint(out, c->has_length ? c->length : c->payload.size, 4);
    adcgs_write_uint(out, c->segment, 2);
    adcgs_write_uint(out, c->flags, 1);
    adcgs_write_uint(out, c->version, 1);
    adcgs_write_uint(out, adcgs_crc32c(0, out->data + begin, HEADER) ^ c->header_damage, CRC);
    adcgs_write_bytes(out, c->payload.data, c->payload.size);
    adcgs_write_uint(out, payload_crc(c), CRC);
}

adcgs_status adcgs_chunk_list_write(adcgs_chunk_list *list, adcgs_buffer *out, adcgs_error *error)
{
    place(list);
    for (int i = 0; i < list->n; i++)
        if (is_type(&list->chunk[i], "INDX") && !list->chunk[i].as_is)
            complete_index(list, &list->chunk[i]);
    for (int i = 0; i < list->n; i++)
        if (is_type(&list->chunk[i], "ENDC") && !list->chunk[i].as_is)
            complete_end(list, &list->chunk[i]);
    out->size = 0;
    adcgs_write_bytes(out,
                      "\x8B"
                      "ADC\r\n\x1A\n",
                      SIGNATURE);
    for (int i = 0; i < list->n; i++)
        write_chunk(&list->chunk[i], out);
    return out->failed ? adcgs_fail(error, ADCGS_ERR_MEMORY, "no memory for a stream") : ADCGS_OK;
}

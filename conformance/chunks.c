/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Streams as lists of chunks (spec clause "Stream"), independent of the reader and the writer of the codec. */
#include "chunks.h"

#include "base/digest.h"

#include <string.h>

enum { SIGNATURE = 8, HEADER = 12, CRC = 4 };

adcgs_status adcgs_chunk_list_read(adcgs_chunk_list *list, const uint8_t *data, size_t bytes, adcgs_error *error)
{
    list->n = 0;
    for (size_t at = SIGNATURE; at < bytes;) {
        const size_t length = bytes - at >= HEADER + 2 * CRC ? adcgs_load_le32(data + at + 4) : bytes;
        if (list->n == ADCGS_CHUNK_LIST_MAX || length > bytes - at - HEADER - 2 * CRC)
            return adcgs_fail(error, ADCGS_ERR_DATA, "chunk %d at byte %zu does not fit", list->n, at);
        adcgs_raw_chunk *const c = &list->chunk[list->n++];
        memcpy(c->header, data + at, HEADER);
        adcgs_buffer_init(&c->payload);
        adcgs_write_bytes(&c->payload, data + at + HEADER + CRC, length);
        at += HEADER + CRC + length + CRC;
    }
    return ADCGS_OK;
}

void adcgs_chunk_list_clear(adcgs_chunk_list *list)
{
    while (list->n > 0)
        adcgs_buffer_clear(&list->chunk[--list->n].payload);
}

int adcgs_chunk_list_find(const adcgs_chunk_list *list, const char *type)
{
    for (int i = 0; i < list->n; i++)
        if (!memcmp(list->chunk[i].header, type, 4))
            return i;
    return -1;
}

adcgs_status adcgs_chunk_list_insert(adcgs_chunk_list *list, int at, const char *type, const char *text, adcgs_error *error)
{
    if (list->n == ADCGS_CHUNK_LIST_MAX)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "more than %d chunks", ADCGS_CHUNK_LIST_MAX);
    memmove(&list->chunk[at + 1], &list->chunk[at], (size_t)(list->n++ - at) * sizeof list->chunk[0]);
    adcgs_raw_chunk *const c = &list->chunk[at];
    memset(c->header, 0, HEADER);
    memcpy(c->header, type, 4);
    adcgs_buffer_init(&c->payload);
    adcgs_write_bytes(&c->payload, text, strlen(text));
    return ADCGS_OK;
}

/* The end chunk's payload: bytes of the file, CRC over the payload CRCs of all chunks before it. */
static void complete_end(adcgs_chunk_list *list)
{
    const int end = adcgs_chunk_list_find(list, "ENDC");
    uint64_t total = SIGNATURE;
    uint32_t crc = 0;
    if (end < 0 || list->chunk[end].payload.size != 12)
        return;
    for (int i = 0; i <= end; i++) {
        uint8_t bytes[CRC];
        const adcgs_buffer *const payload = &list->chunk[i].payload;
        total += HEADER + CRC + payload->size + CRC;
        adcgs_store_le32(bytes, adcgs_crc32c(0, payload->data, payload->size));
        crc = i < end ? adcgs_crc32c(crc, bytes, sizeof bytes) : crc;
    }
    adcgs_store_le64(list->chunk[end].payload.data, total);
    adcgs_store_le32(list->chunk[end].payload.data + 8, crc);
}

void adcgs_chunk_list_write(adcgs_chunk_list *list, adcgs_buffer *out)
{
    complete_end(list);
    adcgs_write_bytes(out, "\x8B" "ADC\r\n\x1A\n", SIGNATURE);
    for (int i = 0; i < list->n; i++) {
        adcgs_raw_chunk *const c = &list->chunk[i];
        adcgs_store_le32(c->header + 4, (uint32_t)c->payload.size);
        adcgs_write_bytes(out, c->header, HEADER);
        adcgs_write_uint(out, adcgs_crc32c(0, c->header, HEADER), CRC);
        adcgs_write_bytes(out, c->payload.data, c->payload.size);
        adcgs_write_uint(out, adcgs_crc32c(0, c->payload.data, c->payload.size), CRC);
    }
}

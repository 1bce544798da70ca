/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Editing of streams that may be invalid. */
#include "stream_edit.h"

#include "base/digest.h"

int adcgs_next_chunk(const uint8_t *data, size_t size, size_t *pos, adcgs_found_chunk *found)
{
    if (*pos > size || size - *pos < ADCGS_CHUNK_HEADER_BYTES)
        return 0;
    const size_t left = size - *pos - ADCGS_CHUNK_HEADER_BYTES, length = adcgs_load_le32(data + *pos + 4);
    found->type = adcgs_load_le32(data + *pos);
    found->at = *pos;
    found->payload = *pos + ADCGS_CHUNK_HEADER_BYTES;
    found->length = ADCGS_MIN(length, left);
    found->complete = left >= 4 && length <= left - 4;
    *pos = found->payload + found->length + (found->complete ? 4 : 0);
    return 1;
}

/** Corrects the checksums in a table of slices, as far as the table and the slices are intact. */
static void repair_slices(uint8_t *payload, size_t length)
{
    adcgs_reader r, table;
    size_t total = 0;
    adcgs_reader_init(&r, payload, length);
    adcgs_read_varint(&r);
    const uint32_t n = adcgs_read_varint(&r);
    table = r;
    for (uint32_t i = 0; i < n && !r.overrun; i++, adcgs_read_uint(&r, 4))
        adcgs_read_varint(&r);
    for (uint32_t i = 0; i < n && !r.overrun; i++) {
        const uint32_t bytes = adcgs_read_varint(&table);
        if (bytes > length - r.pos - total)
            return;
        adcgs_store_le32(payload + table.pos, adcgs_crc32c(0, payload + r.pos + total, bytes));
        adcgs_read_uint(&table, 4);
        total += bytes;
    }
}

void adcgs_repair_stream(uint8_t *data, size_t size, int drop_hash)
{
    adcgs_found_chunk c;
    uint32_t crcs = 0;
    for (size_t pos = ADCGS_SIGNATURE_BYTES; adcgs_next_chunk(data, size, &pos, &c);) {
        uint8_t *payload = data + c.payload;
        if (drop_hash && c.type == ADCGS_TYPE_hash)
            data[c.at] = 'n';
        if (c.type == ADCGS_TYPE_ENDC && c.length == 12) {
            adcgs_store_le64(payload, pos);
            adcgs_store_le32(payload + 8, crcs);
        }
        if (adcgs_type_layer(c.type) >= 0)
            repair_slices(payload, c.length);
        adcgs_store_le32(data + c.at + 12, adcgs_crc32c(0, data + c.at, 12));
        if (!c.complete)
            return;
        adcgs_store_le32(payload + c.length, adcgs_crc32c(0, payload, c.length));
        crcs = adcgs_crc32c(crcs, payload + c.length, 4);
    }
}

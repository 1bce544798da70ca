/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Another HEAD for a complete stream. Everything else stays in place, except the checksum over all chunks. */
#include "encode/settle.h"

#include "base/digest.h"
#include "stream/chunk.h"

typedef struct copier {
    FILE *to, *from;
    const uint8_t *head;
    size_t head_bytes;
    uint32_t crc_of_crcs;
    uint64_t at;
    const char *path;
    adcgs_error *error;
    adcgs_buffer chunk; /* the current chunk */
} copier;

static adcgs_status fetch(copier *c, size_t bytes)
{
    uint8_t piece[4096];
    while (bytes > 0) {
        const size_t n = ADCGS_MIN(bytes, sizeof piece);
        if (fread(piece, 1, n, c->from) != n)
            return adcgs_fail(c->error, ADCGS_ERR_DATA, "%s: the file ends before byte %llu", c->path,
                              (unsigned long long)(c->at + bytes));
        adcgs_write_bytes(&c->chunk, piece, n);
        bytes -= n;
        c->at += n;
    }
    return c->chunk.failed ? adcgs_fail(c->error, ADCGS_ERR_MEMORY, "%s: out of memory", c->path) : ADCGS_OK;
}

/** Changes a chunk: HEAD's payload, the checksum over all chunks in ENDC, and the chunk's own checksum. */
static adcgs_status change(copier *c, uint32_t type, size_t length)
{
    uint8_t *payload = c->chunk.data + ADCGS_CHUNK_HEADER_BYTES;
    if (type == ADCGS_TYPE_HEAD && length != c->head_bytes)
        return adcgs_fail(c->error, ADCGS_ERR_DATA, "%s: HEAD has %zu bytes, expected %zu", c->path, length, c->head_bytes);
    if (type == ADCGS_TYPE_HEAD)
        memcpy(payload, c->head, length);
    if (type == ADCGS_TYPE_ENDC && length >= 12)
        adcgs_store_le32(payload + 8, c->crc_of_crcs);
    adcgs_store_le32(payload + length, adcgs_crc32c(0, payload, length));
    c->crc_of_crcs = adcgs_crc32c(c->crc_of_crcs, payload + length, 4);
    return ADCGS_OK;
}

static adcgs_status write_on(copier *c)
{
    const int fine = fwrite(c->chunk.data, 1, c->chunk.size, c->to) == c->chunk.size;
    c->chunk.size = 0;
    return fine ? ADCGS_OK : adcgs_fail(c->error, ADCGS_ERR_IO, "%s: cannot write", c->path);
}

static adcgs_status copy(copier *c)
{
    adcgs_chunk chunk;
    ADCGS_TRY(fetch(c, ADCGS_SIGNATURE_BYTES));
    do {
        ADCGS_TRY(write_on(c));
        const uint64_t origin = c->at;
        ADCGS_TRY(fetch(c, ADCGS_CHUNK_HEADER_BYTES));
        ADCGS_TRY(adcgs_chunk_header(c->chunk.data, origin, &chunk, c->error));
        ADCGS_TRY(fetch(c, chunk.header.length + 4));
        ADCGS_TRY(change(c, chunk.type, chunk.header.length));
    } while (chunk.type != ADCGS_TYPE_ENDC);
    return write_on(c);
}

adcgs_status adcgs_encode_replace_head(FILE *to, FILE *from, const uint8_t *head, size_t bytes, const char *path,
                                       adcgs_error *error)
{
    copier c = {.to = to, .from = from, .head = head, .head_bytes = bytes, .path = path, .error = error};
    adcgs_buffer_init(&c.chunk);
    const adcgs_status status = copy(&c);
    adcgs_buffer_clear(&c.chunk);
    return status;
}

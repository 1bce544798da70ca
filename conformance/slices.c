/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Splitting chunks FEA0 to FEA4 into slices, and assembling them again. */
#include "edit.h"

#include "base/digest.h"

#include <stdlib.h>

adcgs_status adcgs_slices_read(adcgs_slices *out, const adcgs_buffer *payload, adcgs_error *error)
{
    adcgs_reader r;
    adcgs_reader_init(&r, payload->data, payload->size);
    *out = (adcgs_slices){.first = adcgs_read_varint(&r), .n = 0};
    const uint32_t n = adcgs_read_varint(&r);
    uint32_t *const bytes = calloc((size_t)n + 1, sizeof *bytes);
    out->data = calloc((size_t)n + 1, sizeof *out->data);
    out->damage = calloc((size_t)n + 1, sizeof *out->damage);
    for (uint32_t i = 0; bytes && i < n; i++) {
        bytes[i] = adcgs_read_varint(&r);
        adcgs_read_uint(&r, 4);
    }
    for (; bytes && out->data && out->damage && out->n < n; out->n++)
        adcgs_write_bytes(&out->data[out->n], adcgs_read_bytes(&r, bytes[out->n]), bytes[out->n]);
    free(bytes);
    return r.overrun || out->n < n ? adcgs_fail(error, ADCGS_ERR_USAGE, "the chunk holds no slices") : ADCGS_OK;
}

void adcgs_slices_write(const adcgs_slices *slices, uint32_t begin, uint32_t end, adcgs_buffer *payload)
{
    payload->size = 0;
    adcgs_write_varint(payload, slices->first + begin);
    adcgs_write_varint(payload, end - begin);
    for (uint32_t i = begin; i < end; i++) {
        adcgs_write_varint(payload, (uint32_t)slices->data[i].size);
        adcgs_write_uint(payload, adcgs_crc32c(0, slices->data[i].data, slices->data[i].size) ^ slices->damage[i], 4);
    }
    for (uint32_t i = begin; i < end; i++)
        adcgs_write_bytes(payload, slices->data[i].data, slices->data[i].size);
}

void adcgs_slices_clear(adcgs_slices *slices)
{
    for (uint32_t i = 0; slices->data && i < slices->n; i++)
        adcgs_buffer_clear(&slices->data[i]);
    free(slices->data);
    free(slices->damage);
    *slices = (adcgs_slices){.n = 0};
}

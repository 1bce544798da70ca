/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Allocation with a limit. Blocks come from calloc(), so that the pages of a
 * large block cost nothing until they are touched. A header before each block
 * stores the pointer from calloc() and the number of bytes counted.
 */
#include "base/base.h"

#include <inttypes.h>
#include <stdlib.h>

#define ALIGNMENT 64u

typedef struct block_header {
    void *base;
    uint64_t counted;
} block_header;

void *adcgs_alloc(adcgs_memory *memory, size_t count, size_t size, adcgs_error *error)
{
    const size_t overhead = ALIGNMENT + sizeof(block_header);
    if (size && count > (SIZE_MAX - overhead) / size) {
        adcgs_fail(error, memory && memory->limit ? ADCGS_ERR_LIMIT : ADCGS_ERR_MEMORY,
                   "allocation of %zu x %zu bytes exceeds the address space", count, size);
        return NULL;
    }
    const size_t bytes = count * size + overhead;
    if (memory && memory->limit && (bytes > memory->limit || memory->used > memory->limit - bytes)) {
        adcgs_fail(error, ADCGS_ERR_LIMIT, "allocation of %zu bytes exceeds the limit: %" PRIu64 " of %" PRIu64 " in use", bytes,
                   memory->used, memory->limit);
        return NULL;
    }
    uint8_t *base = calloc(bytes, 1);
    if (!base) {
        adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory: %zu bytes", bytes);
        return NULL;
    }
    const uintptr_t first = (uintptr_t)base + sizeof(block_header);
    uint8_t *user = base + sizeof(block_header) + (ALIGNMENT - first % ALIGNMENT) % ALIGNMENT;
    const block_header header = {base, bytes};
    memcpy(user - sizeof header, &header, sizeof header);
    if (memory) {
        memory->used += bytes;
        memory->peak = ADCGS_MAX(memory->peak, memory->used);
    }
    return user;
}

void adcgs_free(adcgs_memory *memory, void *pointer)
{
    if (!pointer)
        return;
    block_header header;
    memcpy(&header, (uint8_t *)pointer - sizeof header, sizeof header);
    if (memory)
        memory->used -= header.counted;
    free(header.base);
}

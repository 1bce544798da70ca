/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The mutator of targets that read streams. It changes payloads, the order of chunks and their headers. The checksums of the
 * result are correct, since a fuzzer does not find a CRC by chance.
 */
#include "fuzz.h"
#include "stream_edit.h"

#define CHUNKS_MAX 256

typedef struct chunk_list {
    int n;
    adcgs_found_chunk chunk[CHUNKS_MAX];
} chunk_list;

static void list_chunks(chunk_list *list, const uint8_t *data, size_t size)
{
    size_t pos = ADCGS_SIGNATURE_BYTES;
    list->n = 0;
    while (list->n < CHUNKS_MAX && adcgs_next_chunk(data, size, &pos, &list->chunk[list->n]))
        list->n++;
}

static uint32_t draw(uint32_t *state, uint32_t n)
{
    *state = *state * 1664525U + 1013904223U;
    return (uint32_t)((uint64_t)*state * n >> 32);
}

/** Replaces a range of bytes. Returns the new size, or the old one if there is no room. */
static size_t replace(uint8_t *data, size_t size, size_t max, size_t at, size_t old, const uint8_t *bytes, size_t n)
{
    if (n > old && n - old > max - size)
        return size;
    memmove(data + at + n, data + at + old, size - at - old);
    memcpy(data + at, bytes, n);
    return size - old + n;
}

static size_t chunk_end(const adcgs_found_chunk *c)
{
    return c->payload + c->length + (c->complete ? 4 : 0);
}

/** Mutates a payload. That of a layer keeps its size, so that its slices still fill it; others may change theirs. */
static size_t mutate_payload(uint8_t *data, size_t size, size_t max, const adcgs_found_chunk *c)
{
    const int layer = adcgs_type_layer(c->type) >= 0;
    const size_t room = layer ? c->length : c->length + 64;
    uint8_t *copy = calloc(room + 1, 1);
    if (!copy)
        return size;
    memcpy(copy, data + c->payload, c->length);
    size_t n = LLVMFuzzerMutate(copy, c->length, room + (room == 0));
    FUZZ_WRITTEN(&n, sizeof n);
    FUZZ_WRITTEN(copy, room + 1);
    if (layer && n < c->length) {
        memmove(copy + c->length - n, copy, n); /* the slices' bytes keep their place at the end */
        memcpy(copy, data + c->payload, c->length - n);
        n = c->length;
    }
    size = replace(data, size, max, c->payload, c->length, copy, n);
    if (c->complete)
        adcgs_store_le32(data + c->at + 4, (uint32_t)n);
    free(copy);
    return size;
}

static size_t mutate_order(uint8_t *data, size_t size, size_t max, const adcgs_found_chunk *a, const adcgs_found_chunk *b,
                           int kind)
{
    const size_t n = chunk_end(a) - a->at;
    if (kind == 0)
        return replace(data, size, max, a->at, n, data, 0);
    uint8_t *copy = malloc(n);
    if (!copy)
        return size;
    memcpy(copy, data + a->at, n);
    size = replace(data, size, max, b->at, 0, copy, n);
    free(copy);
    return size;
}

size_t adcgs_mutate_stream(uint8_t *data, size_t size, size_t max, unsigned int seed)
{
    uint32_t state = seed;
    chunk_list list;
    FUZZ_WRITTEN(&data, sizeof data);
    FUZZ_WRITTEN(&size, sizeof size);
    FUZZ_WRITTEN(&max, sizeof max);
    FUZZ_WRITTEN(&state, sizeof state);
    FUZZ_WRITTEN(data, max);
    list_chunks(&list, data, size);
    const uint32_t kind = draw(&state, 16);
    if (list.n == 0 || kind == 0)
        return LLVMFuzzerMutate(data, size, max);
    const adcgs_found_chunk *a = &list.chunk[draw(&state, (uint32_t)list.n)], *b = &list.chunk[draw(&state, (uint32_t)list.n)];
    if (kind <= 2)
        size = mutate_order(data, size, max, a, b, (int)kind - 1);
    else if (kind == 3)
        data[a->at + draw(&state, 12)] ^= (uint8_t)(1U << draw(&state, 8));
    else
        size = mutate_payload(data, size, max, a);
    adcgs_repair_stream(data, size, 0);
    return size;
}

/* For targets whose input is a stream and nothing else. */
__attribute__((weak)) size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max, unsigned int seed)
{
    return adcgs_mutate_stream(data, size, max, seed);
}

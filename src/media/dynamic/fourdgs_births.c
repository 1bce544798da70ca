/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Splats with lifetimes, from all chunks of a .4dgs file. */
#include "config.h"

#include "media/dynamic/fourdgs_births.h"

#include <stdio.h>
#include <stdlib.h>

/** The next chunk's splats are appended from `first` on. */
typedef struct births {
    const adcgs_fourdgs *f;
    adcgs_motion *motion;
    uint32_t *objects, first;
    adcgs_error *error;
} births;

static adcgs_status append_rows(births *b, const adcgs_fourdgs_chunk *chunk, const adcgs_fourdgs_columns *columns,
                                const uint8_t *harmonics)
{
    const adcgs_fourdgs_window interval = {chunk->begin, chunk->end};
    const size_t per = 3 * adcgs_fourdgs_coefficients(b->f->degree);
    int32_t row[ADCGS_FOURDGS_ROW];
    for (uint32_t i = 0; i < chunk->n; i++) {
        const uint32_t to = b->first + i;
        adcgs_fourdgs_row(row, columns, i);
        ADCGS_TRY(adcgs_fourdgs_set(b->motion, to, b->f, row, harmonics ? harmonics + i * per : NULL, &interval, b->error));
        if (b->objects)
            b->objects[to] = (uint32_t)row[ADCGS_FOURDGS_ROW_OBJECT];
    }
    b->first += chunk->n;
    return ADCGS_OK;
}

static adcgs_status read_chunk(births *b, uint32_t index)
{
    const adcgs_fourdgs *const f = b->f;
    const adcgs_fourdgs_chunk *const chunk = &f->chunks[index];
    adcgs_fourdgs_columns columns = {0};
    uint8_t *block, *harmonics = NULL;
    char where[32];
    snprintf(where, sizeof where, "chunk %u", index);
    ADCGS_TRY(adcgs_fourdgs_block(&block, chunk, f->path, where, b->error));
    adcgs_status status = adcgs_fourdgs_columns_read(&columns, (adcgs_byte_cursor){block, block + chunk->streams.unpacked, 0},
                                                     chunk->n, ADCGS_FOURDGS_ALL | (b->objects ? ADCGS_FOURDGS_HAS_OBJECT : 0),
                                                     ADCGS_FOURDGS_ALL, f->path, where, b->error);
    if (status == ADCGS_OK && f->degree) {
        harmonics = malloc(3 * adcgs_fourdgs_coefficients(f->degree) * chunk->n + !chunk->n);
        status = harmonics ? adcgs_fourdgs_bands_read(harmonics, chunk, f->degree, f->path, where, b->error)
                           : adcgs_fail(b->error, ADCGS_ERR_MEMORY, "%s: out of memory for %u splats", f->path, chunk->n);
    }
    if (status == ADCGS_OK)
        status = append_rows(b, chunk, &columns, harmonics);
    adcgs_fourdgs_columns_free(&columns);
    free(harmonics);
    free(block);
    return status;
}

adcgs_status adcgs_fourdgs_births(adcgs_motion *motion, uint32_t **objects, const adcgs_fourdgs *f, adcgs_error *error)
{
    uint64_t n = 0;
    for (uint32_t i = 0; i < f->n_chunks; i++)
        n += f->chunks[i].n;
    *objects = NULL;
    if (n != f->n)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .4dgs: %llu splats in its chunks, but %llu in its header", f->path,
                          (unsigned long long)n, (unsigned long long)f->n);
    ADCGS_TRY(adcgs_fourdgs_motion(motion, f, n, error));
    if (f->n_tracks && !(*objects = calloc(n + !n, sizeof **objects)))
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %llu splats", f->path, (unsigned long long)n);
    births b = {.f = f, .motion = motion, .objects = *objects, .error = error};
    for (uint32_t i = 0; i < f->n_chunks; i++)
        ADCGS_TRY(read_chunk(&b, i));
    return ADCGS_OK;
}

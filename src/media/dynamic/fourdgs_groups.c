/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Groups of splats in a .4dgs file with keyframes: streams of one chunk, sorted by the splats' ids. */
#include "config.h"

#include "media/dynamic/fourdgs_states.h"

#include <stdio.h>
#include <stdlib.h>

/** A splat of a group, and its place in the streams. */
typedef struct entry {
    uint32_t id, from;
} entry;

adcgs_status adcgs_fourdgs_state_alloc(adcgs_fourdgs_state **out, const adcgs_fourdgs *f, uint64_t n, int has_bands,
                                       adcgs_error *error)
{
    const size_t per = has_bands ? 3 * adcgs_fourdgs_coefficients(f->degree) : 0;
    adcgs_fourdgs_state *const s = *out = n <= ADCGS_SPLATS_MAX ? calloc(1, sizeof *s) : NULL;
    if (n > ADCGS_SPLATS_MAX)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .4dgs: %llu splats at a time, expected at most %u", f->path,
                          (unsigned long long)n, ADCGS_SPLATS_MAX);
    if (s) {
        s->n = (uint32_t)n;
        s->rows = malloc(n * ADCGS_FOURDGS_ROW * sizeof *s->rows + !n);
        s->harmonics = per ? malloc(n * per + !n) : NULL;
    }
    if (s && s->rows && (s->harmonics || !per))
        return ADCGS_OK;
    adcgs_fourdgs_state_free(s);
    *out = NULL;
    return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %llu splats", f->path, (unsigned long long)n);
}

void adcgs_fourdgs_state_free(void *state)
{
    adcgs_fourdgs_state *const s = state;
    if (!s)
        return;
    free(s->rows);
    free(s->harmonics);
    free(s);
}

static int compare_entries(const void *a, const void *b)
{
    const entry *const x = a, *const y = b;
    return (x->id > y->id) - (x->id < y->id);
}

/** The order of a group by id; the caller frees *order. */
static adcgs_status sort_ids(entry **order, const adcgs_fourdgs *f, const adcgs_fourdgs_columns *columns, const char *where,
                             adcgs_error *error)
{
    const uint32_t n = columns->n;
    const adcgs_fourdgs_column *const ids = &columns->column[ADCGS_FOURDGS_ID];
    entry *const list = *order = malloc(n * sizeof *list + !n);
    if (!list)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %u splats", f->path, n);
    for (uint32_t i = 0; i < n; i++)
        list[i] = (entry){(uint32_t)ids->values[(size_t)i * ids->stride], i};
    if (n)
        qsort(list, n, sizeof *list, compare_entries);
    for (uint32_t i = 1; i < n; i++)
        if (list[i].id == list[i - 1].id)
            return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .4dgs: the id %u occurs twice in %s", f->path, list[i].id, where);
    return ADCGS_OK;
}

/** Harmonics of a chunk's splats in their order. */
static adcgs_status sort_harmonics(adcgs_fourdgs_state *s, const entry *order, const adcgs_fourdgs *f,
                                   const adcgs_fourdgs_chunk *chunk, const char *where, adcgs_error *error)
{
    const size_t per = 3 * adcgs_fourdgs_coefficients(f->degree);
    uint8_t *const bytes = malloc(s->n * per + !s->n);
    const adcgs_status status = bytes ? adcgs_fourdgs_bands_read(bytes, chunk, f->degree, f->path, where, error)
                                      : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %u splats", f->path, s->n);
    for (uint32_t i = 0; i < s->n && status == ADCGS_OK; i++)
        memcpy(s->harmonics + i * per, bytes + order[i].from * per, per);
    free(bytes);
    return status;
}

static adcgs_status fill_state(adcgs_fourdgs_state **out, const adcgs_fourdgs_columns *columns, const entry *order,
                               const adcgs_fourdgs *f, int has_bands, const adcgs_fourdgs_chunk *chunk, const char *where,
                               adcgs_error *error)
{
    ADCGS_TRY(adcgs_fourdgs_state_alloc(out, f, columns->n, has_bands, error));
    adcgs_fourdgs_state *const s = *out;
    for (int a = 0; a < ADCGS_FOURDGS_ATTRIBUTES; a++)
        s->present |= columns->column[a].values ? 1 << a : 0;
    for (uint32_t i = 0; i < s->n; i++)
        adcgs_fourdgs_row(s->rows + (size_t)i * ADCGS_FOURDGS_ROW, columns, order[i].from);
    return s->harmonics ? sort_harmonics(s, order, f, chunk, where, error) : ADCGS_OK;
}

adcgs_status adcgs_fourdgs_group_read(adcgs_fourdgs_state **out, const adcgs_fourdgs *f, const adcgs_fourdgs_group *group,
                                      const adcgs_fourdgs_chunk *chunk, const char *where, adcgs_error *error)
{
    adcgs_fourdgs_columns columns;
    entry *order = NULL;
    *out = NULL;
    adcgs_status status = adcgs_fourdgs_columns_read(&columns, group->block, group->n, group->wanted,
                                                     group->n ? group->required : 0, f->path, where, error);
    if (status == ADCGS_OK)
        status = sort_ids(&order, f, &columns, where, error);
    if (status == ADCGS_OK)
        status = fill_state(out, &columns, order, f, group->has_bands && group->n, chunk, where, error);
    if (status != ADCGS_OK) {
        adcgs_fourdgs_state_free(*out);
        *out = NULL;
    }
    free(order);
    adcgs_fourdgs_columns_free(&columns);
    return status;
}

adcgs_status adcgs_fourdgs_state_read(adcgs_fourdgs_state **out, const adcgs_fourdgs *f, uint32_t index, adcgs_error *error)
{
    const adcgs_fourdgs_chunk *const chunk = &f->chunks[index];
    const int required = ADCGS_FOURDGS_ALL | ADCGS_FOURDGS_HAS_ID;
    uint8_t *block;
    char where[32];
    *out = NULL;
    snprintf(where, sizeof where, "chunk %u", index);
    ADCGS_TRY(adcgs_fourdgs_block(&block, chunk, f->path, where, error));
    const adcgs_fourdgs_group group = {{block, block + chunk->streams.unpacked, 0},
                                       chunk->n,
                                       required | ADCGS_FOURDGS_HAS_OBJECT,
                                       required,
                                       1};
    const adcgs_status status = adcgs_fourdgs_group_read(out, f, &group, chunk, where, error);
    free(block);
    return status;
}

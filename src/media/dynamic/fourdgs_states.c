/* SPDX-License-Identifier: BSD-2-Clause */
/** \file States of a .4dgs file with keyframes, composed from the nearest state that is known. */
#include "config.h"

#include "media/dynamic/fourdgs_states.h"

#include <math.h>
#include <stdlib.h>

#define GAP 1e-6 /* seconds: largest gap between chunks, and between a chunk and the file's ends; chosen by hand, not measured */
#define ROUNDING 5e-7 /* seconds: a chunk begins this much earlier; chosen by hand, not measured */

/** A chunk and the time of its beginning. */
typedef struct beginning {
    double seconds;
    uint32_t chunk;
} beginning;

static int compare_beginnings(const void *a, const void *b)
{
    const beginning *const x = a, *const y = b;
    return x->seconds != y->seconds ? (x->seconds > y->seconds) - (x->seconds < y->seconds)
                                    : (x->chunk > y->chunk) - (x->chunk < y->chunk);
}

static adcgs_status check_order(const adcgs_fourdgs_states *s, adcgs_error *error)
{
    const adcgs_fourdgs *const f = s->f;
    double end = 0.0;
    for (uint32_t i = 0; i < f->n_chunks; i++) {
        const adcgs_fourdgs_chunk *const k = &f->chunks[s->order[i]];
        if (!(fabs(k->begin - end) <= GAP))
            return adcgs_fail(error, ADCGS_ERR_DATA,
                              "%s: .4dgs: chunk %u begins at %.9g seconds, expected %.9g, the end before it", f->path,
                              s->order[i], k->begin, end);
        end = k->end;
    }
    if (f->n_chunks && !(fabs(f->duration - end) <= GAP))
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .4dgs: the chunks end at %.9g seconds of %.9g", f->path, end, f->duration);
    return ADCGS_OK;
}

static adcgs_status sort_chunks(adcgs_fourdgs_states *s, adcgs_error *error)
{
    const uint32_t n = s->f->n_chunks;
    beginning *const list = malloc(n * sizeof *list + !n);
    s->order = malloc(n * sizeof *s->order + !n);
    if (!list || !s->order) {
        free(list);
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", s->f->path);
    }
    for (uint32_t i = 0; i < n; i++)
        list[i] = (beginning){s->f->chunks[i].begin, i};
    if (n)
        qsort(list, n, sizeof *list, compare_beginnings);
    for (uint32_t i = 0; i < n; i++)
        s->order[i] = list[i].chunk;
    free(list);
    return check_order(s, error);
}

/* ---- Composition ---- */

/** Chunks from one backwards to a keyframe, or to the chunk after a known state; the caller frees *chain. */
static adcgs_status find_chain(uint32_t **chain, uint32_t *n, const adcgs_fourdgs_states *s, uint32_t chunk, adcgs_error *error)
{
    const adcgs_fourdgs_chunk *const chunks = s->f->chunks;
    uint32_t length = 1;
    for (uint32_t i = chunk; chunks[i].is_delta && !adcgs_recent_peek(&s->recent, chunks[i].reference); length++)
        i = chunks[i].reference;
    uint32_t *const list = *chain = malloc(length * sizeof *list);
    if (!list)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %u chunks", s->f->path, length);
    for (uint32_t i = chunk, k = 0; k < length; i = chunks[i].reference)
        list[k++] = i;
    *n = length;
    return ADCGS_OK;
}

static adcgs_status make_state(void **part, const void *user, uint32_t chunk, adcgs_error *error)
{
    const adcgs_fourdgs_states *const s = user;
    adcgs_fourdgs_state *state = NULL, *next;
    uint32_t *chain, n = 0;
    adcgs_status status = find_chain(&chain, &n, s, chunk, error);
    while (status == ADCGS_OK && n-- > 0) {
        const adcgs_fourdgs_chunk *const k = &s->f->chunks[chain[n]];
        const adcgs_fourdgs_state *const from = state ? state : adcgs_recent_peek(&s->recent, k->reference);
        status = k->is_delta ? adcgs_fourdgs_state_change(&next, from, s->f, chain[n], error)
                             : adcgs_fourdgs_state_read(&next, s->f, chain[n], error);
        adcgs_fourdgs_state_free(state);
        state = next;
    }
    free(chain);
    *part = state;
    return status;
}

adcgs_status adcgs_fourdgs_states_open(adcgs_fourdgs_states *s, const adcgs_fourdgs *f, adcgs_error *error)
{
    *s = (adcgs_fourdgs_states){.f = f, .recent = {.make = make_state, .drop = adcgs_fourdgs_state_free, .user = s}};
    adcgs_recent_init(&s->recent);
    return sort_chunks(s, error);
}

void adcgs_fourdgs_states_close(adcgs_fourdgs_states *s)
{
    if (!s->f)
        return;
    adcgs_recent_clear(&s->recent);
    free(s->order);
    s->order = NULL;
    s->f = NULL;
}

uint32_t adcgs_fourdgs_states_find(const adcgs_fourdgs_states *s, double seconds)
{
    uint32_t low = 0, high = s->f->n_chunks;
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        if (s->f->chunks[s->order[middle]].begin <= seconds + ROUNDING)
            low = middle;
        else
            high = middle;
    }
    return s->order[low];
}

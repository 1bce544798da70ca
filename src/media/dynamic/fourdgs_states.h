/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * .4dgs files of the model keyframe-delta: chunks that follow each other in time, each with the state of all its splats, or with
 * births, deaths and updates against an earlier chunk. States are composed when they are requested.
 */
#ifndef ADCGS_MEDIA_DYNAMIC_FOURDGS_STATES_H
#define ADCGS_MEDIA_DYNAMIC_FOURDGS_STATES_H

#include "media/dynamic/fourdgs_streams.h"
#include "media/dynamic/recent_parts.h"

/** Splats by id, each once; or updates of splats, or the ids of dead ones. */
typedef struct adcgs_fourdgs_state {
    uint32_t n;
    int present;        /**< set of attributes that are there */
    int32_t *rows;      /**< [n][ADCGS_FOURDGS_ROW] */
    uint8_t *harmonics; /**< [n][3][coefficients]; NULL with degree 0 and without bands */
} adcgs_fourdgs_state;

typedef struct adcgs_fourdgs_states {
    const adcgs_fourdgs *f;
    uint32_t *order;     /**< chunks by time */
    adcgs_recent recent; /**< states, by index of chunks */
} adcgs_fourdgs_states;

static inline const int32_t *adcgs_fourdgs_state_row(const adcgs_fourdgs_state *s, uint32_t i)
{
    return s->rows + (size_t)i * ADCGS_FOURDGS_ROW;
}
static inline uint32_t adcgs_fourdgs_state_id(const adcgs_fourdgs_state *s, uint32_t i)
{
    return (uint32_t)adcgs_fourdgs_state_row(s, i)[ADCGS_FOURDGS_ROW_ID];
}

/** Order the chunks, which must follow each other from 0 to the duration. Also on failure the caller calls the next function. */
adcgs_status adcgs_fourdgs_states_open(adcgs_fourdgs_states *states, const adcgs_fourdgs *f, adcgs_error *error);
void adcgs_fourdgs_states_close(adcgs_fourdgs_states *states);
/** Index of the chunk that is valid at a time; the file has a chunk. */
uint32_t adcgs_fourdgs_states_find(const adcgs_fourdgs_states *states, double seconds);

/** A group of streams in a chunk. */
typedef struct adcgs_fourdgs_group {
    adcgs_byte_cursor block;
    uint32_t n;
    int wanted, required; /**< sets of attributes */
    int has_bands;        /**< true: the chunk's harmonics are those of this group */
} adcgs_fourdgs_group;

/** Room for n splats. On failure, here and below, *out is NULL. */
adcgs_status adcgs_fourdgs_state_alloc(adcgs_fourdgs_state **out, const adcgs_fourdgs *f, uint64_t n, int has_bands,
                                       adcgs_error *error);
void adcgs_fourdgs_state_free(void *state);
/** Read a group and sort it by id. where: "the births of chunk 3", for messages. */
adcgs_status adcgs_fourdgs_group_read(adcgs_fourdgs_state **out, const adcgs_fourdgs *f, const adcgs_fourdgs_group *group,
                                      const adcgs_fourdgs_chunk *chunk, const char *where, adcgs_error *error);
/** Read a chunk with all its splats. */
adcgs_status adcgs_fourdgs_state_read(adcgs_fourdgs_state **out, const adcgs_fourdgs *f, uint32_t chunk, adcgs_error *error);
/** Apply a chunk of changes to the state that it refers to. */
adcgs_status adcgs_fourdgs_state_change(adcgs_fourdgs_state **out, const adcgs_fourdgs_state *from, const adcgs_fourdgs *f,
                                        uint32_t chunk, adcgs_error *error);

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Chunks of changes in a .4dgs file: deaths, then updates, then births. Updates are differences of bins, so that no error
 * adds up; rotations and objects are replaced.
 */
#include "config.h"

#include "media/dynamic/fourdgs_states.h"

#include <stdio.h>
#include <stdlib.h>

/* Sets of attributes that never change, and that updates replace. Origin: definition (.4dgs, section 11.5). */
#define FIXED ((1 << ADCGS_FOURDGS_SIGMA) | (1 << ADCGS_FOURDGS_FLAGS) | (1 << ADCGS_FOURDGS_WINDOW))
#define REPLACED ((1 << ADCGS_FOURDGS_OMITTED) | (1 << ADCGS_FOURDGS_ROTATION) | ADCGS_FOURDGS_HAS_OBJECT)

#define NO_ID ((uint64_t)1 << 32) /* above all ids; arithmetic */

/** Groups of a chunk, and the state that they change. */
typedef struct change {
    const adcgs_fourdgs *f;
    const adcgs_fourdgs_state *from;
    adcgs_fourdgs_state *updates, *births, *deaths, *out;
    uint32_t chunk;
    adcgs_error *error;
} change;

static uint64_t id_at(const adcgs_fourdgs_state *s, uint32_t i)
{
    return i < s->n ? adcgs_fourdgs_state_id(s, i) : NO_ID;
}

/** Append splat i of a state. */
static void copy_splat(change *c, const adcgs_fourdgs_state *s, uint32_t i)
{
    const size_t per = 3 * adcgs_fourdgs_coefficients(c->f->degree), to = c->out->n++;
    memcpy(c->out->rows + to * ADCGS_FOURDGS_ROW, adcgs_fourdgs_state_row(s, i), ADCGS_FOURDGS_ROW * sizeof(int32_t));
    if (c->out->harmonics && s->harmonics)
        memcpy(c->out->harmonics + to * per, s->harmonics + i * per, per);
}

/** Apply update i to the last splat of the new state. */
static adcgs_status apply_update(const change *c, uint32_t i)
{
    int32_t *const row = c->out->rows + (size_t)(c->out->n - 1) * ADCGS_FOURDGS_ROW;
    const int32_t *const update = adcgs_fourdgs_state_row(c->updates, i);
    for (int a = 0; a < ADCGS_FOURDGS_ATTRIBUTES; a++) {
        const int place = adcgs_fourdgs_places[a];
        for (int k = 0; k < adcgs_fourdgs_channels[a] && a != ADCGS_FOURDGS_ID && (c->updates->present >> a & 1); k++) {
            const int64_t sum = (REPLACED >> a & 1 ? 0 : (int64_t)row[place + k]) + update[place + k];
            if (sum != (int32_t)sum)
                return adcgs_fail(c->error, ADCGS_ERR_DATA, "%s: .4dgs: the %s of id %u leave 32 bits in chunk %u", c->f->path,
                                  adcgs_fourdgs_names[a], adcgs_fourdgs_state_id(c->updates, i), c->chunk);
            row[place + k] = (int32_t)sum;
        }
    }
    return ADCGS_OK;
}

/** All groups are sorted by id, so that one pass joins them. An id without a splat stops its group. */
static adcgs_status join_groups(change *c)
{
    uint32_t i = 0, b = 0, d = 0, u = 0;
    while (i < c->from->n || b < c->births->n) {
        const uint64_t id = id_at(c->from, i), born = id_at(c->births, b);
        if (born == id)
            return adcgs_fail(c->error, ADCGS_ERR_DATA, "%s: .4dgs: chunk %u: the id %u is born, but exists", c->f->path,
                              c->chunk, (uint32_t)id);
        if (born < id) {
            copy_splat(c, c->births, b++);
        } else if (id_at(c->deaths, d) == id) {
            d++, i++;
        } else {
            copy_splat(c, c->from, i++);
            if (id_at(c->updates, u) == id)
                ADCGS_TRY(apply_update(c, u++));
        }
    }
    if (d < c->deaths->n || u < c->updates->n)
        return adcgs_fail(c->error, ADCGS_ERR_DATA, "%s: .4dgs: chunk %u: the id %u %s, but does not exist", c->f->path, c->chunk,
                          adcgs_fourdgs_state_id(d < c->deaths->n ? c->deaths : c->updates, d < c->deaths->n ? d : u),
                          d < c->deaths->n ? "dies" : "changes");
    return ADCGS_OK;
}

/* ---- Groups ---- */

/** The next part of a chunk's block: a length and that many bytes. */
static adcgs_status next_group(adcgs_fourdgs_state **out, const change *c, adcgs_byte_cursor *block, adcgs_fourdgs_group *group,
                               const char *name)
{
    char where[64];
    group->block = adcgs_cursor_part(block, adcgs_cursor_u64(block));
    snprintf(where, sizeof where, "the %s of chunk %u", name, c->chunk);
    if (block->failed)
        return adcgs_fail(c->error, ADCGS_ERR_DATA, "%s: .4dgs: %s end early", c->f->path, where);
    return adcgs_fourdgs_group_read(out, c->f, group, &c->f->chunks[c->chunk], where, c->error);
}

static adcgs_status read_groups(change *c, adcgs_byte_cursor block)
{
    const adcgs_fourdgs_chunk *const k = &c->f->chunks[c->chunk];
    const int id = ADCGS_FOURDGS_HAS_ID, all = ADCGS_FOURDGS_ALL | id;
    adcgs_fourdgs_group updates = {.n = k->updates, .wanted = all | ADCGS_FOURDGS_HAS_OBJECT, .required = id};
    adcgs_fourdgs_group births = {.n = k->n, .wanted = all | ADCGS_FOURDGS_HAS_OBJECT, .required = all, .has_bands = 1};
    adcgs_fourdgs_group deaths = {.n = k->deaths, .wanted = id, .required = id};
    ADCGS_TRY(next_group(&c->updates, c, &block, &updates, "updates"));
    if (c->updates->present & FIXED)
        return adcgs_fail(c->error, ADCGS_ERR_DATA, "%s: .4dgs: chunk %u updates sigmas, flags or windows, which never change",
                          c->f->path, c->chunk);
    ADCGS_TRY(next_group(&c->births, c, &block, &births, "births"));
    return next_group(&c->deaths, c, &block, &deaths, "deaths");
}

adcgs_status adcgs_fourdgs_state_change(adcgs_fourdgs_state **out, const adcgs_fourdgs_state *from, const adcgs_fourdgs *f,
                                        uint32_t index, adcgs_error *error)
{
    change c = {.f = f, .from = from, .chunk = index, .error = error};
    uint8_t *block;
    char where[32];
    *out = NULL;
    snprintf(where, sizeof where, "chunk %u", index);
    ADCGS_TRY(adcgs_fourdgs_block(&block, &f->chunks[index], f->path, where, error));
    adcgs_status status = read_groups(&c, (adcgs_byte_cursor){block, block + f->chunks[index].streams.unpacked, 0});
    free(block);
    if (status == ADCGS_OK)
        status = adcgs_fourdgs_state_alloc(&c.out, f, (uint64_t)from->n + c.births->n, f->degree > 0, error);
    if (status == ADCGS_OK) {
        c.out->n = 0;
        c.out->present = from->present;
        status = join_groups(&c);
    }
    if (status == ADCGS_OK)
        *out = c.out;
    else
        adcgs_fourdgs_state_free(c.out);
    adcgs_fourdgs_state_free(c.updates);
    adcgs_fourdgs_state_free(c.births);
    adcgs_fourdgs_state_free(c.deaths);
    return status;
}

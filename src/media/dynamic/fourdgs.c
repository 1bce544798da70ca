/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Reads .4dgs, version 1 draft, of avala-ai. Splats have lifetimes and velocities of their own, or follow from keyframes and
 * changes; rigid objects move them. The file has no frame rate.
 */
#include "config.h"

#include "media/dynamic/dynamic_readers.h"
#include "media/dynamic/fourdgs_births.h"
#include "media/dynamic/fourdgs_states.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Origin: chosen by hand, not measured. */
#define ROUNDING 1e-6      /* frames: a clip this much longer than a whole number has no further frame */
#define ROWS_PER_SPLAT 8u  /* ids per splat of the largest state up to which all ids have a row */
#define ROWS_ALWAYS 65536u /* ids that always have a row */

/** State of a source. */
typedef struct source {
    adcgs_fourdgs f;
    /* Lifetimes. */
    adcgs_motion motion;
    uint32_t *objects; /* of each splat; NULL without tracks */
    /* Keyframes. */
    adcgs_fourdgs_states states;
    uint32_t *ids, n_ids; /* of all splats, ascending; NULL without identity */
} source;

static int is_fourdgs(const uint8_t *data, size_t bytes)
{
    return bytes >= 5 && !memcmp(data + 1, "4DGS", 4);
}

/* ---- Identity of splats with keyframes ---- */

/** Add the ids of a state to a list. */
static adcgs_status add_ids(source *s, const adcgs_fourdgs_state *state, adcgs_error *error)
{
    uint32_t n = 0, i = 0, k = 0;
    uint32_t *const list = malloc(((size_t)s->n_ids + state->n + 1) * sizeof *list);
    if (!list)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %u ids", s->f.path, s->n_ids);
    while (i < s->n_ids || k < state->n) {
        const uint64_t none = UINT64_MAX, old = i < s->n_ids ? s->ids[i] : none;
        const uint64_t new = k < state->n ? adcgs_fourdgs_state_id(state, k) : none;
        list[n++] = (uint32_t)ADCGS_MIN(old, new);
        i += old <= new;
        k += new <= old;
    }
    free(s->ids);
    s->ids = list;
    s->n_ids = n;
    return ADCGS_OK;
}

/** Compose all states once: this checks the file and finds the ids. */
static adcgs_status collect_ids(source *s, uint32_t *most, adcgs_error *error)
{
    *most = 0;
    for (uint32_t i = 0; i < s->f.n_chunks; i++) {
        const void *part;
        ADCGS_TRY(adcgs_recent_take(&s->states.recent, i, &part, error));
        const adcgs_fourdgs_state *const state = part;
        const adcgs_status status = s->f.chunks[i].n ? add_ids(s, state, error) : ADCGS_OK;
        *most = ADCGS_MAX(*most, state->n);
        adcgs_recent_give(&s->states.recent, part);
        ADCGS_TRY(status);
    }
    if (s->n_ids != s->f.n)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .4dgs: %u ids in its chunks, but %llu in its header", s->f.path, s->n_ids,
                          (unsigned long long)s->f.n);
    return ADCGS_OK;
}

/** All ids get a row, unless they are many times those of any state. */
static adcgs_status open_states(adcgs_dynamic *m, source *s, adcgs_error *error)
{
    uint32_t most;
    ADCGS_TRY(adcgs_fourdgs_states_open(&s->states, &s->f, error));
    ADCGS_TRY(collect_ids(s, &most, error));
    m->n = s->n_ids;
    m->has_identity = s->n_ids <= ADCGS_MAX(ROWS_ALWAYS, (uint64_t)ROWS_PER_SPLAT * most);
    if (m->has_identity)
        return ADCGS_OK;
    const void *part;
    snprintf(m->remark, sizeof m->remark, "%u ids, at most %u at a time: splats of different frames are not matched", s->n_ids,
             most);
    free(s->ids);
    s->ids = NULL;
    ADCGS_TRY(adcgs_recent_take(&s->states.recent, adcgs_fourdgs_states_find(&s->states, 0.0), &part, error));
    m->n = ((const adcgs_fourdgs_state *)part)->n;
    adcgs_recent_give(&s->states.recent, part);
    return ADCGS_OK;
}

/* ---- A time ---- */

/** Put a state into the rows of a motion: those of the ids, or those of the state. */
static adcgs_status place_state(adcgs_motion *motion, uint32_t *objects, const source *s, const adcgs_fourdgs_state *state,
                                adcgs_error *error)
{
    static const adcgs_fourdgs_window always = {-INFINITY, INFINITY};
    const size_t per = 3 * adcgs_fourdgs_coefficients(s->f.degree);
    for (uint32_t i = 0, to = 0; i < state->n; i++, to++) {
        const int32_t *const row = adcgs_fourdgs_state_row(state, i);
        while (s->ids && s->ids[to] != (uint32_t)row[ADCGS_FOURDGS_ROW_ID])
            to++;
        ADCGS_TRY(
            adcgs_fourdgs_set(motion, to, &s->f, row, state->harmonics ? state->harmonics + i * per : NULL, &always, error));
        if (objects)
            objects[to] = (uint32_t)row[ADCGS_FOURDGS_ROW_OBJECT];
    }
    return ADCGS_OK;
}

/** The motion of the chunk at a time. */
static adcgs_status motion_of_chunk(adcgs_motion *motion, uint32_t **objects, source *s, double seconds, adcgs_error *error)
{
    const void *part;
    *objects = NULL;
    if (!s->f.n_chunks)
        return adcgs_fourdgs_motion(motion, &s->f, 0, error);
    ADCGS_TRY(adcgs_recent_take(&s->states.recent, adcgs_fourdgs_states_find(&s->states, seconds), &part, error));
    const adcgs_fourdgs_state *const state = part;
    const size_t n = s->ids ? s->n_ids : state->n;
    adcgs_status status = adcgs_fourdgs_motion(motion, &s->f, n, error);
    if (status == ADCGS_OK && s->f.n_tracks && !(*objects = calloc(n + !n, sizeof **objects)))
        status = adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %zu splats", s->f.path, n);
    if (status == ADCGS_OK)
        status = place_state(motion, *objects, s, state, error);
    adcgs_recent_give(&s->states.recent, part);
    return status;
}

static adcgs_status states_at(source *s, double seconds, adcgs_splats *out, adcgs_error *error)
{
    adcgs_motion motion = {0};
    uint32_t *objects;
    adcgs_status status = motion_of_chunk(&motion, &objects, s, seconds, error);
    if (status == ADCGS_OK)
        status = adcgs_motion_at(&motion, seconds, out, s->f.path, error);
    adcgs_motion_free(&motion);
    if (status == ADCGS_OK)
        status = adcgs_fourdgs_move(out, objects, &s->f, seconds, error);
    free(objects);
    return status;
}

static adcgs_status fourdgs_at(const adcgs_dynamic *m, double seconds, adcgs_splats *out, adcgs_error *error)
{
    source *const s = m->state;
    if (s->f.has_keyframes)
        return states_at(s, seconds, out, error);
    ADCGS_TRY(adcgs_motion_at(&s->motion, seconds, out, m->path, error));
    return adcgs_fourdgs_move(out, s->objects, &s->f, seconds, error);
}

/* ---- The file ---- */

static adcgs_status set_frames(adcgs_dynamic *m, double duration, adcgs_error *error)
{
    m->rate = m->options.rate.den ? m->options.rate : (adcgs_fps){ADCGS_DYNAMIC_RATE, 1};
    const double frames = fmax(ceil(duration * adcgs_fps_value(m->rate) - ROUNDING), 1.0);
    if (frames > ADCGS_DYNAMIC_FRAMES_MAX)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED,
                          "%s: %g seconds are %g frames, expected at most %u: give a lower frame rate", m->path, duration, frames,
                          ADCGS_DYNAMIC_FRAMES_MAX);
    m->frames = (uint32_t)frames;
    return ADCGS_OK;
}

static adcgs_status open_fourdgs(adcgs_dynamic *m, adcgs_error *error)
{
    ADCGS_TRY(adcgs_planes_check(m->path, ".4dgs", error));
    source *const s = m->state = calloc(1, sizeof *s);
    if (!s)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", m->path);
    s->f = (adcgs_fourdgs){.path = m->path, .data = m->data, .bytes = m->bytes};
    ADCGS_TRY(adcgs_fourdgs_read(&s->f, error));
    ADCGS_TRY(set_frames(m, s->f.duration, error));
    m->is_continuous = 1;
    if (s->f.has_keyframes)
        return open_states(m, s, error);
    ADCGS_TRY(adcgs_fourdgs_births(&s->motion, &s->objects, &s->f, error));
    m->n = s->motion.base.n;
    m->has_identity = 1;
    return ADCGS_OK;
}

static void close_fourdgs(adcgs_dynamic *m)
{
    source *const s = m->state;
    if (!s)
        return;
    adcgs_fourdgs_states_close(&s->states);
    adcgs_motion_free(&s->motion);
    adcgs_fourdgs_free(&s->f);
    free(s->objects);
    free(s->ids);
    free(s);
    m->state = NULL;
}

const adcgs_dynamic_reader adcgs_dynamic_fourdgs = {".4dgs", is_fourdgs, 1, open_fourdgs, fourdgs_at, close_fourdgs};

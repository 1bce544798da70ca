/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-dec: rows of splats that are the same splats in all frames. */
#include "config.h"

#include "apps/dec/dec_rows.h"

#include "api/segment_at.h"
#include "media/splats/offset.h"
#include "system/interrupt.h"

#include <stdlib.h>

#define UNSEEN 1e-7f /* opacity of rows that are invisible, far below 1/255; chosen by hand, not measured */

static adcgs_status add_span(adcgs_dec_rows *rows, uint32_t segment, uint32_t slots, int frame, const char *path,
                             adcgs_error *error)
{
    adcgs_dec_span *const more = realloc(rows->span, (rows->n + 1) * sizeof *more);
    if (!more)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    rows->span = more;
    adcgs_dec_span *const s = &more[rows->n];
    *s = (adcgs_dec_span){.segment = segment, .slots = slots, .first = frame, .row = malloc((slots + 1) * sizeof *s->row)};
    rows->n++;
    if (!s->row)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %u splats", path, slots);
    for (uint32_t i = 0; i < slots; i++)
        s->row[i] = ADCGS_DEC_NO_ROW;
    ADCGS_TRY(adcgs_splats_alloc(&s->begin, slots, path, error));
    s->begin.n = 0;
    return ADCGS_OK;
}

/** Gives a row to each slot that is visible for the first time. */
static void take_new(adcgs_dec_rows *rows, adcgs_dec_span *s, const adcgs_primitives *p)
{
    for (uint32_t i = 0; i < p->n; i++)
        if (s->row[i] == ADCGS_DEC_NO_ROW && adcgs_splats_take_one(&s->begin, s->begin.n, p, i, rows->origin, rows->scale))
            s->row[i] = s->begin.n++;
    s->frames++;
}

static adcgs_status count_rows(adcgs_dec_rows *rows, const char *path, adcgs_error *error)
{
    uint64_t total = 0;
    for (size_t i = 0; i < rows->n; i++) {
        rows->span[i].first_row = (uint32_t)total;
        total += rows->span[i].begin.n;
        if (total > ADCGS_SPLATS_MAX)
            return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED,
                              "%s: more than %u splats in the segments of these times: give a shorter --time", path,
                              ADCGS_SPLATS_MAX);
    }
    rows->total = (uint32_t)total;
    return ADCGS_OK;
}

adcgs_status adcgs_dec_rows_find(adcgs_dec_rows *out, adcgs_decoder *decoder, const adcgs_info *info,
                                 const adcgs_camera_path *frames, const char *path, adcgs_error *error)
{
    *out = (adcgs_dec_rows){.scale = info->scene_scale};
    adcgs_offset_of(out->offset, info->scene_origin, info->scene_scale);
    for (int a = 0; a < 3; a++)
        out->origin[a] = info->scene_origin[a] - out->offset[a];
    for (int i = 0; i < frames->n && !adcgs_interrupted(); i++) {
        adcgs_primitives p;
        uint32_t segment;
        ADCGS_TRY(adcgs_decoder_primitives(decoder, frames->frame[i].time, &segment, &p, error));
        if (!out->n || out->span[out->n - 1].segment != segment || out->span[out->n - 1].slots != p.n)
            ADCGS_TRY(add_span(out, segment, p.n, i, path, error));
        take_new(out, &out->span[out->n - 1], &p);
    }
    return count_rows(out, path, error);
}

void adcgs_dec_rows_free(adcgs_dec_rows *rows)
{
    for (size_t i = 0; i < rows->n; i++) {
        free(rows->span[i].row);
        adcgs_splats_free(&rows->span[i].begin);
    }
    free(rows->span);
    *rows = (adcgs_dec_rows){0};
}

adcgs_status adcgs_dec_rows_at(const adcgs_dec_span *span, adcgs_decoder *decoder, double time, adcgs_primitives *out,
                               const char *path, adcgs_error *error)
{
    uint32_t segment;
    ADCGS_TRY(adcgs_decoder_primitives(decoder, time, &segment, out, error));
    return segment == span->segment && out->n == span->slots
               ? ADCGS_OK
               : adcgs_fail(error, ADCGS_ERR_DATA, "%s: segment %u with %u splats at %g s, expected segment %u with %u", path,
                            segment, out->n, time, span->segment, span->slots);
}

static void hide(adcgs_splats *s)
{
    for (uint32_t i = 0; i < s->n; i++)
        s->opacity[i] = UNSEEN;
}

/** All rows at the time of their first frame, to be updated by update(). */
static adcgs_status start(adcgs_splats *out, const adcgs_dec_rows *rows, const char *path, adcgs_error *error)
{
    adcgs_splats *const parts = calloc(rows->n + 1, sizeof *parts);
    if (!parts)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    for (size_t i = 0; i < rows->n; i++)
        parts[i] = rows->span[i].begin;
    const adcgs_status status = adcgs_splats_join(out, parts, rows->n, path, error);
    free(parts);
    ADCGS_TRY(status);
    for (int a = 0; a < 3; a++)
        out->offset[a] = rows->offset[a];
    hide(out);
    return ADCGS_OK;
}

/** Copies all arrays of a splat. */
static void copy_row(adcgs_splats *to, uint32_t row, const adcgs_splats *from)
{
    for (int a = 0; a < 3; a++) {
        to->mean[a][row] = from->mean[a][0];
        to->scale[a][row] = from->scale[a][0];
        to->colour[a][row] = from->colour[a][0];
    }
    for (int a = 0; a < 4; a++)
        to->rotation[a][row] = from->rotation[a][0];
    to->opacity[row] = from->opacity[0];
}

/** Sets the rows of a span to these primitives, and hides all others. */
static void update(adcgs_splats *splats, const adcgs_dec_rows *rows, const adcgs_dec_span *span, const adcgs_primitives *p)
{
    float values[14];
    adcgs_splats one = {.n = 1, .opacity = &values[10]};
    for (int a = 0; a < 3; a++) {
        one.mean[a] = &values[a];
        one.scale[a] = &values[3 + a];
        one.colour[a] = &values[11 + a];
    }
    for (int a = 0; a < 4; a++)
        one.rotation[a] = &values[6 + a];
    hide(splats);
    for (uint32_t i = 0; i < span->slots; i++)
        if (span->row[i] != ADCGS_DEC_NO_ROW && adcgs_splats_take_one(&one, 0, p, i, rows->origin, rows->scale))
            copy_row(splats, span->first_row + span->row[i], &one);
}

adcgs_status adcgs_dec_rows_each(const adcgs_dec_rows *rows, adcgs_decoder *decoder, const adcgs_camera_path *frames,
                                 const char *path, adcgs_dec_rows_fn take, void *user, adcgs_error *error)
{
    adcgs_splats splats = {0};
    adcgs_status status = start(&splats, rows, path, error);
    for (size_t k = 0; k < rows->n; k++)
        for (int i = 0; i < rows->span[k].frames && status == ADCGS_OK && !adcgs_interrupted(); i++) {
            const int frame = rows->span[k].first + i;
            adcgs_primitives primitives;
            status = adcgs_dec_rows_at(&rows->span[k], decoder, frames->frame[frame].time, &primitives, path, error);
            if (status != ADCGS_OK)
                break;
            update(&splats, rows, &rows->span[k], &primitives);
            status = take(user, frame, &splats, error);
        }
    adcgs_splats_free(&splats);
    return status;
}

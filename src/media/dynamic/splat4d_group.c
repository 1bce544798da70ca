/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Groups of frames of a .splat4d file: bins of the first frame, then differences from frame to frame, of the splats that the
 * masks name. Their symbols stay in planes; a frame adds up those of its group so far.
 */
#include "config.h"

#include "media/dynamic/splat4d.h"

#include <stdio.h>
#include <stdlib.h>

/** A group that is being unpacked. */
typedef struct reader {
    const adcgs_splat4d *s;
    const adcgs_splat4d_group *group;
    adcgs_splat4d_part *part;
    adcgs_error *error;
    char where[32]; /* for messages */
} reader;

/** Symbols of a stream: the first frame, or all other ones. */
static uint64_t count_symbols(const reader *r, int attribute, int kind)
{
    return (kind ? r->group->n_frames - 1 : (uint64_t)1) * r->s->n_moving[attribute] *
           (uint64_t)adcgs_splat4d_channels[attribute];
}

/** Check a stream against the masks, and that it lies in the group; unpack it. */
static adcgs_status take_stream(reader *r, adcgs_splat4d_stream *t, const uint8_t **at, const uint8_t *end)
{
    const char *const path = r->s->path, *const name = adcgs_splat4d_names[t->attribute];
    char what[96];
    if (t->kind > 1)
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: %s: %s of kind %d, expected 0 or 1", path, r->where, name, t->kind);
    const uint64_t expected = count_symbols(r, t->attribute, t->kind);
    if (t->elements != expected)
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: %s: %u symbols of %s, expected %llu", path, r->where, t->elements, name,
                          (unsigned long long)expected);
    if (t->packed.bytes > (uint64_t)(end - *at))
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: %s: %s of %llu bytes, %td follow", path, r->where, name,
                          (unsigned long long)t->packed.bytes, end - *at);
    if (r->part->planes[t->kind][t->attribute])
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: %s: two streams of %s", path, r->where, name);
    t->packed.data = *at;
    *at += t->packed.bytes;
    if (!expected)
        return ADCGS_OK;
    r->part->width[t->kind][t->attribute] = t->width;
    snprintf(what, sizeof what, "%s of %s", name, r->where);
    return adcgs_planes_unpack(&r->part->planes[t->kind][t->attribute], &t->packed, path, what, r->error);
}

/** Bytes of all streams together, which the table states, are bounded before any of them is unpacked. */
static adcgs_status read_streams(reader *r)
{
    const uint8_t *table = r->s->data + r->group->offset, *const end = table + r->group->bytes;
    adcgs_splat4d_stream streams[2 * ADCGS_SPLAT4D_ATTRIBUTES];
    const uint32_t n = r->group->bytes >= 2 ? adcgs_load_le16(table) : 0;
    uint64_t total = 0;
    if (r->group->bytes < 2 || n > ADCGS_COUNTOF(streams))
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: %s: %llu bytes with %u streams, expected at most %zu", r->s->path,
                          r->where, (unsigned long long)r->group->bytes, n, ADCGS_COUNTOF(streams));
    table += 2;
    for (uint32_t i = 0; i < n; i++) {
        ADCGS_TRY(adcgs_splat4d_stream_header(&streams[i], &table, end, r->s->path, r->where, r->error));
        total += streams[i].packed.unpacked;
    }
    if (total > ADCGS_PLANES_MAX)
        return adcgs_fail(r->error, ADCGS_ERR_UNSUPPORTED, "%s: %s: %llu bytes when unpacked, expected at most %llu", r->s->path,
                          r->where, (unsigned long long)total, (unsigned long long)ADCGS_PLANES_MAX);
    for (uint32_t i = 0; i < n; i++)
        ADCGS_TRY(take_stream(r, &streams[i], &table, end));
    for (int a = 0; a < ADCGS_SPLAT4D_ATTRIBUTES; a++)
        for (int kind = 0; kind < 2; kind++)
            if (!r->part->planes[kind][a] && count_symbols(r, a, kind))
                return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: %s: no %s, but those of %u splats change", r->s->path, r->where,
                                  adcgs_splat4d_names[a], r->s->n_moving[a]);
    return ADCGS_OK;
}

void adcgs_splat4d_drop(void *made)
{
    adcgs_splat4d_part *const part = made;
    for (int kind = 0; kind < 2; kind++)
        for (int a = 0; a < ADCGS_SPLAT4D_ATTRIBUTES; a++)
            free(part->planes[kind][a]);
    free(part);
}

adcgs_status adcgs_splat4d_make(void **made, const void *user, uint32_t group, adcgs_error *error)
{
    const adcgs_splat4d *const s = user;
    adcgs_splat4d_part *const part = calloc(1, sizeof *part);
    reader r = {.s = s, .group = &s->groups[group], .part = part, .error = error};
    *made = NULL;
    if (!part)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", s->path);
    part->n_frames = r.group->n_frames;
    snprintf(r.where, sizeof r.where, "group %u", group);
    const adcgs_status status = read_streams(&r);
    if (status == ADCGS_OK)
        *made = part;
    else
        adcgs_splat4d_drop(part);
    return status;
}

/* ---- Frames ---- */

/** Add the symbols of `frames` frames from symbol `first` on. Sums of 32-bit numbers of at most 2^17 frames fit in 64 bits. */
static void add_symbols(int64_t *bins, const uint8_t *planes, int width, uint64_t in_frame, uint32_t frames, uint64_t total)
{
    for (uint32_t f = 0; f < frames; f++)
        for (uint64_t k = 0; k < in_frame; k++)
            bins[k] += adcgs_zigzag(adcgs_planes_symbol(planes, total, f * in_frame + k, width));
}

static adcgs_status set_attribute(adcgs_splats *out, const adcgs_splat4d *s, const adcgs_splat4d_part *part, int attribute,
                                  uint32_t frame, adcgs_error *error)
{
    const uint64_t channels = (uint64_t)adcgs_splat4d_channels[attribute], in_frame = s->n_moving[attribute] * channels;
    adcgs_status status = ADCGS_OK;
    if (!in_frame)
        return ADCGS_OK;
    int64_t *const bins = calloc(in_frame, sizeof *bins);
    if (!bins)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %u splats", s->path, s->n_moving[attribute]);
    add_symbols(bins, part->planes[0][attribute], part->width[0][attribute], in_frame, 1, in_frame);
    add_symbols(bins, part->planes[1][attribute], part->width[1][attribute], in_frame, frame, (part->n_frames - 1) * in_frame);
    for (uint32_t k = 0; k < s->n_moving[attribute] && status == ADCGS_OK; k++)
        status =
            adcgs_splat4d_set(out, attribute, s->moving[attribute][k], bins + k * channels, s->step[attribute], s->path, error);
    free(bins);
    return status;
}

adcgs_status adcgs_splat4d_frame(adcgs_splats *out, const adcgs_splat4d *s, const adcgs_splat4d_part *part, uint32_t frame,
                                 adcgs_error *error)
{
    for (int a = 0; a < ADCGS_SPLAT4D_ATTRIBUTES; a++)
        ADCGS_TRY(set_attribute(out, s, part, a, frame, error));
    return ADCGS_OK;
}

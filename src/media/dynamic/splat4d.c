/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Reads .splat4d, version 1, of splats4D (A. Raudonis). Groups of frames are decoded on demand. */
#include "config.h"

#include "media/dynamic/dynamic_readers.h"
#include "media/dynamic/splat4d.h"

#include <stdlib.h>

static int is_splat4d(const uint8_t *data, size_t bytes)
{
    return bytes >= 4 && !memcmp(data, "SP4D", 4);
}

static adcgs_status open_splat4d(adcgs_dynamic *m, adcgs_error *error)
{
    ADCGS_TRY(adcgs_planes_check(m->path, ".splat4d", error));
    adcgs_splat4d *const s = m->state = calloc(1, sizeof *s);
    if (!s)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", m->path);
    *s = (adcgs_splat4d){.path = m->path, .data = m->data, .bytes = m->bytes};
    s->recent = (adcgs_recent){.make = adcgs_splat4d_make, .drop = adcgs_splat4d_drop, .user = s};
    adcgs_recent_init(&s->recent);
    ADCGS_TRY(adcgs_splat4d_header(s, error));
    ADCGS_TRY(adcgs_splat4d_base(s, error));
    m->rate = m->options.rate.den ? m->options.rate : adcgs_fps_of(s->fps);
    m->frames = s->n_frames;
    m->n = s->n;
    m->has_identity = 1;
    return ADCGS_OK;
}

static uint32_t group_of(const adcgs_splat4d *s, uint32_t frame)
{
    uint32_t low = 0, high = s->n_groups;
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        if (s->groups[middle].first <= frame)
            low = middle;
        else
            high = middle;
    }
    return low;
}

static adcgs_status splat4d_at(const adcgs_dynamic *m, double seconds, adcgs_splats *out, adcgs_error *error)
{
    adcgs_splat4d *const s = m->state;
    const uint32_t frame = adcgs_dynamic_frame(m, seconds), group = group_of(s, frame);
    const void *part;
    ADCGS_TRY(adcgs_splats_copy(out, &s->base, m->path, error));
    ADCGS_TRY(adcgs_recent_take(&s->recent, group, &part, error));
    const adcgs_status status = adcgs_splat4d_frame(out, s, part, frame - s->groups[group].first, error);
    adcgs_recent_give(&s->recent, part);
    return status;
}

static void close_splat4d(adcgs_dynamic *m)
{
    adcgs_splat4d *const s = m->state;
    if (!s)
        return;
    adcgs_recent_clear(&s->recent);
    adcgs_splats_free(&s->base);
    for (int a = 0; a < ADCGS_SPLAT4D_ATTRIBUTES; a++)
        free(s->moving[a]);
    free(s->groups);
    free(s);
    m->state = NULL;
}

const adcgs_dynamic_reader adcgs_dynamic_splat4d = {".splat4d", is_splat4d, 1, open_splat4d, splat4d_at, close_splat4d};

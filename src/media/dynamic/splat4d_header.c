/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The header of a .splat4d file. */
#include "config.h"

#include "media/dynamic/splat4d.h"

#include <jansson.h>
#include <math.h>
#include <stdlib.h>

/* Origin: definition (.splat4d's FORMAT.md), unless a line states another. */
#define FIXED_HEADER 12     /* bytes before the JSON text */
#define SPLATS_PER_BYTE 16u /* accepted splats per byte of the file; chosen by hand, not measured */
#define STEP_MAX 1e6        /* largest step, in the attribute's unit; chosen by hand, not measured */

/** A finite number of an object, at least `least` and at most `most`. */
static adcgs_status get_number(double *out, const adcgs_splat4d *s, const json_t *object, const char *name, double least,
                               double most, adcgs_error *error)
{
    const json_t *const value = json_object_get(object, name);
    *out = json_number_value(value);
    if (!json_is_number(value) || !(*out >= least && *out <= most))
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .splat4d's header: no %s from %g to %g", s->path, name, least, most);
    return ADCGS_OK;
}

static adcgs_status get_count(uint32_t *out, const adcgs_splat4d *s, const json_t *object, const char *name, uint32_t least,
                              uint32_t most, adcgs_error *error)
{
    const json_t *const value = json_object_get(object, name);
    const json_int_t count = json_integer_value(value);
    if (!json_is_integer(value) || count < least || count > most)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .splat4d's header: no whole number %s from %u to %u", s->path, name, least,
                          most);
    *out = (uint32_t)count;
    return ADCGS_OK;
}

/** The place of a section that lies in the file. */
static adcgs_status get_section(uint64_t *offset, uint64_t *bytes, const adcgs_splat4d *s, const json_t *object, const char *name,
                                adcgs_error *error)
{
    const json_int_t at = json_integer_value(json_object_get(object, "offset"));
    const json_int_t length = json_integer_value(json_object_get(object, "len"));
    if (at < FIXED_HEADER || length <= 0 || (uint64_t)at > s->bytes || (uint64_t)length > s->bytes - (uint64_t)at)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .splat4d's header: %s at offset %lld with %lld bytes, the file has %zu",
                          s->path, name, (long long)at, (long long)length, s->bytes);
    *offset = (uint64_t)at;
    *bytes = (uint64_t)length;
    return ADCGS_OK;
}

static adcgs_status get_steps(adcgs_splat4d *s, const json_t *steps, adcgs_error *error)
{
    const struct {
        const char *name;
        double *to;
    } rows[] = {
        {"pos", &s->step[ADCGS_SPLAT4D_MEAN]},        {"rot", &s->step[ADCGS_SPLAT4D_ROTATION]},
        {"rgb", &s->step[ADCGS_SPLAT4D_COLOUR]},      {"alpha", &s->step[ADCGS_SPLAT4D_OPACITY]},
        {"scale_log", &s->step[ADCGS_SPLAT4D_SCALE]}, {"base_pos", &s->base_mean},
        {"base_scale_log", &s->base_scale},
    };
    for (size_t i = 0; i < ADCGS_COUNTOF(rows); i++) {
        ADCGS_TRY(get_number(rows[i].to, s, steps, rows[i].name, 0.0, STEP_MAX, error));
        if (*rows[i].to == 0.0)
            return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .splat4d's header: the step %s is 0", s->path, rows[i].name);
    }
    return ADCGS_OK;
}

static adcgs_status get_groups(adcgs_splat4d *s, const json_t *list, adcgs_error *error)
{
    const size_t n = json_array_size(list);
    uint32_t next = 0, last = 0;
    if (!n || n > s->n_frames)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .splat4d's header: %zu groups of %u frames", s->path, n, s->n_frames);
    s->groups = calloc(n, sizeof *s->groups);
    if (!s->groups)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", s->path);
    s->n_groups = (uint32_t)n;
    for (size_t i = 0; i < n; i++, next = last + 1) {
        adcgs_splat4d_group *const g = &s->groups[i];
        const json_t *const row = json_array_get(list, i);
        ADCGS_TRY(get_section(&g->offset, &g->bytes, s, row, "a group", error));
        ADCGS_TRY(get_count(&g->first, s, row, "f0", 0, s->n_frames - 1, error));
        ADCGS_TRY(get_count(&last, s, row, "f1", g->first, s->n_frames - 1, error));
        if (g->first != next)
            return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .splat4d's header: group %zu begins at frame %u, expected %u", s->path,
                              i, g->first, next);
        g->n_frames = last - g->first + 1;
    }
    if (next != s->n_frames)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .splat4d's header: the groups end at frame %u of %u", s->path, next,
                          s->n_frames);
    return ADCGS_OK;
}

static adcgs_status get_members(adcgs_splat4d *s, const json_t *root, adcgs_error *error)
{
    ADCGS_TRY(get_count(&s->n, s, root, "n", 1, ADCGS_SPLATS_MAX, error));
    if (s->n / SPLATS_PER_BYTE > s->bytes)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %u splats in %zu bytes, expected at most %u in a byte", s->path, s->n,
                          s->bytes, SPLATS_PER_BYTE);
    ADCGS_TRY(get_count(&s->n_frames, s, root, "t", 1, ADCGS_DYNAMIC_FRAMES_MAX, error));
    ADCGS_TRY(get_number(&s->fps, s, root, "fps", ADCGS_FPS_MIN, ADCGS_FPS_MAX, error));
    ADCGS_TRY(get_steps(s, json_object_get(root, "steps"), error));
    ADCGS_TRY(
        get_section(&s->base_offset, &s->base_bytes, s, json_object_get(root, "static_section"), "the static section", error));
    return get_groups(s, json_object_get(root, "gops"), error);
}

adcgs_status adcgs_splat4d_header(adcgs_splat4d *s, adcgs_error *error)
{
    json_error_t fault;
    if (s->bytes < FIXED_HEADER)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .splat4d of %zu bytes ends in its header", s->path, s->bytes);
    const uint32_t version = adcgs_load_le16(s->data + 4), length = adcgs_load_le32(s->data + 8);
    if (version != 1)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: .splat4d of version %u, expected 1", s->path, version);
    if (length > s->bytes - FIXED_HEADER)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .splat4d's header of %u bytes, %zu follow", s->path, length,
                          s->bytes - FIXED_HEADER);
    json_t *const root = json_loadb((const char *)s->data + FIXED_HEADER, length, 0, &fault);
    if (!root)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .splat4d's header is not JSON: %s at byte %d", s->path, fault.text,
                          fault.position);
    const adcgs_status status = get_members(s, root, error);
    json_decref(root);
    return status;
}

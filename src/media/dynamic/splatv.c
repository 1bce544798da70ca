/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Reads .splatv, the form of SpacetimeGaussians that splaTV shows in browsers: a JSON text with a list of blocks, then the
 * blocks. A splat has 16 words, most of them pairs of binary16. Blocks are padded with invisible splats, which are dropped. Time
 * runs from 0 to 1. Frame i is at i / frames, as in SpacetimeGaussians. A file without motion holds the frames of a sequence,
 * whose last is at 1: there, frame i is at i / (frames - 1).
 */
#include "config.h"

#include "media/dynamic/motion.h"
#include "media/dynamic/dynamic_readers.h"
#include "media/splats/half.h"

#include <jansson.h>
#include <math.h>
#include <stdlib.h>

/* Origin, unless a line states one: definition (splaTV). */
#define MAGIC 0x674bu                  /* first word of a file */
#define HEADER 8                       /* bytes before the JSON text: magic, length of the text */
#define SPLAT 64                       /* bytes of a splat */
#define TEXT_MAX ((size_t)16 << 20)    /* bytes of JSON; chosen by hand, not measured: jansson takes about 20 times the text */
#define HALF_MAX 65504.0f              /* largest finite binary16; larger scales are stored as infinite; IEEE 754 */
#define HALF_MIN 5.960464477539063e-8f /* 2^-24, smallest binary16 > 0; smaller ones are stored as 0; IEEE 754 */

/** Places of values in a splat, in bytes; definition (splaTV). */
enum { ROTATION = 12, SCALE = 20, COLOUR = 28, MOTION = 32, TURN = 52, CENTRE = 60, SIGMA = 62 };

static int is_splatv(const uint8_t *data, size_t bytes)
{
    return bytes >= HEADER && adcgs_load_le32(data) == MAGIC;
}

static float half(const uint8_t *at)
{
    return (float)adcgs_load_half(at);
}

/* ---- Blocks ---- */

/** The block of splats among those that the JSON text lists, in their order. */
static adcgs_status find_in_list(const adcgs_dynamic *m, const json_t *list, size_t at, const uint8_t **out, size_t *size,
                                 adcgs_error *error)
{
    *out = NULL;
    for (size_t i = 0; i < json_array_size(list); i++) {
        const json_t *const entry = json_array_get(list, i), *const bytes = json_object_get(entry, "size");
        const char *const type = json_string_value(json_object_get(entry, "type"));
        const json_int_t n = json_integer_value(bytes);
        if (!type || !json_is_integer(bytes) || n < 0)
            return adcgs_fail(error, ADCGS_ERR_DATA, "%s: block %zu: expected a type and a size in bytes", m->path, i);
        if ((uint64_t)n > m->bytes - at)
            return adcgs_fail(error, ADCGS_ERR_DATA, "%s: block %zu has %lld bytes, but %zu follow", m->path, i, (long long)n,
                              m->bytes - at);
        if (!strcmp(type, "splat")) {
            if (*out || n % SPLAT)
                return adcgs_fail(error, *out ? ADCGS_ERR_UNSUPPORTED : ADCGS_ERR_DATA, "%s: block %zu: %s", m->path, i,
                                  *out ? "a second one of type splat, expected one" : "expected whole splats, of 64 bytes");
            *out = m->data + at;
            *size = (size_t)n;
        }
        at += (size_t)n;
    }
    return *out ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_DATA, "%s: no block of type splat in the JSON text", m->path);
}

static adcgs_status find_block(const adcgs_dynamic *m, const uint8_t **out, size_t *size, adcgs_error *error)
{
    const size_t text = adcgs_load_le32(m->data + 4);
    json_error_t where;
    if (text > m->bytes - HEADER)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %zu bytes of JSON, but %zu follow", m->path, text, m->bytes - HEADER);
    if (text > TEXT_MAX)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: %zu bytes of JSON, expected at most %zu", m->path, text, TEXT_MAX);
    json_t *const list = json_loadb((const char *)m->data + HEADER, text, 0, &where);
    if (!list)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: line %d: malformed JSON: %s", m->path, where.line, where.text);
    const adcgs_status status =
        json_is_array(list)
            ? find_in_list(m, list, HEADER + text, out, size, error)
            : adcgs_fail(error, ADCGS_ERR_DATA, "%s: the JSON text is not a list, expected one of blocks", m->path);
    json_decref(list);
    return status;
}

/* ---- Splats ---- */

static int is_padding(const uint8_t *at)
{
    return !at[COLOUR + 3] || (half(at + SCALE) == 0.0f && half(at + SCALE + 2) == 0.0f && half(at + SCALE + 4) == 0.0f);
}

/** A scale or a duration; binary16 has made some of them 0 or infinite. */
static float limit(float value, float most)
{
    return value == 0.0f ? HALF_MIN : value > most ? most : value;
}

/** Splat i, with times from 0 to 1. \return true if it moves */
static int take(adcgs_motion *m, uint32_t i, const uint8_t *at)
{
    adcgs_splats *const s = &m->base;
    int moves = 0;
    for (int a = 0; a < 3; a++) {
        s->mean[a][i] = adcgs_bits_float(adcgs_load_le32(at + 4 * a));
        s->scale[a][i] = limit(half(at + SCALE + 2 * a), HALF_MAX);
        s->colour[a][i] = (float)at[COLOUR + a] / 255.0f;
    }
    s->opacity[i] = (float)at[COLOUR + 3] / 255.0f;
    for (int a = 0; a < 4; a++) {
        s->rotation[a][i] = half(at + ROTATION + 2 * a);
        m->turn[a][i] = half(at + TURN + 2 * a);
        moves |= m->turn[a][i] != 0.0f;
    }
    for (int j = 0; j < ADCGS_MOTION_ORDERS; j++)
        for (int a = 0; a < 3; a++) {
            m->motion[j][a][i] = half(at + MOTION + 2 * (3 * j + a));
            moves |= m->motion[j][a][i] != 0.0f;
        }
    m->centre[i] = half(at + CENTRE);
    m->sigma[i] = (float)((double)limit(half(at + SIGMA), INFINITY) * sqrt(0.5)); /* exp(-(dt/s)^2), as in SpacetimeGaussians */
    return moves;
}

static adcgs_status read(adcgs_dynamic *m, adcgs_motion *motion, adcgs_error *error)
{
    const uint8_t *block;
    size_t size = 0, n = 0;
    uint32_t i = 0;
    int moves = 0;
    ADCGS_TRY(find_block(m, &block, &size, error));
    for (size_t at = 0; at < size; at += SPLAT)
        n += !is_padding(block + at);
    if (!n)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: no visible splat among %zu", m->path, size / SPLAT);
    ADCGS_TRY(adcgs_motion_alloc(motion, n, ADCGS_MOTION_ORDERS, ADCGS_MOTION_TURNS, m->path, error));
    for (size_t at = 0; at < size; at += SPLAT)
        if (!is_padding(block + at))
            moves |= take(motion, i++, block + at);
    adcgs_dynamic_set_clock(m, (adcgs_fps){0, 0}, 0);
    m->n = motion->base.n;
    m->has_identity = m->is_continuous = 1;
    adcgs_motion_stretch(motion, (moves ? m->frames : ADCGS_MAX(m->frames - 1, 1)) / adcgs_fps_value(m->rate));
    return adcgs_motion_check(motion, m->path, error);
}

static adcgs_status open_splatv(adcgs_dynamic *m, adcgs_error *error)
{
    m->state = calloc(1, sizeof(adcgs_motion));
    return m->state ? read(m, m->state, error) : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", m->path);
}

const adcgs_dynamic_reader adcgs_dynamic_splatv =
    {".splatv", is_splatv, 0, open_splatv, adcgs_dynamic_motion_at, adcgs_dynamic_motion_close};

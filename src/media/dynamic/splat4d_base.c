/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The static section of a .splat4d file: masks, and the values of frame 0. */
#include "config.h"

#include "media/dynamic/splat4d.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Origin: definition (.splat4d's FORMAT.md and code). */
#define STREAM_HEADER 11 /* bytes before a stream's data, or in a chunk's table */
#define STATIC_KIND 2    /* kind of a stream of the static section */
#define LEVELS 255.0     /* of colours and opacities */
#define TURN_UNIT 128.0  /* a component of a rotation of 1 */

const char *const adcgs_splat4d_names[ADCGS_SPLAT4D_ATTRIBUTES] = {"positions", "rotations", "colours", "opacities", "scales"};
const int adcgs_splat4d_channels[ADCGS_SPLAT4D_ATTRIBUTES] = {3, 4, 3, 1, 3};

/* ---- Streams ---- */

adcgs_status adcgs_splat4d_stream_header(adcgs_splat4d_stream *t, const uint8_t **at, const uint8_t *end, const char *path,
                                         const char *where, adcgs_error *error)
{
    const uint8_t *const p = *at;
    if (end - p < STREAM_HEADER)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %s ends in the header of a stream", path, where);
    *t = (adcgs_splat4d_stream){.attribute = p[0], .kind = p[1], .width = p[2], .elements = adcgs_load_le32(p + 3)};
    if (t->attribute >= ADCGS_SPLAT4D_ATTRIBUTES || (t->width != 1 && t->width != 2 && t->width != 4))
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %s: a stream of attribute %d with symbols of %d bytes", path, where,
                          t->attribute, t->width);
    t->packed =
        (adcgs_packed){p + STREAM_HEADER, adcgs_load_le32(p + 7), (uint64_t)t->elements * (uint64_t)t->width, ADCGS_PACKED_ZSTD};
    *at = p + STREAM_HEADER;
    return ADCGS_OK;
}

/** The section that is being read. */
typedef struct section {
    adcgs_splat4d *s;
    const uint8_t *at, *end;
    adcgs_error *error;
} section;

/** Unpack the next stream, which must have this attribute, size and width; width 0: any. The caller frees *planes. */
static adcgs_status next_stream(uint8_t **planes, int *width, section *c, int attribute, uint64_t elements, int bytes_of_symbol)
{
    const char *const path = c->s->path;
    char what[64];
    adcgs_splat4d_stream t;
    *planes = NULL;
    ADCGS_TRY(adcgs_splat4d_stream_header(&t, &c->at, c->end, path, "the static section", c->error));
    if (t.attribute != attribute || t.kind != STATIC_KIND || t.elements != elements ||
        (bytes_of_symbol && t.width != bytes_of_symbol))
        return adcgs_fail(c->error, ADCGS_ERR_DATA,
                          "%s: the static section: %u symbols of %d bytes, attribute %d, kind %d; expected %llu of %d, %d, %d",
                          path, t.elements, t.width, t.attribute, t.kind, (unsigned long long)elements,
                          bytes_of_symbol ? bytes_of_symbol : t.width, attribute, STATIC_KIND);
    if (t.packed.bytes > (uint64_t)(c->end - c->at))
        return adcgs_fail(c->error, ADCGS_ERR_DATA, "%s: the static section: a stream of %llu bytes, %td follow", path,
                          (unsigned long long)t.packed.bytes, c->end - c->at);
    c->at += t.packed.bytes;
    *width = t.width;
    snprintf(what, sizeof what, "%s of the static section", adcgs_splat4d_names[attribute]);
    return adcgs_planes_unpack(planes, &t.packed, path, what, c->error);
}

/* ---- Values ---- */

static int set_scale(adcgs_splats *out, uint32_t i, const int64_t *bins, double step)
{
    int good = 1;
    for (int a = 0; a < 3; a++) {
        out->scale[a][i] = (float)exp((double)bins[a] * step);
        good &= isnormal(out->scale[a][i]);
    }
    return good;
}

static int set_rotation(adcgs_splats *out, uint32_t i, const int64_t *bins, double step)
{
    double q[4], square = 0.0;
    for (int a = 0; a < 4; a++) {
        q[a] = (double)bins[a] * step / TURN_UNIT;
        square += q[a] * q[a];
    }
    for (int a = 0; a < 4 && square > 0.0; a++)
        out->rotation[a][i] = (float)(q[a] / sqrt(square));
    return square > 0.0;
}

adcgs_status adcgs_splat4d_set(adcgs_splats *out, int attribute, uint32_t i, const int64_t *bins, double step, const char *path,
                               adcgs_error *error)
{
    int good = 1;
    if (attribute == ADCGS_SPLAT4D_SCALE)
        good = set_scale(out, i, bins, step);
    else if (attribute == ADCGS_SPLAT4D_ROTATION)
        good = set_rotation(out, i, bins, step);
    for (int a = 0; a < 3 && attribute == ADCGS_SPLAT4D_MEAN; a++) {
        out->mean[a][i] = (float)((double)bins[a] * step);
        good &= isfinite(out->mean[a][i]);
    }
    for (int a = 0; a < 3 && attribute == ADCGS_SPLAT4D_COLOUR; a++)
        out->colour[a][i] = (float)(fmin(fmax((double)bins[a] * step, 0.0), LEVELS) / LEVELS);
    if (attribute == ADCGS_SPLAT4D_OPACITY)
        out->opacity[i] = (float)(fmin(fmax((double)bins[0] * step, 0.0), LEVELS) / LEVELS);
    return good ? ADCGS_OK
                : adcgs_fail(error, ADCGS_ERR_DATA, "%s: splat %u: %s beyond the range of numbers, or a rotation of length 0",
                             path, i, adcgs_splat4d_names[attribute]);
}

/* ---- The section ---- */

/** A set bit marks a splat whose attribute is constant. */
static adcgs_status read_mask(section *c, int attribute)
{
    adcgs_splat4d *const s = c->s;
    uint8_t *mask;
    int width;
    uint32_t n = 0;
    ADCGS_TRY(next_stream(&mask, &width, c, attribute, ((uint64_t)s->n + 7) / 8, 1));
    for (uint32_t i = 0; i < s->n; i++)
        n += !(mask[i / 8] >> (7 - i % 8) & 1);
    uint32_t *const list = s->moving[attribute] = malloc(n * sizeof *list + !n);
    for (uint32_t i = 0, k = 0; i < s->n && list; i++)
        if (!(mask[i / 8] >> (7 - i % 8) & 1))
            list[k++] = i;
    s->n_moving[attribute] = n;
    free(mask);
    return list ? ADCGS_OK : adcgs_fail(c->error, ADCGS_ERR_MEMORY, "%s: out of memory for %u splats", s->path, n);
}

/** Positions and scales are differences to the splat before, the others bytes. */
static adcgs_status read_base(section *c, int attribute, int is_difference, double step)
{
    adcgs_splat4d *const s = c->s;
    const int channels = adcgs_splat4d_channels[attribute];
    const uint64_t elements = (uint64_t)s->n * (uint64_t)channels;
    const int64_t shift = attribute == ADCGS_SPLAT4D_ROTATION ? -(int64_t)TURN_UNIT : 0;
    adcgs_status status = ADCGS_OK;
    int64_t bins[4] = {0};
    uint8_t *planes;
    int width;
    ADCGS_TRY(next_stream(&planes, &width, c, attribute, elements, is_difference ? 0 : 1));
    for (uint32_t i = 0; i < s->n && status == ADCGS_OK; i++) {
        for (int a = 0; a < channels; a++) {
            const uint32_t symbol = adcgs_planes_symbol(planes, elements, (uint64_t)i * (uint64_t)channels + (uint64_t)a, width);
            bins[a] = is_difference ? bins[a] + adcgs_zigzag(symbol) : (int64_t)symbol + shift;
        }
        status = adcgs_splat4d_set(&s->base, attribute, i, bins, step, s->path, c->error);
    }
    free(planes);
    return status;
}

adcgs_status adcgs_splat4d_base(adcgs_splat4d *s, adcgs_error *error)
{
    const uint8_t *const begin = s->data + s->base_offset;
    section c = {s, begin, begin + s->base_bytes, error};
    ADCGS_TRY(adcgs_splats_alloc(&s->base, s->n, s->path, error));
    for (int a = 0; a < ADCGS_SPLAT4D_ATTRIBUTES; a++)
        ADCGS_TRY(read_mask(&c, a));
    ADCGS_TRY(read_base(&c, ADCGS_SPLAT4D_MEAN, 1, s->base_mean));
    ADCGS_TRY(read_base(&c, ADCGS_SPLAT4D_SCALE, 1, s->base_scale));
    ADCGS_TRY(read_base(&c, ADCGS_SPLAT4D_COLOUR, 0, 1.0));
    ADCGS_TRY(read_base(&c, ADCGS_SPLAT4D_OPACITY, 0, 1.0));
    return read_base(&c, ADCGS_SPLAT4D_ROTATION, 0, 1.0);
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Decoding of the streams of a .4dgs file: unpacked planes, zigzag, and differences along the order. */
#include "config.h"

#include "media/dynamic/fourdgs_streams.h"

#include <stdio.h>
#include <stdlib.h>

/* Origin: definition (.4dgs). */
enum { RAW, DIFFERENCES, CONSTANT }; /* modes of a stream */
enum { DEFLATE, ZSTD };              /* its codecs */

const char *const adcgs_fourdgs_names[ADCGS_FOURDGS_ATTRIBUTES] = {"positions", "scales",  "omitted components",
                                                                   "rotations", "colours", "opacities",
                                                                   "motions",   "centres", "sigmas",
                                                                   "flags",     "windows", "groups",
                                                                   "indices",   "ids",     "objects"};
const int adcgs_fourdgs_channels[ADCGS_FOURDGS_ATTRIBUTES] = {3, 3, 1, 3, 3, 1, 3, 1, 1, 1, 1, 1, 1, 1, 1};
const int adcgs_fourdgs_places[ADCGS_FOURDGS_ATTRIBUTES] = {ADCGS_FOURDGS_ROW_POSITION,
                                                            ADCGS_FOURDGS_ROW_SCALE,
                                                            ADCGS_FOURDGS_ROW_OMITTED,
                                                            ADCGS_FOURDGS_ROW_ROTATION,
                                                            ADCGS_FOURDGS_ROW_COLOUR,
                                                            ADCGS_FOURDGS_ROW_OPACITY,
                                                            ADCGS_FOURDGS_ROW_MOTION,
                                                            ADCGS_FOURDGS_ROW_CENTRE,
                                                            ADCGS_FOURDGS_ROW_SIGMA,
                                                            ADCGS_FOURDGS_ROW_FLAGS,
                                                            ADCGS_FOURDGS_ROW_WINDOW,
                                                            -1,
                                                            -1,
                                                            ADCGS_FOURDGS_ROW_ID,
                                                            ADCGS_FOURDGS_ROW_OBJECT};

/** Header and data of a stream. */
typedef struct stream {
    int attribute, width, mode, codec, channels;
    uint32_t elements;
    uint64_t bytes;
    const uint8_t *data;
} stream;

/** Place of a stream, for messages. */
typedef struct place {
    const char *path, *where, *name;
    adcgs_error *error;
} place;

static adcgs_status read_stream(stream *t, adcgs_byte_cursor *c, const char *path, const char *where, adcgs_error *error)
{
    t->attribute = adcgs_cursor_u8(c);
    t->width = adcgs_cursor_u8(c);
    t->mode = adcgs_cursor_u8(c);
    t->codec = adcgs_cursor_u8(c);
    t->channels = adcgs_cursor_u8(c);
    t->elements = adcgs_cursor_u32(c);
    t->bytes = adcgs_cursor_u64(c);
    t->data = adcgs_cursor_bytes(c, t->bytes);
    return c->failed
               ? adcgs_fail(error, ADCGS_ERR_DATA, "%s: .4dgs: %s ends in a stream of attribute %d", path, where, t->attribute)
               : ADCGS_OK;
}

static adcgs_status check_stream(const stream *t, uint32_t n, int channels, const place *p)
{
    if (t->elements != n || t->channels != channels)
        return adcgs_fail(p->error, ADCGS_ERR_DATA, "%s: .4dgs: %s of %s: %u of %d components, expected %u of %d", p->path,
                          p->name, p->where, t->elements, t->channels, n, channels);
    if (t->codec > ZSTD)
        return adcgs_fail(p->error, ADCGS_ERR_UNSUPPORTED, "%s: .4dgs: %s of %s: codec %d, expected 0 (deflate) or 1 (zstd)",
                          p->path, p->name, p->where, t->codec);
    if (t->mode > CONSTANT || (t->width != 1 && t->width != 2 && t->width != 4))
        return adcgs_fail(p->error, ADCGS_ERR_DATA,
                          "%s: .4dgs: %s of %s: mode %d with symbols of %d bytes, expected 0 to 2 with 1, 2 or 4", p->path,
                          p->name, p->where, t->mode, t->width);
    return ADCGS_OK;
}

static adcgs_status add_differences(int32_t *values, uint64_t count, uint64_t channels, const place *p)
{
    for (uint64_t i = channels; i < count; i++) {
        const int64_t sum = (int64_t)values[i] + values[i - channels];
        if (sum != (int32_t)sum)
            return adcgs_fail(p->error, ADCGS_ERR_DATA, "%s: .4dgs: %s of %s: element %llu leaves 32 bits", p->path, p->name,
                              p->where, (unsigned long long)(i / channels));
        values[i] = (int32_t)sum;
    }
    return ADCGS_OK;
}

/** Decode a stream that check_stream() accepts. The element count bounds memory, and a chunk's bytes bound it. */
static adcgs_status decode_stream(adcgs_fourdgs_column *out, const stream *t, const place *p)
{
    const uint64_t channels = (uint64_t)t->channels, count = t->mode == CONSTANT ? channels : t->elements * channels;
    const adcgs_packed packed = {t->data, t->bytes, count * (uint64_t)t->width,
                                 t->codec == ZSTD ? ADCGS_PACKED_ZSTD : ADCGS_PACKED_ZLIB};
    char what[96];
    uint8_t *planes;
    snprintf(what, sizeof what, "%s of %s", p->name, p->where);
    ADCGS_TRY(adcgs_planes_unpack(&planes, &packed, p->path, what, p->error));
    out->values = malloc(count * sizeof *out->values + !count);
    out->stride = t->mode == CONSTANT ? 0 : (uint32_t)channels;
    for (uint64_t i = 0; i < count && out->values; i++)
        out->values[i] = adcgs_zigzag(adcgs_planes_symbol(planes, count, i, t->width));
    free(planes);
    if (!out->values)
        return adcgs_fail(p->error, ADCGS_ERR_MEMORY, "%s: out of memory for %s", p->path, what);
    return t->mode == DIFFERENCES ? add_differences(out->values, count, channels, p) : ADCGS_OK;
}

adcgs_status adcgs_fourdgs_columns_read(adcgs_fourdgs_columns *out, adcgs_byte_cursor block, uint32_t n, int wanted, int required,
                                        const char *path, const char *where, adcgs_error *error)
{
    *out = (adcgs_fourdgs_columns){.n = n};
    while (block.at < block.end) {
        stream t;
        ADCGS_TRY(read_stream(&t, &block, path, where, error));
        if (t.attribute >= ADCGS_FOURDGS_ATTRIBUTES || !(wanted >> t.attribute & 1))
            continue;
        const place p = {path, where, adcgs_fourdgs_names[t.attribute], error};
        adcgs_fourdgs_column *const column = &out->column[t.attribute];
        if (column->values)
            return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .4dgs: two streams of %s in %s", path, p.name, where);
        ADCGS_TRY(check_stream(&t, n, adcgs_fourdgs_channels[t.attribute], &p));
        ADCGS_TRY(decode_stream(column, &t, &p));
    }
    for (int a = 0; a < ADCGS_FOURDGS_ATTRIBUTES; a++)
        if (required >> a & 1 && !out->column[a].values)
            return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .4dgs: %s has no %s", path, where, adcgs_fourdgs_names[a]);
    return ADCGS_OK;
}

void adcgs_fourdgs_columns_free(adcgs_fourdgs_columns *columns)
{
    for (int a = 0; a < ADCGS_FOURDGS_ATTRIBUTES; a++)
        free(columns->column[a].values);
    *columns = (adcgs_fourdgs_columns){0};
}

void adcgs_fourdgs_row(int32_t row[ADCGS_FOURDGS_ROW], const adcgs_fourdgs_columns *columns, uint32_t i)
{
    memset(row, 0, ADCGS_FOURDGS_ROW * sizeof *row);
    for (int a = 0; a < ADCGS_FOURDGS_ATTRIBUTES; a++) {
        const adcgs_fourdgs_column *const from = &columns->column[a];
        for (int c = 0; c < adcgs_fourdgs_channels[a] && from->values; c++)
            row[adcgs_fourdgs_places[a] + c] = from->values[(size_t)i * from->stride + (size_t)c];
    }
}

adcgs_status adcgs_fourdgs_block(uint8_t **block, const adcgs_fourdgs_chunk *chunk, const char *path, const char *where,
                                 adcgs_error *error)
{
    char what[64];
    snprintf(what, sizeof what, "streams of %s", where);
    return adcgs_planes_unpack(block, &chunk->streams, path, what, error);
}

/* ---- Harmonics ---- */

/** Red, green and blue of a band follow each other; the splats' array has all bands of a channel together. */
static adcgs_status place_band(uint8_t *out, const adcgs_fourdgs_column *from, uint32_t n, int band, size_t per, const place *p)
{
    const size_t in_band = 2 * (size_t)band + 1, before = adcgs_fourdgs_coefficients(band - 1);
    for (uint32_t i = 0; i < n; i++)
        for (size_t k = 0; k < 3 * in_band; k++) {
            const int32_t value = from->values[(size_t)i * from->stride + k];
            if (value < 0 || value > UINT8_MAX)
                return adcgs_fail(p->error, ADCGS_ERR_DATA, "%s: .4dgs: %s of %s: %d, expected a byte", p->path, p->name,
                                  p->where, value);
            out[(3 * (size_t)i + k / in_band) * per + before + k % in_band] = (uint8_t)value;
        }
    return ADCGS_OK;
}

adcgs_status adcgs_fourdgs_bands_read(uint8_t *out, const adcgs_fourdgs_chunk *chunk, int degree, const char *path,
                                      const char *where, adcgs_error *error)
{
    static const char *const names[ADCGS_FOURDGS_BANDS] = {"band 1", "band 2", "band 3"};
    for (int band = 1; band <= degree; band++) {
        const adcgs_fourdgs_range *const range = &chunk->bands[band - 1];
        const place p = {path, where, names[band - 1], error};
        adcgs_fourdgs_column column = {NULL, 0};
        stream t;
        if (!range->data)
            return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .4dgs: %s has no %s of %d", path, where, p.name, degree);
        adcgs_byte_cursor c = {range->data, range->data + range->bytes, 0};
        ADCGS_TRY(read_stream(&t, &c, path, where, error));
        ADCGS_TRY(check_stream(&t, chunk->n, 3 * (2 * band + 1), &p));
        adcgs_status status = decode_stream(&column, &t, &p);
        if (status == ADCGS_OK)
            status = place_band(out, &column, chunk->n, band, adcgs_fourdgs_coefficients(degree), &p);
        free(column.values);
        ADCGS_TRY(status);
    }
    return ADCGS_OK;
}

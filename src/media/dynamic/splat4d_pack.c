/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The body of a written .splat4d: masks and the first frame, then groups of frames as bins and differences. */
#include "config.h"

#include "media/dynamic/splat4d_pack.h"

#ifdef HAVE_SPZ

#include <math.h>
#include <stdlib.h>
#include <zstd.h>

/* Origin, unless a line states one: definition (.splat4d's code and FORMAT.md). */
#define STREAM_HEADER 11 /* bytes of a stream's header */
#define STATIC_KIND 2    /* kind of a stream of the static section */
#define LEVEL 12         /* zstd's level; chosen by hand, not measured */

typedef adcgs_splat4d_writer writer;

typedef struct stream {
    uint8_t header[STREAM_HEADER];
    uint8_t *data;
    size_t bytes, unpacked;
} stream;

/* ---- Streams ---- */

double adcgs_splat4d_value(const adcgs_splat4d_writer *w, int attribute, uint32_t frame, uint32_t i, int c)
{
    const adcgs_splats *const s = &w->clip->frames[frame];
    switch (attribute) {
    case ADCGS_SPLAT4D_MEAN:
        return (double)s->mean[c][i];
    case ADCGS_SPLAT4D_ROTATION:
        return ADCGS_SPLAT4D_TURN * w->sign[(size_t)frame * w->n + i] * (double)s->rotation[c][i];
    case ADCGS_SPLAT4D_COLOUR:
        return ADCGS_SPLAT4D_LEVELS * fmin(fmax((double)s->colour[c][i], 0.0), 1.0);
    case ADCGS_SPLAT4D_OPACITY:
        return ADCGS_SPLAT4D_LEVELS * fmin(fmax((double)s->opacity[i], 0.0), 1.0);
    default:
        return log((double)s->scale[c][i]);
    }
}

static int32_t bin_of(const writer *w, int attribute, uint32_t frame, uint32_t i, int c)
{
    return (int32_t)floor(adcgs_splat4d_value(w, attribute, frame, i, c) / w->step[attribute] + 0.5);
}

static uint32_t fold(int32_t v)
{
    return (uint32_t)v << 1 ^ (v < 0 ? UINT32_MAX : 0);
}

/** Pack the first `elements` symbols. */
static adcgs_status pack(stream *out, writer *w, int attribute, int kind, uint64_t elements)
{
    uint32_t all = 0;
    for (uint64_t k = 0; k < elements; k++)
        all |= w->symbols[k];
    const int width = all < 1u << 8 ? 1 : all < 1u << 16 ? 2 : 4;
    const size_t bytes = (size_t)elements * (size_t)width, room = ZSTD_compressBound(bytes);
    if (bytes > ADCGS_PLANES_MAX)
        return adcgs_fail(w->error, ADCGS_ERR_UNSUPPORTED, "%s: %zu bytes of %s in a group of frames, expected at most %llu",
                          w->path, bytes, adcgs_splat4d_names[attribute], (unsigned long long)ADCGS_PLANES_MAX);
    for (int j = 0; j < width; j++)
        for (uint64_t k = 0; k < elements; k++)
            w->planes[(uint64_t)j * elements + k] = (uint8_t)(w->symbols[k] >> 8 * j);
    out->unpacked = bytes;
    out->data = malloc(room);
    out->bytes = out->data ? ZSTD_compress(out->data, room, w->planes, bytes, LEVEL) : 0;
    if (!out->data || ZSTD_isError(out->bytes)) /* the output has enough room, so this is an allocation failure */
        return adcgs_fail(w->error, ADCGS_ERR_MEMORY, "%s: out of memory", w->path);
    out->header[0] = (uint8_t)attribute;
    out->header[1] = (uint8_t)kind;
    out->header[2] = (uint8_t)width;
    adcgs_store_le32(out->header + 3, (uint32_t)elements);
    adcgs_store_le32(out->header + 7, (uint32_t)out->bytes);
    return ADCGS_OK;
}

static adcgs_status put_static(writer *w, int attribute, uint64_t elements)
{
    stream t = {.data = NULL};
    const adcgs_status status = pack(&t, w, attribute, STATIC_KIND, elements);
    if (status == ADCGS_OK) {
        fwrite(t.header, sizeof t.header, 1, w->body);
        fwrite(t.data, t.bytes, 1, w->body);
    }
    free(t.data);
    return status;
}

/** A set bit marks a splat whose attribute is static. */
static adcgs_status put_mask(writer *w, int attribute)
{
    const uint32_t bytes = (w->n + 7) / 8;
    memset(w->symbols, 0, bytes * sizeof *w->symbols);
    for (uint32_t i = 0; i < w->n; i++)
        if (!(w->mask[w->order[i]] >> attribute & 1))
            w->symbols[i / 8] |= 128u >> i % 8;
    return put_static(w, attribute, bytes);
}

/** The first frame: differences along the order, or bytes. */
static adcgs_status put_base(writer *w, int attribute)
{
    const int channels = adcgs_splat4d_channels[attribute];
    const int is_difference = attribute == ADCGS_SPLAT4D_MEAN || attribute == ADCGS_SPLAT4D_SCALE;
    const double shift = attribute == ADCGS_SPLAT4D_ROTATION ? ADCGS_SPLAT4D_TURN : 0.0;
    int32_t before[4] = {0};
    uint64_t k = 0;
    for (uint32_t i = 0; i < w->n; i++)
        for (int c = 0; c < channels; c++)
            if (is_difference) {
                const int32_t bin = bin_of(w, attribute, 0, w->order[i], c);
                w->symbols[k++] = fold(bin - before[c]);
                before[c] = bin;
            } else
                w->symbols[k++] =
                    (uint32_t)fmin(fmax(floor(adcgs_splat4d_value(w, attribute, 0, w->order[i], c) + shift + 0.5), 0.0),
                                   ADCGS_SPLAT4D_LEVELS);
    return put_static(w, attribute, k);
}

/** Symbols of frames first to last - 1: differences to the frame before, or bins. */
static uint64_t fill(writer *w, int attribute, int kind, uint32_t first, uint32_t last)
{
    uint64_t k = 0;
    for (uint32_t f = first; f < last; f++)
        for (uint32_t j = 0; j < w->n; j++) {
            const uint32_t i = w->order[j];
            for (int c = 0; w->mask[i] >> attribute & 1 && c < adcgs_splat4d_channels[attribute]; c++) {
                const int32_t bin = bin_of(w, attribute, f, i, c);
                w->symbols[k++] = fold(kind ? bin - bin_of(w, attribute, f - 1, i, c) : bin);
            }
        }
    return k;
}

static adcgs_status put_group(writer *w, uint32_t first, uint32_t last)
{
    stream streams[2 * ADCGS_SPLAT4D_ATTRIBUTES] = {{.data = NULL}};
    size_t n = 0, total = 0;
    uint8_t count[2];
    adcgs_status status = ADCGS_OK;
    for (int kind = 0; kind < 2; kind++)
        for (int a = 0; a < ADCGS_SPLAT4D_ATTRIBUTES && status == ADCGS_OK; a++)
            if (w->moving[a] && (!kind || last - first > 1))
                status = pack(&streams[n++], w, a, kind, fill(w, a, kind, first + (uint32_t)kind, kind ? last : first + 1));
    adcgs_store_le16(count, (uint16_t)n);
    fwrite(count, sizeof count, 1, w->body);
    for (size_t i = 0; i < n; i++)
        fwrite(streams[i].header, STREAM_HEADER, 1, w->body);
    for (size_t i = 0; i < n && status == ADCGS_OK; i++)
        fwrite(streams[i].data, streams[i].bytes, 1, w->body);
    for (size_t i = 0; i < n; i++) {
        total += streams[i].unpacked;
        free(streams[i].data);
    }
    if (status == ADCGS_OK && total > ADCGS_PLANES_MAX)
        return adcgs_fail(w->error, ADCGS_ERR_UNSUPPORTED, "%s: %zu bytes in a group of frames, expected at most %llu", w->path,
                          total, (unsigned long long)ADCGS_PLANES_MAX);
    return status;
}

adcgs_status adcgs_splat4d_body(adcgs_splat4d_writer *w)
{
    static const int order[] = {ADCGS_SPLAT4D_MEAN, ADCGS_SPLAT4D_SCALE, ADCGS_SPLAT4D_COLOUR, ADCGS_SPLAT4D_OPACITY,
                                ADCGS_SPLAT4D_ROTATION};
    size_t k = 0;
    for (int a = 0; a < ADCGS_SPLAT4D_ATTRIBUTES; a++)
        ADCGS_TRY(put_mask(w, a));
    for (int a = 0; a < ADCGS_SPLAT4D_ATTRIBUTES; a++)
        ADCGS_TRY(put_base(w, order[a]));
    for (uint32_t first = 0; first < w->clip->n_frames; first += w->group) {
        w->place[++k] = (uint64_t)ftello(w->body);
        ADCGS_TRY(put_group(w, first, ADCGS_MIN(first + w->group, w->clip->n_frames)));
    }
    w->place[++k] = (uint64_t)ftello(w->body);
    return ADCGS_OK;
}

#endif

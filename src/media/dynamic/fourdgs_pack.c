/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Bins of splats in the frames of a .4dgs file, and their streams, packed by zlib. */
#include "config.h"

#include "media/dynamic/fourdgs_pack.h"

#ifdef HAVE_SPZ

#include <math.h>
#include <zlib.h>

#define NEVER_FADES 1 /* flag of a splat; definition (.4dgs) */
#define LEVEL 9       /* zlib's level, the highest; chosen by hand, not measured */

typedef adcgs_fourdgs_writer writer;

/** Streams of a chunk. Those with a place are written from rows, the others are constant. */
static const struct {
    int attribute, channels, place, value;
} streams[] = {{ADCGS_FOURDGS_POSITION, 3, 0, 0},         {ADCGS_FOURDGS_SCALE, 3, 3, 0},   {ADCGS_FOURDGS_OMITTED, 1, 6, 0},
               {ADCGS_FOURDGS_ROTATION, 3, 7, 0},         {ADCGS_FOURDGS_COLOUR, 3, 10, 0}, {ADCGS_FOURDGS_OPACITY, 1, 13, 0},
               {ADCGS_FOURDGS_MOTION, 3, -1, 0},          {ADCGS_FOURDGS_CENTRE, 1, -1, 0}, {ADCGS_FOURDGS_SIGMA, 1, -1, 0},
               {ADCGS_FOURDGS_FLAGS, 1, -1, NEVER_FADES}, {ADCGS_FOURDGS_WINDOW, 1, -1, 0}};

/* ---- Bins ---- */

/** x y z w without the largest component, which is taken as positive. */
static void set_rotation(int32_t *row, const adcgs_splats *s, uint32_t i)
{
    double q[4];
    int omitted = 0;
    for (int a = 0; a < 4; a++) {
        q[a] = (double)s->rotation[(a + 1) % 4][i];
        omitted = fabs(q[a]) > fabs(q[omitted]) ? a : omitted;
    }
    row[0] = omitted;
    for (int a = 0, k = 1; a < 4; a++)
        if (a != omitted)
            row[k++] = (int32_t)rint((q[omitted] < 0.0 ? -q[a] : q[a]) / ADCGS_FOURDGS_STEP_ROTATION);
}

static void set_row(int32_t *row, const writer *w, uint32_t frame, uint32_t i)
{
    const adcgs_splats *const s = &w->clip->frames[frame];
    int32_t level[3];
    for (int a = 0; a < 3; a++) {
        row[a] = (int32_t)rint((double)s->mean[a][i] / w->step);
        row[3 + a] = (int32_t)rint(log((double)s->scale[a][i]) / ADCGS_FOURDGS_STEP_SCALE);
        level[a] = (int32_t)rint(fmin(fmax((double)s->colour[a][i], 0.0), 1.0) / ADCGS_FOURDGS_STEP_LEVEL);
    }
    set_rotation(row + 6, s, i);
    row[10] = level[1]; /* green; red and blue less green */
    row[11] = level[0] - level[1];
    row[12] = level[2] - level[1];
    row[13] = (int32_t)rint(fmin(fmax((double)s->opacity[i], 0.0), 1.0) / ADCGS_FOURDGS_STEP_LEVEL);
}

/* ---- Streams ---- */

static uint32_t fold(int32_t v)
{
    return (uint32_t)v << 1 ^ (v < 0 ? UINT32_MAX : 0);
}

/** Put `count` symbols as a stream of n elements. mode: 0 as they are, 1 differences along the order, 2 constant. */
static void put_stream(FILE *to, writer *w, int attribute, int mode, int channels, uint32_t n, size_t count)
{
    uint32_t all = 0;
    for (size_t k = count; k-- > 0;) {
        const int32_t before = mode == 1 && k >= (size_t)channels ? w->symbols[k - (size_t)channels] : 0;
        w->symbols[k] = (int32_t)fold(w->symbols[k] - before);
        all |= (uint32_t)w->symbols[k];
    }
    const int width = all < 1u << 8 ? 1 : all < 1u << 16 ? 2 : 4;
    for (int j = 0; j < width; j++)
        for (size_t k = 0; k < count; k++)
            w->planes[(size_t)j * count + k] = (uint8_t)((uint32_t)w->symbols[k] >> 8 * j);
    uLongf bytes = w->room;
    if (compress2(w->packed, &bytes, w->planes, (uLong)(count * (size_t)width), LEVEL) != Z_OK)
        w->failed = 1; /* the output has enough room, so this is an allocation failure */
    const int header[] = {attribute, width, mode, 0, channels};
    for (size_t i = 0; i < ADCGS_COUNTOF(header); i++)
        adcgs_put_u(to, (uint64_t)header[i], 1);
    adcgs_put_u(to, n, 4);
    adcgs_put_u(to, bytes, 8);
    fwrite(w->packed, bytes, 1, to);
}

static void put_ids(FILE *to, writer *w, uint32_t n)
{
    for (uint32_t k = 0; k < n; k++)
        w->symbols[k] = (int32_t)w->moved[k];
    put_stream(to, w, ADCGS_FOURDGS_ID, 1, 1, n, n);
}

static int is_replaced(int attribute)
{
    return attribute == ADCGS_FOURDGS_OMITTED || attribute == ADCGS_FOURDGS_ROTATION;
}

/** A stream of the chunk's n splats: of all in a keyframe, else differences, or new rotations. \return false: nothing changes */
static int fill(writer *w, size_t stream, uint32_t n, int is_delta)
{
    const int place = streams[stream].place, channels = streams[stream].channels;
    const int is_rotation = is_replaced(streams[stream].attribute), first = is_rotation ? 6 : place;
    const size_t bytes = (is_rotation ? 4 : (size_t)channels) * sizeof(int32_t); /* both streams of a rotation go together */
    int changes = !is_delta;
    for (uint32_t k = 0; k < n; k++) {
        const int32_t *const row = w->rows[1] + (size_t)ADCGS_FOURDGS_PLACES * w->moved[k], *const was =
                                                                                                w->rows[0] + (row - w->rows[1]);
        changes |= is_delta && memcmp(row + first, was + first, bytes) != 0;
        for (int c = 0; c < channels; c++)
            w->symbols[(size_t)k * (size_t)channels + (size_t)c] =
                row[place + c] - (is_delta && !is_rotation ? was[place + c] : 0);
    }
    return changes;
}

void adcgs_fourdgs_put_splats(FILE *to, adcgs_fourdgs_writer *w, uint32_t n, int is_delta)
{
    put_ids(to, w, n);
    for (size_t s = 0; s < ADCGS_COUNTOF(streams); s++) {
        const int channels = streams[s].channels;
        if (streams[s].place >= 0 && fill(w, s, n, is_delta))
            put_stream(to, w, streams[s].attribute, 0, channels, n, (size_t)n * (size_t)channels);
        else if (streams[s].place < 0 && !is_delta) {
            for (int c = 0; c < channels; c++)
                w->symbols[c] = streams[s].value;
            put_stream(to, w, streams[s].attribute, 2, channels, n, (size_t)channels);
        }
    }
}

/** The rows of a frame, and the splats that it changes, or all. */
uint32_t adcgs_fourdgs_next_rows(adcgs_fourdgs_writer *w, uint32_t frame, int is_delta)
{
    int32_t *const old = w->rows[0];
    uint32_t n = 0;
    w->rows[0] = w->rows[1];
    w->rows[1] = old;
    for (uint32_t i = 0; i < w->n; i++) {
        const size_t at = (size_t)ADCGS_FOURDGS_PLACES * i;
        set_row(w->rows[1] + at, w, frame, i);
        if (!is_delta || memcmp(w->rows[0] + at, w->rows[1] + at, ADCGS_FOURDGS_PLACES * sizeof(int32_t)) != 0)
            w->moved[n++] = i;
    }
    return n;
}

#endif

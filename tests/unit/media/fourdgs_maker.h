/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Makes small .4dgs files, valid or with faults. */
#ifndef ADCGS_TESTS_MEDIA_FOURDGS_MAKER_H
#define ADCGS_TESTS_MEDIA_FOURDGS_MAKER_H

#include "outside_files.h"

#include "media/dynamic/dynamic_splats.h"

#include <zlib.h>
#include <zstd.h>

enum { ROOM = 1 << 19, SPLATS = 7000 }; /* bytes of a file; splats of a chunk, at most */

typedef struct maker {
    uint8_t bytes[ROOM];
    size_t n, record;    /* record: begin of the open one */
    int codec;           /* of streams: 0 deflate, 1 zstd */
    const char *packing; /* of chunks: "", "deflate", "zstd" */
} maker;

/** A splat in bins. Attributes without a member are constant: scale 0, no rotation, colour 10 20 30 in halves of the step. */
typedef struct made_splat {
    uint32_t id;
    int32_t position[3], motion, centre, sigma, flags, window, opacity;
    uint32_t object;
} made_splat;

static inline void put_u(maker *m, uint64_t value, int bytes)
{
    assert_true(m->n + 8 < ROOM);
    for (int i = 0; i < bytes; i++)
        m->bytes[m->n++] = (uint8_t)(value >> 8 * i);
}

static inline void put_f64(maker *m, double value)
{
    put_u(m, adcgs_double_bits(value), 8);
}

static inline void put_raw(maker *m, const void *data, size_t n)
{
    assert_true(m->n + n < ROOM);
    memcpy(m->bytes + m->n, data, n);
    m->n += n;
}

static inline void put_string(maker *m, const char *text)
{
    put_u(m, strlen(text), 4);
    put_raw(m, text, strlen(text));
}

static inline void begin_record(maker *m, int opcode)
{
    m->record = m->n;
    put_u(m, (uint64_t)opcode, 1);
    put_u(m, 0, 8);
}

static inline void end_record(maker *m)
{
    adcgs_store_le64(m->bytes + m->record + 1, m->n - m->record - 9);
}

/** Pack bytes as a codec of streams does. */
static inline size_t pack(uint8_t *out, size_t room, const uint8_t *data, size_t n, int codec)
{
    uLongf packed = room;
    if (codec)
        return ZSTD_compress(out, room, data, n, 3);
    assert_int_equal(compress2(out, &packed, data, n, 6), Z_OK);
    return packed;
}

/** Symbols of 4 bytes in planes; mode 1: differences. */
static inline void put_stream(maker *m, int attribute, int mode, int channels, uint32_t n, const int32_t *values,
                              uint32_t symbols)
{
    uint8_t *const planes = calloc(4, symbols + 1), *const packed = malloc(8 * symbols + 1024);
    for (uint32_t i = 0; i < symbols; i++) {
        const int32_t v = mode == 1 && i >= (uint32_t)channels ? values[i] - values[i - (uint32_t)channels] : values[i];
        const uint32_t u = (uint32_t)v << 1 ^ (v < 0 ? UINT32_MAX : 0);
        for (uint32_t j = 0; j < 4; j++)
            planes[j * symbols + i] = (uint8_t)(u >> 8 * j);
    }
    const size_t bytes = pack(packed, 8 * symbols + 1024, planes, (size_t)4 * symbols, m->codec);
    const int header[] = {attribute, 4, mode, m->codec, channels};
    for (int i = 0; i < 5; i++)
        put_u(m, (uint64_t)header[i], 1);
    put_u(m, n, 4);
    put_u(m, bytes, 8);
    put_raw(m, packed, bytes);
    free(planes);
    free(packed);
}

static inline void put_constant(maker *m, int attribute, int channels, uint32_t n, int32_t a, int32_t b, int32_t c)
{
    put_stream(m, attribute, 2, channels, n, (const int32_t[]){a, b, c}, (uint32_t)channels);
}

/** One member of all splats as a stream. */
static inline void put_members(maker *m, int attribute, int mode, uint32_t n, const made_splat *s, size_t member, int channels)
{
    static int32_t values[3 * SPLATS];
    assert_true(n <= SPLATS);
    for (uint32_t i = 0; i < n; i++)
        memcpy(values + (size_t)channels * i, (const uint8_t *)&s[i] + member, (size_t)channels * 4);
    put_stream(m, attribute, mode, channels, n, values, (uint32_t)channels * n);
}

#define PUT_MEMBER(m, attribute, mode, n, s, member) put_members(m, attribute, mode, n, s, offsetof(made_splat, member), 1)

/** All attributes of complete splats. */
static inline void put_splats(maker *m, uint32_t n, const made_splat *s, int has_ids)
{
    static int32_t motions[3 * SPLATS];
    for (uint32_t i = 0; i < n; i++)
        motions[3 * i] = s[i].motion;
    put_members(m, 0, 0, n, s, offsetof(made_splat, position), 3);
    put_constant(m, 1, 3, n, 0, 0, 0);
    put_constant(m, 2, 1, n, 3, 0, 0);
    put_constant(m, 3, 3, n, 0, 0, 0);
    put_constant(m, 4, 3, n, 20, -10, 10);
    PUT_MEMBER(m, 5, 0, n, s, opacity);
    put_stream(m, 6, 0, 3, n, motions, 3 * n);
    PUT_MEMBER(m, 7, 0, n, s, centre);
    PUT_MEMBER(m, 8, 0, n, s, sigma);
    PUT_MEMBER(m, 9, 0, n, s, flags);
    PUT_MEMBER(m, 10, 0, n, s, window);
    if (has_ids)
        PUT_MEMBER(m, 13, 1, n, s, id);
    PUT_MEMBER(m, 14, 0, n, s, object);
}

/** Magic, header, and quantization with steps of 0.01 (position), 1/4 s (time) and the like. */
static inline void begin_file(maker *m, const char *model, uint64_t count, double duration, int degree, const double origin[3])
{
    static const double steps[] = {0.01, 0.1, 0.01, 0.02, 0.02, 0.02, 0.25, 0.1};
    static const double nowhere[3];
    origin = origin ? origin : nowhere;
    m->n = 0;
    put_raw(m,
            "\x89"
            "4DGS1\r\n",
            8);
    begin_record(m, 1);
    put_string(m, "");
    put_string(m, "test");
    put_f64(m, duration);
    put_u(m, count, 8);
    put_f64(m, 0.05);
    put_string(m, model);
    for (int i = 0; i < 6; i++)
        put_f64(m, origin[i % 3] + i / 3);
    put_u(m, (uint64_t)degree, 1);
    put_u(m, 2, 1);
    put_u(m, 0, 4);
    end_record(m);
    begin_record(m, 3);
    put_string(m, "uniform-v1");
    for (int a = 0; a < 3; a++)
        put_f64(m, origin[a]);
    for (size_t i = 0; i < 8; i++)
        put_f64(m, steps[i]);
    put_u(m, 1, 1);
    put_u(m, 0, 4);
    end_record(m);
}

/** Windows of equal lengths from 0 on. */
static inline void put_windows(maker *m, uint32_t n, double length)
{
    begin_record(m, 4);
    put_u(m, n, 4);
    for (uint32_t i = 0; i < n; i++) {
        put_f64(m, i * length);
        put_f64(m, (i + 1) * length);
    }
    end_record(m);
}

/** The open record is a chunk: pack its block of streams, which begins at `from`, and close it. */
static inline void end_block(maker *m, size_t from)
{
    static uint8_t block[ROOM], packed[2 * ROOM];
    const size_t n = m->n - from;
    memcpy(block, m->bytes + from, n);
    m->n = from;
    const int is_packed = *m->packing != 0;
    const size_t bytes = is_packed ? pack(packed, sizeof packed, block, n, strcmp(m->packing, "zstd") == 0) : n;
    put_string(m, m->packing);
    put_u(m, n, 8);
    put_u(m, bytes, 8);
    put_raw(m, is_packed ? packed : block, bytes);
    end_record(m);
}

static inline uint64_t put_chunk(maker *m, double begin, double end, uint32_t n, const made_splat *s, int has_ids)
{
    begin_record(m, 5);
    const uint64_t offset = m->record;
    put_f64(m, begin);
    put_f64(m, end);
    put_u(m, 0, 4);
    put_u(m, n, 4);
    const size_t from = m->n;
    put_splats(m, n, s, has_ids);
    end_block(m, from);
    return offset;
}

/** Groups of a chunk of changes. Updates change positions, by differences. */
typedef struct made_change {
    double begin, end;
    uint64_t reference, keyframe;
    uint32_t depth, n_updates, n_births, n_deaths;
    const made_splat *updates, *births, *deaths;
    int forbidden; /**< an attribute that updates must not have; 0: none */
} made_change;

static inline size_t begin_group(maker *m)
{
    put_u(m, 0, 8);
    return m->n;
}

static inline void end_group(maker *m, size_t from)
{
    adcgs_store_le64(m->bytes + from - 8, m->n - from);
}

static inline uint64_t put_change(maker *m, const made_change *c)
{
    begin_record(m, 0x10);
    const uint64_t offset = m->record;
    put_f64(m, c->begin);
    put_f64(m, c->end);
    put_u(m, 0, 4);
    put_u(m, 1, 1);
    put_u(m, c->reference, 8);
    put_u(m, c->keyframe, 8);
    put_u(m, c->depth, 2);
    put_u(m, c->n_updates, 4);
    put_u(m, c->n_births, 4);
    put_u(m, c->n_deaths, 4);
    const size_t block = m->n;
    size_t from = begin_group(m);
    if (c->n_updates) {
        PUT_MEMBER(m, 13, 0, c->n_updates, c->updates, id);
        put_members(m, 0, 0, c->n_updates, c->updates, offsetof(made_splat, position), 3);
        if (c->forbidden)
            put_constant(m, c->forbidden, 1, c->n_updates, 0, 0, 0);
    }
    end_group(m, from);
    from = begin_group(m);
    if (c->n_births)
        put_splats(m, c->n_births, c->births, 1);
    end_group(m, from);
    from = begin_group(m);
    if (c->n_deaths)
        PUT_MEMBER(m, 13, 1, c->n_deaths, c->deaths, id);
    end_group(m, from);
    end_block(m, block);
    return offset;
}

/** Harmonics of degree 1: coefficient j of splat i is first + 9 i + j, modulo 256. */
static inline void put_band(maker *m, uint32_t n, int first)
{
    static int32_t values[9 * SPLATS];
    for (uint32_t i = 0; i < 9 * n; i++)
        values[i] = (int32_t)((uint32_t)first + i) & 255;
    begin_record(m, 7);
    put_u(m, 1, 1);
    put_stream(m, 7, 0, 9, n, values, 9 * n);
    end_record(m);
}

/** A track of one object that shifts by x from 0 to 1 second. */
static inline void put_track(maker *m, uint32_t object, double x)
{
    begin_record(m, 0x25);
    put_u(m, object, 4);
    put_u(m, 0, 1);
    put_u(m, 2, 4);
    for (int i = 0; i < 2; i++) {
        put_f64(m, i);
        for (int a = 0; a < 4; a++)
            put_f64(m, a == 3);
        put_f64(m, i * x);
        put_f64(m, 0.0);
        put_f64(m, 0.0);
    }
    end_record(m);
}

static inline void end_file(maker *m)
{
    begin_record(m, 2);
    put_u(m, 0, 8);
    put_u(m, 0, 8);
    put_u(m, 0, 4);
    end_record(m);
    put_raw(m,
            "\x89"
            "4DGS1\r\n",
            8);
}

/* ---- Reading ---- */

static maker made; /* the file of the tests */

static inline adcgs_dynamic *parse_made(const adcgs_dynamic_options *options)
{
    adcgs_dynamic *d;
    end_file(&made);
    if (adcgs_dynamic_parse(&d, made.bytes, made.n, "made", options, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    return d;
}

static inline void refuse_made(adcgs_status status, const char *first, const char *second)
{
    adcgs_dynamic *d;
    end_file(&made);
    expect_error(adcgs_dynamic_parse(&d, made.bytes, made.n, "made", NULL, &error), status, first, second);
    assert_null(d);
}

static inline adcgs_splats splats_at(const adcgs_dynamic *d, double seconds)
{
    adcgs_splats s;
    if (adcgs_dynamic_at(d, seconds, &s, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    return s;
}

static inline uint32_t count_visible(const adcgs_splats *s)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < s->n; i++)
        n += s->opacity[i] > 0.0f;
    return n;
}

#endif

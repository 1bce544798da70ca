/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Splats from SPZ. Its columns are unpacked one after the other; the header and
 * the file's length bound their memory.
 */
#include "config.h"

#include "media/splats/spz.h"
#include "system/zip.h"

int adcgs_spz_is(const uint8_t *data, size_t bytes)
{
    return (bytes >= 4 && !memcmp(data, "NGSP", 4)) || (bytes >= 2 && data[0] == 0x1f && data[1] == 0x8b);
}

#ifdef HAVE_SPZ

#include <math.h>
#include <stdlib.h>
#define ZLIB_CONST /* zlib's input is const */
#include <zlib.h>
#include <zstd.h>

/* Origin, unless a line states one: definition (SPZ, whose text spz.h names). */
#define ZSTD_RATIO ((uint64_t)1 << 17) /* above zstd's ratio: a block of 128 KiB takes four bytes; RFC 8878, arithmetic */
#define INPUT_PART ((size_t)1 << 30)   /* bytes passed to zlib at once; chosen by hand, not measured */
#define FRACTION_MAX 30                /* fractional bits accepted in a header; chosen by hand, not measured */
#define HAS_EXTENSIONS 2               /* flag of a header */
#define AXES_EXTENSION 0xadbe0003u     /* type of the extension that declares the axes */
#define AXES_RIGHT_UP_BACK 4u          /* 0 means unspecified, which is treated the same */

static const char *const names[ADCGS_SPZ_COLUMNS] = {"positions", "opacities", "colours", "scales", "rotations", "harmonics"};

typedef struct reader {
    const char *path;
    adcgs_error *error;
    uint32_t version, n;
    int degree, fraction_bits, antialiased;
    size_t sizes[ADCGS_SPZ_COLUMNS];
    uint8_t *column;                 /**< the current column; has room for the largest */
    z_stream gzip;                   /**< of versions 2 and 3 */
    const uint8_t *entry, *at, *end; /**< of version 4: the next column's table entry and stream, the file's end */
} reader;

/* ---- Unpacking ---- */

/**
 * Inflate until `bytes` bytes are present, fewer than 2^32 (a column of ADCGS_SPLATS_MAX splats has fewer), or the input ends.
 * \return zlib's result
 */
static int inflate_into(reader *r, uint8_t *out, size_t bytes)
{
    int result = Z_OK;
    r->gzip.next_out = out;
    r->gzip.avail_out = (uInt)bytes;
    while (result == Z_OK && r->gzip.avail_out) {
        const size_t left = (size_t)(r->end - r->at);
        if (!r->gzip.avail_in) {
            r->gzip.next_in = r->at;
            r->gzip.avail_in = (uInt)(left < INPUT_PART ? left : INPUT_PART);
            r->at += r->gzip.avail_in;
        }
        result = inflate(&r->gzip, Z_NO_FLUSH);
    }
    return result;
}

static adcgs_status inflate_some(reader *r, uint8_t *out, size_t bytes, const char *what)
{
    const int result = inflate_into(r, out, bytes);
    if (!r->gzip.avail_out)
        return ADCGS_OK;
    if (result == Z_MEM_ERROR)
        return adcgs_fail(r->error, ADCGS_ERR_MEMORY, "%s: out of memory", r->path);
    return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: SPZ's %s: %s, %u bytes early", r->path, what,
                      result == Z_STREAM_END || result == Z_BUF_ERROR ? "the data end" : "gzip's data are damaged",
                      r->gzip.avail_out);
}

/** Check gzip's checksum, which follows the last column, except if vendor data come before it. */
static adcgs_status check_end(reader *r, size_t room)
{
    return inflate_into(r, r->column, room) == Z_DATA_ERROR
               ? adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: SPZ: gzip's checksum does not match", r->path)
               : ADCGS_OK;
}

/** Unpack the next stream of version 4; check_table() has checked its sizes. */
static adcgs_status unpack_stream(reader *r, adcgs_spz_column c)
{
    const uint64_t packed = adcgs_load_le64(r->entry);
    const size_t got = ZSTD_decompress(r->column, r->sizes[c], r->at, (size_t)packed);
    if (ZSTD_isError(got))
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: SPZ's %s: damaged zstd stream: %s", r->path, names[c],
                          ZSTD_getErrorName(got));
    if (got != r->sizes[c])
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: SPZ's %s: %zu bytes, expected %zu", r->path, names[c], got, r->sizes[c]);
    r->entry += ADCGS_SPZ_ENTRY;
    r->at += packed;
    return ADCGS_OK;
}

static adcgs_status next_column(reader *r, adcgs_spz_column c)
{
    return r->version < 4 ? inflate_some(r, r->column, r->sizes[c], names[c]) : unpack_stream(r, c);
}

/* ---- Headers ---- */

/** Read the fields that both headers have in the same places. */
static adcgs_status take_header(reader *r, const uint8_t *header)
{
    r->version = adcgs_load_le32(header + 4);
    r->n = adcgs_load_le32(header + 8);
    r->degree = header[12];
    r->fraction_bits = header[13];
    r->antialiased = header[14] & ADCGS_SPZ_ANTIALIASED;
    if (!r->n)
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: no splats", r->path);
    if (r->n > ADCGS_SPLATS_MAX)
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: %u splats, expected at most %u", r->path, r->n, ADCGS_SPLATS_MAX);
    if (r->degree == 4)
        return adcgs_fail(r->error, ADCGS_ERR_UNSUPPORTED, "%s: harmonics of degree 4, expected at most 3", r->path);
    if (r->degree > ADCGS_SPLATS_DEGREE_MAX)
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: harmonics of degree %d, expected 0 to 3", r->path, r->degree);
    if (r->fraction_bits > FRACTION_MAX)
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: %d fractional bits, expected at most %d", r->path, r->fraction_bits,
                          FRACTION_MAX);
    const size_t n = r->n, per[ADCGS_SPZ_COLUMNS] =
                               {9, 1, 3, 3, r->version == 2 ? 3 : 4, 3 * (size_t)((r->degree + 1) * (r->degree + 1) - 1)};
    for (int c = 0; c < ADCGS_SPZ_COLUMNS; c++)
        r->sizes[c] = n * per[c];
    return ADCGS_OK;
}

static adcgs_status open_old(reader *r)
{
    uint8_t header[ADCGS_SPZ_OLD_HEADER];
    size_t total = 0;
    const size_t bytes = (size_t)(r->end - r->at);
    if (inflateInit2(&r->gzip, 16 + MAX_WBITS) != Z_OK)
        return adcgs_fail(r->error, ADCGS_ERR_MEMORY, "%s: out of memory", r->path);
    ADCGS_TRY(inflate_some(r, header, sizeof header, "header"));
    if (memcmp(header, "NGSP", 4))
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: the gzip data are not SPZ", r->path);
    r->version = adcgs_load_le32(header + 4);
    if (r->version == 1)
        return adcgs_fail(r->error, ADCGS_ERR_UNSUPPORTED, "%s: SPZ of version 1, expected 2 to 4", r->path);
    if (r->version != 2 && r->version != 3)
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: SPZ of version %u packed by gzip, expected 2 or 3", r->path, r->version);
    ADCGS_TRY(take_header(r, header));
    for (int c = 0; c < ADCGS_SPZ_COLUMNS; c++)
        total += r->sizes[c];
    if (total / ADCGS_DEFLATE_RATIO > bytes)
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: %u splats, but only %zu bytes", r->path, r->n, bytes);
    return ADCGS_OK;
}

/** Check the extensions: records of a type, a length, and that many bytes. Unknown ones are skipped. */
static adcgs_status check_extensions(const reader *r, const uint8_t *at, const uint8_t *end)
{
    while (end - at >= 8) {
        const uint32_t type = adcgs_load_le32(at), bytes = adcgs_load_le32(at + 4);
        at += 8;
        if (bytes > (size_t)(end - at))
            return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: SPZ's extension %#x: %u bytes, but %td follow", r->path, type, bytes,
                              end - at);
        const uint32_t axes = type == AXES_EXTENSION && bytes >= 4 ? adcgs_load_le32(at) : 0;
        if (axes && axes != AXES_RIGHT_UP_BACK)
            return adcgs_fail(r->error, ADCGS_ERR_UNSUPPORTED, "%s: SPZ with axes of the kind %u, expected right, up, back (4)",
                              r->path, axes);
        at += bytes;
    }
    return ADCGS_OK;
}

/** Check that the streams have the expected sizes and lie in the file. */
static adcgs_status check_table(reader *r, int n_streams)
{
    const int needed = ADCGS_SPZ_HARMONICS + (r->degree > 0);
    uint64_t left = (uint64_t)(r->end - r->at);
    if (n_streams < needed || n_streams > ADCGS_SPZ_COLUMNS)
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: %d streams of SPZ, expected %d", r->path, n_streams, needed);
    for (int c = 0; c < needed; c++) {
        const uint64_t packed = adcgs_load_le64(r->entry + ADCGS_SPZ_ENTRY * c);
        const uint64_t size = adcgs_load_le64(r->entry + ADCGS_SPZ_ENTRY * c + 8);
        if (size != r->sizes[c])
            return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: SPZ's %s: %llu bytes, expected %zu of %u splats", r->path, names[c],
                              (unsigned long long)size, r->sizes[c], r->n);
        if (packed > left || size / ZSTD_RATIO > packed)
            return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: SPZ's %s: a stream of %llu bytes, %llu follow", r->path, names[c],
                              (unsigned long long)packed, (unsigned long long)left);
        left -= packed;
    }
    return ADCGS_OK;
}

static adcgs_status open_new(reader *r)
{
    const uint8_t *const header = r->at;
    const size_t bytes = (size_t)(r->end - r->at);
    if (bytes < ADCGS_SPZ_HEADER)
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: SPZ ends in its header", r->path);
    const uint32_t version = adcgs_load_le32(header + 4);
    if (version != 4)
        return adcgs_fail(r->error, version > 4 ? ADCGS_ERR_UNSUPPORTED : ADCGS_ERR_DATA,
                          "%s: SPZ of version %u not packed by gzip, expected 4", r->path, version);
    ADCGS_TRY(take_header(r, header));
    const int n_streams = header[15];
    const uint32_t table = adcgs_load_le32(header + 16);
    const size_t table_bytes = (size_t)ADCGS_SPZ_ENTRY * (size_t)n_streams;
    if (table < ADCGS_SPZ_HEADER || table > bytes || table_bytes > bytes - table)
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: SPZ's table of %d streams at %u, expected it in %zu bytes", r->path,
                          n_streams, table, bytes);
    if (header[14] & HAS_EXTENSIONS)
        ADCGS_TRY(check_extensions(r, header + ADCGS_SPZ_HEADER, header + table));
    r->entry = header + table;
    r->at = r->entry + table_bytes;
    return check_table(r, n_streams);
}

/* ---- Columns ---- */

static void take_positions(const reader *r, adcgs_splats *s)
{
    const double unit = ldexp(1.0, -r->fraction_bits);
    for (size_t i = 0; i < (size_t)3 * r->n; i++) {
        const uint8_t *const at = r->column + 3 * i;
        const int32_t value = at[0] | at[1] << 8 | at[2] << 16;
        s->mean[i % 3][i / 3] = (float)(unit * (value < 0x800000 ? value : value - 0x1000000));
    }
}

static void take_opacities(const reader *r, adcgs_splats *s)
{
    for (uint32_t i = 0; i < r->n; i++)
        s->opacity[i] = (float)(r->column[i] / 255.0);
}

static void take_colours(const reader *r, adcgs_splats *s)
{
    for (size_t i = 0; i < (size_t)3 * r->n; i++)
        s->colour[i % 3][i / 3] = (float)(0.5 + ADCGS_SPLATS_DC * ((r->column[i] / 255.0 - 0.5) / ADCGS_SPZ_COLOUR));
}

static void take_scales(const reader *r, adcgs_splats *s)
{
    for (size_t i = 0; i < (size_t)3 * r->n; i++)
        s->scale[i % 3][i / 3] = (float)exp(r->column[i] / ADCGS_SPZ_SCALE_STEPS + ADCGS_SPZ_SCALE_MIN);
}

/** x, y, z as bytes; w is computed from length 1, and not negative. q: x y z w. */
static void rotation_of_three(double q[4], const uint8_t *at)
{
    double sum = 0.0;
    for (int a = 0; a < 3; a++) {
        q[a] = at[a] / 127.5 - 1.0;
        sum += q[a] * q[a];
    }
    q[3] = sqrt(fmax(0.0, 1.0 - sum));
}

/** The index of the largest of x y z w in two bits; then a sign and nine bits for each other component in order. */
static void rotation_of_smallest(double q[4], const uint8_t *at)
{
    uint32_t bits = adcgs_load_le32(at);
    const int largest = (int)(bits >> 30);
    double sum = 0.0;
    for (int a = 3; a >= 0; a--) {
        if (a == largest)
            continue;
        const double size = ADCGS_SPZ_SQRT_HALF * (bits & ADCGS_SPZ_ROTATION_MAX) / ADCGS_SPZ_ROTATION_MAX;
        q[a] = bits & (ADCGS_SPZ_ROTATION_MAX + 1) ? -size : size;
        sum += size * size;
        bits >>= 10;
    }
    q[largest] = sqrt(fmax(0.0, 1.0 - sum));
}

static void take_rotations(const reader *r, adcgs_splats *s)
{
    for (uint32_t i = 0; i < r->n; i++) {
        double q[4], length = 0.0;
        if (r->version == 2)
            rotation_of_three(q, r->column + (size_t)3 * i);
        else
            rotation_of_smallest(q, r->column + (size_t)4 * i);
        for (int a = 0; a < 4; a++)
            length += q[a] * q[a]; /* at least 1, except for rounding */
        for (int a = 0; a < 4; a++)
            s->rotation[(a + 1) % 4][i] = (float)(q[a] / sqrt(length));
    }
}

/** The file has red, green and blue of each coefficient in turn; our array has each channel's coefficients together. */
static void take_harmonics(const reader *r, adcgs_splats *s)
{
    const size_t per = r->sizes[ADCGS_SPZ_HARMONICS] / r->n;
    for (uint32_t i = 0; i < r->n; i++)
        for (size_t j = 0; j < per; j++)
            s->harmonics[i * per + j % 3 * (per / 3) + j / 3] = (float)((r->column[i * per + j] - 128.0) / 128.0);
}

static adcgs_status take_columns(reader *r, adcgs_splats *s)
{
    static void (*const takes[])(const reader *, adcgs_splats *) = {take_positions, take_opacities, take_colours,
                                                                    take_scales,    take_rotations, take_harmonics};
    for (int c = 0; c < ADCGS_SPZ_HARMONICS + (r->degree > 0); c++) {
        ADCGS_TRY(next_column(r, (adcgs_spz_column)c));
        takes[c](r, s);
    }
    return ADCGS_OK;
}

static adcgs_status read_columns(reader *r, adcgs_splats *out)
{
    size_t largest = 0;
    for (int c = 0; c < ADCGS_SPZ_COLUMNS; c++)
        largest = r->sizes[c] > largest ? r->sizes[c] : largest;
    ADCGS_TRY(adcgs_splats_alloc(out, r->n, r->path, r->error));
    out->axes = ADCGS_SPLATS_Y_UP;
    out->antialiased = r->antialiased;
    out->degree = r->degree;
    out->harmonics = r->degree ? malloc(r->sizes[ADCGS_SPZ_HARMONICS] * sizeof *out->harmonics) : NULL;
    r->column = malloc(largest);
    if (!r->column || (r->degree && !out->harmonics))
        return adcgs_fail(r->error, ADCGS_ERR_MEMORY, "%s: out of memory for %u splats", r->path, r->n);
    ADCGS_TRY(take_columns(r, out));
    return r->version < 4 ? check_end(r, largest) : ADCGS_OK;
}

adcgs_status adcgs_spz_parse(adcgs_splats *out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error)
{
    reader r = {.path = path, .error = error, .at = data, .end = data + bytes};
    const int is_old = data[0] == 0x1f;
    adcgs_status status = is_old ? open_old(&r) : open_new(&r);
    if (status == ADCGS_OK)
        status = read_columns(&r, out);
    if (is_old)
        inflateEnd(&r.gzip);
    free(r.column);
    return status;
}

#else

adcgs_status adcgs_spz_parse(adcgs_splats *out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: this build has no SPZ: it needs zlib and zstd", path);
}

#endif

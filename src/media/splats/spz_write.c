/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Writing splats as SPZ of the versions 2 to 4. */
#include "config.h"

#include "media/splats/spz.h"

#ifdef HAVE_SPZ

#include <math.h>
#include <stdlib.h>
#define ZLIB_CONST /* zlib's input is const */
#include <zlib.h>
#include <zstd.h>

#define COLUMNS ADCGS_SPZ_HARMONICS /* harmonics are not written */
#define FRACTION_MAX 23             /* fractional bits of a position, all but its sign; arithmetic */
#define POSITION_MAX 8388607.0      /* in units of the last bit: 2^23 - 1; arithmetic */
#define LEVEL 12                    /* zstd's level; higher ones save less than 1 % of these columns; chosen by hand */
#define DEFLATE_LEVEL 9             /* zlib's level, the highest; chosen by hand, not measured */
#define DEFLATE_PART 65536          /* bytes of packed data written at once; chosen by hand, not measured */
#define HALF_BYTE 127.5             /* x, y, z of a rotation in version 2 are c / 127.5 - 1; definition (SPZ) */

static uint8_t to_byte(double value)
{
    return (uint8_t)fmin(fmax(floor(value + 0.5), 0.0), 255.0);
}

/** The number of fractional bits that the farthest position allows; negative if it is too far. */
static int fraction_bits(const adcgs_splats *s)
{
    double farthest = 0.0;
    int bits = FRACTION_MAX;
    for (int a = 0; a < 3; a++)
        for (uint32_t i = 0; i < s->n; i++)
            farthest = fmax(farthest, fabs((double)s->mean[a][i]));
    while (bits >= 0 && floor(ldexp(farthest, bits) + 0.5) > POSITION_MAX)
        bits--;
    return bits;
}

static size_t fill_positions(uint8_t *to, const adcgs_splats *s, int bits)
{
    for (size_t i = 0; i < (size_t)3 * s->n; i++) {
        const int32_t value = (int32_t)floor(ldexp((double)s->mean[i % 3][i / 3], bits) + 0.5);
        const uint32_t raw = (uint32_t)value;
        to[3 * i] = (uint8_t)raw;
        to[3 * i + 1] = (uint8_t)(raw >> 8);
        to[3 * i + 2] = (uint8_t)(raw >> 16);
    }
    return (size_t)9 * s->n;
}

static size_t fill_opacities(uint8_t *to, const adcgs_splats *s, int bits)
{
    for (uint32_t i = 0; i < s->n; i++)
        to[i] = to_byte(255.0 * (double)s->opacity[i]);
    return s->n;
}

static size_t fill_colours(uint8_t *to, const adcgs_splats *s, int bits)
{
    for (size_t i = 0; i < (size_t)3 * s->n; i++) {
        const double f_dc = ((double)s->colour[i % 3][i / 3] - 0.5) / ADCGS_SPLATS_DC;
        to[i] = to_byte(255.0 * (0.5 + ADCGS_SPZ_COLOUR * f_dc));
    }
    return (size_t)3 * s->n;
}

static size_t fill_scales(uint8_t *to, const adcgs_splats *s, int bits)
{
    for (size_t i = 0; i < (size_t)3 * s->n; i++)
        to[i] = to_byte(ADCGS_SPZ_SCALE_STEPS * (log((double)s->scale[i % 3][i / 3]) - ADCGS_SPZ_SCALE_MIN));
    return (size_t)3 * s->n;
}

/**
 * q: x y z w. A quaternion and its negative are the same rotation, so the largest component, which is not stored, is taken as
 * positive.
 */
static uint32_t pack_rotation(const double q[4])
{
    int largest = 0;
    for (int a = 1; a < 4; a++)
        if (fabs(q[a]) > fabs(q[largest]))
            largest = a;
    uint32_t bits = (uint32_t)largest;
    for (int a = 0; a < 4; a++) {
        if (a == largest)
            continue;
        const double size = floor(ADCGS_SPZ_ROTATION_MAX * fabs(q[a]) / ADCGS_SPZ_SQRT_HALF + 0.5);
        bits = bits << 1 | (uint32_t)((q[a] < 0.0) != (q[largest] < 0.0));
        bits = bits << 9 | (uint32_t)fmin(size, ADCGS_SPZ_ROTATION_MAX);
    }
    return bits;
}

static size_t fill_rotations(uint8_t *to, const adcgs_splats *s, int bits)
{
    for (uint32_t i = 0; i < s->n; i++) {
        double q[4];
        for (int a = 0; a < 4; a++)
            q[a] = (double)s->rotation[(a + 1) % 4][i];
        adcgs_store_le32(to + (size_t)4 * i, pack_rotation(q));
    }
    return (size_t)4 * s->n;
}

/** Version 2: x y z in bytes. The sign of the quaternion is chosen so that w, which is not stored, is not negative. */
static size_t fill_rotations_2(uint8_t *to, const adcgs_splats *s, int bits)
{
    for (uint32_t i = 0; i < s->n; i++)
        for (int a = 0; a < 3; a++) {
            const double q = (double)s->rotation[a + 1][i];
            to[(size_t)3 * i + (size_t)a] = to_byte(HALF_BYTE * ((s->rotation[0][i] < 0.0f ? -q : q) + 1.0));
        }
    return (size_t)3 * s->n;
}

typedef size_t (*fill_fn)(uint8_t *to, const adcgs_splats *s, int bits);

static fill_fn fill_of(int column, int version)
{
    static const fill_fn fills[COLUMNS] = {fill_positions, fill_opacities, fill_colours, fill_scales, fill_rotations};
    return column == ADCGS_SPZ_ROTATIONS && version == 2 ? fill_rotations_2 : fills[column];
}

/** The first 16 bytes, which all versions have. */
static void put_start(uint8_t *header, const adcgs_splats *s, int bits, int version)
{
    memcpy(header, "NGSP", 4);
    adcgs_store_le32(header + 4, (uint32_t)version);
    adcgs_store_le32(header + 8, s->n);
    header[13] = (uint8_t)bits;
    header[14] = s->antialiased ? ADCGS_SPZ_ANTIALIASED : 0;
}

/* ---- Versions 2 and 3: one gzip stream ---- */

/** Fewer than 2^32 bytes, which a column of ADCGS_SPLATS_MAX splats has. last: end the stream. */
static void deflate_some(z_stream *z, FILE *file, const uint8_t *bytes, size_t n, int last)
{
    uint8_t part[DEFLATE_PART];
    z->next_in = bytes;
    z->avail_in = (uInt)n;
    do {
        z->next_out = part;
        z->avail_out = sizeof part;
        deflate(z, last ? Z_FINISH : Z_NO_FLUSH); /* with room in the output it cannot fail */
        fwrite(part, sizeof part - z->avail_out, 1, file);
    } while (!z->avail_out);
}

/** column: room for the largest column. \return 0 on allocation failure */
static int put_old(FILE *file, uint8_t *column, const adcgs_splats *s, int bits, int version)
{
    uint8_t header[ADCGS_SPZ_OLD_HEADER] = {0};
    z_stream z = {0};
    if (deflateInit2(&z, DEFLATE_LEVEL, Z_DEFLATED, 16 + MAX_WBITS, 9, Z_DEFAULT_STRATEGY) != Z_OK)
        return 0;
    put_start(header, s, bits, version);
    deflate_some(&z, file, header, sizeof header, 0);
    for (int c = 0; c < COLUMNS; c++)
        deflate_some(&z, file, column, fill_of(c, version)(column, s, bits), c == COLUMNS - 1);
    deflateEnd(&z);
    return 1;
}

/* ---- Version 4: a zstd stream for each column ---- */

typedef struct packed {
    uint8_t *bytes[COLUMNS];
    size_t raw[COLUMNS], size[COLUMNS];
} packed;

/** column: room for the largest column. \return 0 on allocation failure */
static int pack_columns(packed *p, uint8_t *column, const adcgs_splats *s, int bits)
{
    for (int c = 0; c < COLUMNS; c++) {
        p->raw[c] = fill_of(c, 4)(column, s, bits);
        const size_t room = ZSTD_compressBound(p->raw[c]);
        p->bytes[c] = malloc(room);
        if (!p->bytes[c])
            return 0;
        p->size[c] = ZSTD_compress(p->bytes[c], room, column, p->raw[c], LEVEL);
        if (ZSTD_isError(p->size[c])) /* the output has enough room, so this is an allocation failure */
            return 0;
    }
    return 1;
}

static void put_file(FILE *file, const packed *p, const adcgs_splats *s, int bits)
{
    uint8_t header[ADCGS_SPZ_HEADER + ADCGS_SPZ_ENTRY * COLUMNS] = {0};
    put_start(header, s, bits, 4);
    header[15] = COLUMNS;
    adcgs_store_le32(header + 16, ADCGS_SPZ_HEADER);
    for (int c = 0; c < COLUMNS; c++) {
        adcgs_store_le64(header + ADCGS_SPZ_HEADER + ADCGS_SPZ_ENTRY * c, p->size[c]);
        adcgs_store_le64(header + ADCGS_SPZ_HEADER + ADCGS_SPZ_ENTRY * c + 8, p->raw[c]);
    }
    fwrite(header, sizeof header, 1, file);
    for (int c = 0; c < COLUMNS; c++)
        fwrite(p->bytes[c], p->size[c], 1, file);
}

/** \return 0 on allocation failure */
static int put_new(FILE *file, uint8_t *column, const adcgs_splats *s, int bits)
{
    packed p = {{NULL}, {0}, {0}};
    const int done = pack_columns(&p, column, s, bits);
    if (done)
        put_file(file, &p, s, bits);
    for (int c = 0; c < COLUMNS; c++)
        free(p.bytes[c]);
    return done;
}

adcgs_status adcgs_spz_put(const adcgs_splats *splats, const adcgs_splats_style *style, FILE *file, const char *path,
                           adcgs_error *error)
{
    const int bits = fraction_bits(splats), version = style->spz_version;
    if (!splats->n)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: SPZ holds at least one splat", path);
    if (bits < 0)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: SPZ holds positions up to 2^23, and some are farther out", path);
    uint8_t *column = malloc((size_t)9 * splats->n);
    const int is_old = version == 2 || version == 3;
    const int done = column && (is_old ? put_old(file, column, splats, bits, version) : put_new(file, column, splats, bits));
    free(column);
    return done ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %u splats", path, splats->n);
}

#else

adcgs_status adcgs_spz_put(const adcgs_splats *splats, const adcgs_splats_style *style, FILE *file, const char *path,
                           adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: this build has no SPZ: it needs zlib and zstd", path);
}

#endif

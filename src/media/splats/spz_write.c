/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Writing splats as SPZ of version 4. */
#include "config.h"

#include "media/splats/spz.h"

#ifdef HAVE_SPZ

#include <math.h>
#include <stdlib.h>
#include <zstd.h>

#define COLUMNS ADCGS_SPZ_HARMONICS /* harmonics are not written */
#define FRACTION_MAX 23             /* fractional bits of a position, all but its sign; arithmetic */
#define POSITION_MAX 8388607.0      /* in units of the last bit: 2^23 - 1; arithmetic */
#define LEVEL 12                    /* zstd's level; higher ones save less than 1 % of these columns; chosen by hand */

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

typedef struct packed {
    uint8_t *bytes[COLUMNS];
    size_t raw[COLUMNS], size[COLUMNS];
} packed;

/** column: room for the largest column. \return 0 on allocation failure */
static int pack_columns(packed *p, uint8_t *column, const adcgs_splats *s, int bits)
{
    static size_t (*const fills[COLUMNS])(uint8_t *, const adcgs_splats *, int) = {fill_positions, fill_opacities, fill_colours,
                                                                                   fill_scales, fill_rotations};
    for (int c = 0; c < COLUMNS; c++) {
        p->raw[c] = fills[c](column, s, bits);
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
    uint8_t header[ADCGS_SPZ_HEADER + ADCGS_SPZ_ENTRY * COLUMNS] = {'N', 'G', 'S', 'P'};
    adcgs_store_le32(header + 4, 4);
    adcgs_store_le32(header + 8, s->n);
    header[13] = (uint8_t)bits;
    header[14] = s->antialiased ? ADCGS_SPZ_ANTIALIASED : 0;
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

adcgs_status adcgs_spz_put(const adcgs_splats *splats, const adcgs_splats_style *style, FILE *file, const char *path,
                           adcgs_error *error)
{
    packed p = {{NULL}, {0}, {0}};
    const int bits = fraction_bits(splats);
    if (!splats->n)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: SPZ holds at least one splat", path);
    if (bits < 0)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: SPZ holds positions up to 2^23, and some are farther out", path);
    uint8_t *column = malloc((size_t)9 * splats->n);
    const int done = column && pack_columns(&p, column, splats, bits);
    if (done)
        put_file(file, &p, splats, bits);
    free(column);
    for (int c = 0; c < COLUMNS; c++)
        free(p.bytes[c]);
    return done ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %u splats", path, splats->n);
}

#else

adcgs_status adcgs_spz_put(const adcgs_splats *splats, const adcgs_splats_style *style, FILE *file, const char *path,
                           adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: this build has no SPZ: it needs zlib and zstd", path);
}

#endif

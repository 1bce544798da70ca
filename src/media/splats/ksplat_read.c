/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Splats from .ksplat: the sections' headers, checked against the bytes present, then their records. */
#include "config.h"

#include "media/splats/ksplat.h"

#include "media/splats/half.h"
#include "media/splats/splat_set.h"

#include <math.h>

/* Origin, unless a line states one: definition (.ksplat). */
#define DEGREE_MAX 2   /* of harmonics */
#define BUCKET 12      /* bytes of a bucket's centre: three binary32 */
#define RANGE 32767    /* steps from a bucket's centre to its side, where a section has 0 */
#define HALF_RANGE 1.5 /* the largest coefficient of harmonics where the header has 0; the smallest is its negative */

/** Bytes of a record's parts at a level. */
static const struct layout {
    size_t mean, real, coefficient; /**< of a coordinate, of a scale's or rotation's component, of a coefficient */
} layouts[ADCGS_KSPLAT_LEVELS + 1] = {{4, 4, 4}, {2, 2, 2}, {2, 2, 1}};

typedef struct reader {
    adcgs_splats *out;
    const uint8_t *data;
    size_t bytes;
    const char *path;
    adcgs_error *error;
    uint32_t n_sections;
    int level;
    double low, high; /**< of harmonics at level 2 */
} reader;

typedef struct section {
    uint32_t n;                       /**< splats */
    uint32_t capacity, full, partial; /**< splats of a full bucket; full and partly filled buckets */
    const uint8_t *lengths, *buckets; /**< splats of each partly filled bucket; centres of the full ones, then of the others */
    uint32_t n_buckets;
    double range, step; /**< steps to a bucket's side, and their length */
    int degree;         /**< of harmonics */
    const uint8_t *records;
    size_t record; /**< bytes of a record */
} section;

static size_t coefficients_of(int degree)
{
    return 3 * (size_t)((degree + 1) * (degree + 1) - 1);
}

static double load_real(const uint8_t *at, size_t bytes)
{
    return bytes == 4 ? (double)adcgs_bits_float(adcgs_load_le32(at)) : adcgs_load_half(at);
}

static adcgs_status ends(const reader *r, uint32_t index, uint64_t needed, size_t left)
{
    return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: section %u of KSplat: %llu bytes, but %zu follow", r->path, index,
                      (unsigned long long)needed, left);
}

/** Read a section's header. *at is the section's position, and moves behind it. */
static adcgs_status read_section(const reader *r, uint32_t index, size_t *at, section *s)
{
    const uint8_t *const header = r->data + ADCGS_KSPLAT_HEADER + (size_t)ADCGS_KSPLAT_SECTION * index;
    const struct layout *const l = &layouts[r->level];
    const uint32_t room = adcgs_load_le32(header + 4), bucket_bytes = adcgs_load_le16(header + 20);
    const uint32_t range = adcgs_load_le32(header + 24), degree = adcgs_load_le16(header + 40);
    *s = (section){.n = adcgs_load_le32(header),
                   .capacity = adcgs_load_le32(header + 8),
                   .n_buckets = adcgs_load_le32(header + 12)};
    s->full = adcgs_load_le32(header + 32);
    s->partial = adcgs_load_le32(header + 36);
    s->range = range ? range : RANGE;
    s->step = (double)adcgs_bits_float(adcgs_load_le32(header + 16)) / 2.0 / s->range;
    s->degree = (int)degree;
    if (degree > DEGREE_MAX)
        return adcgs_fail(r->error, ADCGS_ERR_UNSUPPORTED, "%s: section %u of KSplat: harmonics of degree %u, expected 0 to 2",
                          r->path, index, degree);
    if (s->n > room)
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: section %u of KSplat: %u splats, expected at most its room of %u",
                          r->path, index, s->n, room);
    if (s->n_buckets && bucket_bytes != BUCKET)
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: section %u of KSplat: buckets of %u bytes, expected 12", r->path, index,
                          bucket_bytes);
    s->record = 3 * l->mean + 7 * l->real + 4 + coefficients_of(s->degree) * l->coefficient;
    const uint64_t before = (uint64_t)4 * s->partial + (uint64_t)BUCKET * s->n_buckets; /* below 2^37 */
    const uint64_t needed = before + (uint64_t)s->record * room;                        /* below 2^40 */
    if (needed > r->bytes - *at)
        return ends(r, index, needed, r->bytes - *at);
    s->lengths = r->data + *at;
    s->buckets = s->lengths + (size_t)4 * s->partial;
    s->records = r->data + *at + before;
    *at += (size_t)needed;
    return ADCGS_OK;
}

/* ---- Records ---- */

/** The bucket of the current splat; splats are in the order of buckets. */
typedef struct place {
    uint32_t next; /**< the bucket after it */
    uint64_t end;  /**< the first splat that is not in it */
} place;

static adcgs_status find_bucket(const reader *r, const section *s, uint32_t i, place *p)
{
    while (i >= p->end) {
        const uint32_t b = p->next++;
        if (b >= s->n_buckets || (b >= s->full && b - s->full >= s->partial))
            return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: KSplat: splat %u of a section is in none of its %u buckets", r->path,
                              i, s->n_buckets);
        p->end += b < s->full ? s->capacity : adcgs_load_le32(s->lengths + (size_t)4 * (b - s->full));
    }
    return ADCGS_OK;
}

static void take_mean(const reader *r, const section *s, const uint8_t *record, const place *p, double mean[3])
{
    for (int a = 0; a < 3; a++) {
        if (r->level == 0) {
            mean[a] = load_real(record + 4 * a, 4);
            continue;
        }
        const double centre = load_real(s->buckets + (size_t)BUCKET * (p->next - 1) + 4 * a, 4);
        mean[a] = centre + (adcgs_load_le16(record + 2 * a) - s->range) * s->step;
    }
}

/** The coefficients are those of red, green and blue of degree 1, then those of degree 2. */
static adcgs_status take_harmonics(const reader *r, const section *s, const uint8_t *at, uint32_t index)
{
    const size_t each = layouts[r->level].coefficient, per = coefficients_of(r->out->degree);
    float *const to = r->out->harmonics + index * per;
    for (int degree = 1; degree <= s->degree; degree++)
        for (int channel = 0; channel < 3; channel++)
            for (int i = degree * degree - 1; i < (degree + 1) * (degree + 1) - 1; i++, at += each) {
                const double v = each > 1 ? load_real(at, each) : r->low + *at / 255.0 * (r->high - r->low);
                if (!(fabs(v) <= (double)FLT_MAX))
                    return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: splat %u: a harmonic is not a finite number", r->path,
                                      index);
                to[(size_t)channel * (per / 3) + (size_t)i] = (float)v;
            }
    return ADCGS_OK;
}

static adcgs_status take_section(const reader *r, const section *s, uint32_t first)
{
    const struct layout *const l = &layouts[r->level];
    place p = {0, 0};
    for (uint32_t i = 0; i < s->n; i++) {
        const uint8_t *const record = s->records + s->record * i, *const scale = record + 3 * l->mean,
                             *const rotation = scale + 3 * l->real, *const colour = rotation + 4 * l->real;
        adcgs_splat splat = {.opacity = colour[3] / 255.0};
        if (r->level)
            ADCGS_TRY(find_bucket(r, s, i, &p));
        take_mean(r, s, record, &p, splat.mean);
        for (size_t a = 0; a < 3; a++) {
            splat.scale[a] = load_real(scale + a * l->real, l->real);
            splat.colour[a] = colour[a] / 255.0;
        }
        for (size_t a = 0; a < 4; a++)
            splat.rotation[a] = load_real(rotation + a * l->real, l->real);
        ADCGS_TRY(adcgs_splats_set(r->out, first + i, &splat, r->path, r->error));
        if (s->degree)
            ADCGS_TRY(take_harmonics(r, s, colour + 4, first + i));
    }
    return ADCGS_OK;
}

/** Go through all sections: count their splats and find the highest degree, or take them if the splats are allocated. */
static adcgs_status walk(const reader *r, uint64_t *n, int *degree)
{
    size_t at = ADCGS_KSPLAT_HEADER + (size_t)ADCGS_KSPLAT_SECTION * r->n_sections;
    *n = 0;
    for (uint32_t i = 0; i < r->n_sections; i++) {
        section s;
        ADCGS_TRY(read_section(r, i, &at, &s));
        if (r->out->block)
            ADCGS_TRY(take_section(r, &s, (uint32_t)*n));
        *n += s.n;
        *degree = s.n ? ADCGS_MAX(*degree, s.degree) : *degree;
    }
    return ADCGS_OK;
}

adcgs_status adcgs_ksplat_parse(adcgs_splats *out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error)
{
    reader r = {.out = out, .data = data, .bytes = bytes, .path = path, .error = error};
    uint64_t n;
    int degree = 0;
    r.n_sections = adcgs_load_le32(data + ADCGS_KSPLAT_SECTIONS);
    r.level = adcgs_load_le16(data + ADCGS_KSPLAT_LEVEL);
    r.low = load_real(data + ADCGS_KSPLAT_LOW, 4);
    r.high = load_real(data + ADCGS_KSPLAT_HIGH, 4);
    r.low = r.low != 0.0 ? r.low : -HALF_RANGE;
    r.high = r.high != 0.0 ? r.high : HALF_RANGE;
    ADCGS_TRY(walk(&r, &n, &degree));
    if (!n)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: no splats", path);
    ADCGS_TRY(adcgs_splats_alloc(out, n, path, error));
    ADCGS_TRY(adcgs_splats_add_harmonics(out, degree, path, error));
    return walk(&r, &n, &degree);
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A folder of files of static splats, one for each frame. Their names are a prefix and a number, and the numbers give the order.
 * Rows of two files with equal numbers of splats are taken for the same splats if their sizes, colours and positions agree far
 * better than those of other pairs.
 */
#include "config.h"

#include "media/dynamic/splat_files.h"

#include "media/listing.h"
#include "system/median.h"
#include "system/paths.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <strings.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define SAMPLES 512        /* rows that are compared between two frames */
#define PAIRS 3            /* pairs of adjacent frames that are compared */
#define SAME_MOST 0.5      /* difference of equal rows over that of other rows, medians; calibrated on splats4d (plyseq) */
#define STRIDE 977         /* rows between a row and the other one that it is compared with; arithmetic, a prime */
#define FEATURES 10        /* numbers of a splat that are compared: position, logarithms of scales, colour, opacity */
#define DIGITS_MAX 18      /* of a frame's number; arithmetic: it fits 64 bits */
#define NAME_MAX_BYTES 256 /* of a file's name */

/** Files in the order of frames. */
typedef struct files {
    char **path;
    uint32_t n;
} files;

/* ---- Names ---- */

static int ends_with(const char *name, size_t n, const char *end)
{
    const size_t length = strlen(end);
    return n >= length && !strncasecmp(name + n - length, end, length);
}

/** Length of a name without the extension of a file of splats; 0 if it has none. */
static size_t stem_length(const char *name)
{
    static const char *const ends[] = {".compressed.ply", ".ply", ".spz", ".sog", ".splat", ".ksplat", ".glb"};
    const size_t n = strlen(name);
    for (size_t i = 0; i < ADCGS_COUNTOF(ends); i++)
        if (ends_with(name, n, ends[i]))
            return n - strlen(ends[i]);
    return 0;
}

int adcgs_splat_files_name(const char *name, size_t *prefix, uint64_t *number)
{
    const size_t stem = stem_length(name);
    size_t at = stem;
    if (*name == '.' || strlen(name) >= NAME_MAX_BYTES)
        return 0;
    while (at > 0 && isdigit((unsigned char)name[at - 1]))
        at--;
    if (at == stem || stem - at > DIGITS_MAX)
        return 0;
    *prefix = at;
    *number = strtoull(name + at, NULL, 10);
    return 1;
}

static int is_frame(const char *name)
{
    size_t prefix;
    uint64_t number;
    return adcgs_splat_files_name(name, &prefix, &number);
}

static int by_number(const void *a, const void *b)
{
    const char *const x = *(char *const *)a, *const y = *(char *const *)b;
    size_t prefix;
    uint64_t i = 0, k = 0;
    adcgs_splat_files_name(x, &prefix, &i);
    adcgs_splat_files_name(y, &prefix, &k);
    return i != k ? (i > k) - (i < k) : strcmp(x, y);
}

/** Names in the folder that are a prefix and a number, in the order of the numbers. */
static adcgs_status list_names(adcgs_listing *list, const char *folder, adcgs_error *error)
{
    ADCGS_TRY(adcgs_listing_read(list, folder, is_frame, error));
    if (list->n)
        qsort(list->names, list->n, sizeof *list->names, by_number);
    return ADCGS_OK;
}

/** Makes paths of names with one prefix. ADCGS_ERR_DATA for two prefixes, and for too few or too many names. */
static adcgs_status take_names(files *f, const char *folder, const adcgs_listing *list, adcgs_error *error)
{
    size_t first = 0, prefix = 0;
    uint64_t number;
    if (list->n < 2 || list->n > ADCGS_DYNAMIC_FRAMES_MAX)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %zu numbered files of splats, expected 2 to %d", folder, list->n,
                          ADCGS_DYNAMIC_FRAMES_MAX);
    f->path = calloc(list->n, sizeof *f->path);
    for (size_t i = 0; f->path && i < list->n; i++) {
        adcgs_splat_files_name(list->names[i], &prefix, &number);
        if (i == 0)
            first = prefix;
        if (prefix != first || strncmp(list->names[i], list->names[0], prefix))
            return adcgs_fail(error, ADCGS_ERR_DATA,
                              "%s: files of splats with different names before the number (%.60s, %.60s), expected one sequence",
                              folder, list->names[0], list->names[i]);
        f->path[i] = adcgs_path("%s/%s", folder, list->names[i]);
        if (!f->path[i])
            break;
        f->n = (uint32_t)i + 1;
    }
    return f->n == list->n ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", folder);
}

int adcgs_splat_files_are(const char *folder)
{
    adcgs_listing list;
    adcgs_error unused;
    if (list_names(&list, folder, &unused) != ADCGS_OK)
        return 0;
    char *const path = list.n > 1 ? adcgs_path("%s/%s", folder, list.names[0]) : NULL;
    const int found = path && adcgs_splats_is(path);
    free(path);
    adcgs_listing_free(&list);
    return found;
}

/* ---- Identity ---- */

/** The numbers of a splat that are compared; sizes and positions in units of the frame's extent. */
static void features_of(double *f, const adcgs_splats *s, uint32_t i, double extent)
{
    for (int a = 0; a < 3; a++) {
        f[a] = (double)s->mean[a][i] / extent;
        f[3 + a] = log(fmax((double)s->scale[a][i], 1e-6 * extent)); /* flat splats have any size */
        f[6 + a] = (double)s->colour[a][i];
    }
    f[9] = (double)s->opacity[i];
}

static double difference(const adcgs_splats *a, uint32_t i, const adcgs_splats *b, uint32_t k, double extent)
{
    double x[FEATURES], y[FEATURES], sum = 0.0;
    features_of(x, a, i, extent);
    features_of(y, b, k, extent);
    for (int f = 0; f < FEATURES; f++)
        sum += fabs(x[f] - y[f]);
    return sum;
}

/** Half the spread of the middle positions, from the quarter to three quarters, on the widest axis. */
static double extent_of(const adcgs_splats *s, double *values)
{
    double widest = 0.0;
    for (int a = 0; a < 3; a++) {
        const uint32_t n = ADCGS_MIN(s->n, SAMPLES);
        for (uint32_t i = 0; i < n; i++)
            values[i] = (double)s->mean[a][(uint64_t)i * s->n / n];
        const double middle = adcgs_median(values, n);
        for (uint32_t i = 0; i < n; i++)
            values[i] = fabs((double)s->mean[a][(uint64_t)i * s->n / n] - middle);
        widest = fmax(widest, adcgs_median(values, n));
    }
    return widest > 0.0 ? widest : 1.0;
}

/** True if equal rows of two frames are the same splats. */
static int rows_agree(const adcgs_splats *a, const adcgs_splats *b)
{
    double same[SAMPLES], other[SAMPLES];
    const uint32_t n = ADCGS_MIN(a->n, SAMPLES);
    if (a->n != b->n || !n)
        return 0;
    const double extent = extent_of(a, same);
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t row = (uint32_t)((uint64_t)i * a->n / n);
        same[i] = difference(a, row, b, row, extent);
        other[i] = difference(a, row, b, (uint32_t)(((uint64_t)row + STRIDE) % b->n), extent);
    }
    return adcgs_median(same, n) < SAME_MOST * adcgs_median(other, n);
}

/** Compares some pairs of adjacent frames, and the first with the last. */
static adcgs_status find_identity(adcgs_dynamic *d, const files *f, adcgs_error *error)
{
    d->has_identity = 1;
    for (uint32_t i = 0; i <= PAIRS && d->has_identity && f->n > 1; i++) {
        const uint32_t from = i < PAIRS ? (uint32_t)((uint64_t)i * (f->n - 1) / PAIRS) : 0;
        const uint32_t to = i < PAIRS ? from + 1 : f->n - 1;
        adcgs_splats a, b;
        ADCGS_TRY(adcgs_splats_read(&a, f->path[from], error));
        const adcgs_status status = adcgs_splats_read(&b, f->path[to], error);
        if (status == ADCGS_OK) {
            d->has_identity = i < PAIRS ? rows_agree(&a, &b) : a.n == b.n;
            adcgs_splats_free(&b);
        }
        adcgs_splats_free(&a);
        ADCGS_TRY(status);
    }
    return ADCGS_OK;
}

/* ---- The reader ---- */

static int is_never(const uint8_t *data, size_t bytes)
{
    (void)data;
    (void)bytes;
    return 0;
}

static adcgs_status open_files(adcgs_dynamic *d, adcgs_error *error)
{
    adcgs_listing list;
    files *const f = d->state = calloc(1, sizeof *f);
    if (!f)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", d->path);
    ADCGS_TRY(list_names(&list, d->path, error));
    const adcgs_status status = take_names(f, d->path, &list, error);
    adcgs_listing_free(&list);
    ADCGS_TRY(status);
    adcgs_splats first;
    ADCGS_TRY(adcgs_splats_read(&first, f->path[0], error));
    d->n = first.n;
    adcgs_splats_free(&first);
    adcgs_dynamic_set_clock(d, (adcgs_fps){0, 0}, 0);
    d->frames = f->n;
    return find_identity(d, f, error);
}

static adcgs_status at_file(const adcgs_dynamic *d, double seconds, adcgs_splats *out, adcgs_error *error)
{
    const files *const f = d->state;
    const uint32_t frame = adcgs_dynamic_frame(d, seconds);
    ADCGS_TRY(adcgs_splats_read(out, f->path[frame], error));
    if (d->has_identity && out->n != d->n)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %u splats, expected %u as in the first frame", f->path[frame], out->n,
                          d->n);
    return ADCGS_OK;
}

const char *adcgs_splat_files_path(const adcgs_dynamic *d, uint32_t frame)
{
    const files *const f = d->state;
    return frame < f->n ? f->path[frame] : NULL;
}

static void close_files(adcgs_dynamic *d)
{
    files *const f = d->state;
    for (uint32_t i = 0; f && i < f->n; i++)
        free(f->path[i]);
    if (f)
        free(f->path);
    free(f);
    d->state = NULL;
}

const adcgs_dynamic_reader adcgs_dynamic_files = {"files of splats", is_never, 0, open_files, at_file, close_files};

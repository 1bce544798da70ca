/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A folder of files of static splats, one for each frame. Their names are a prefix and a number, and the numbers give the order.
 * Rows of two files with equal numbers of splats are taken for the same splats if their sizes, colours and positions agree far
 * better than those of other pairs.
 */
#include "config.h"

#include "media/dynamic/splat_files.h"

#include "media/kind.h"
#include "system/median.h"
#include "system/paths.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
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
    uint32_t n, capacity;
} files;

typedef struct numbered {
    char *name;
    uint64_t number;
} numbered;

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

static int by_number(const void *a, const void *b)
{
    const numbered *const x = a, *const y = b;
    return x->number != y->number ? (x->number > y->number) - (x->number < y->number) : strcmp(x->name, y->name);
}

/** Names in the folder that are a prefix and a number; *n of them, in order. NULL: out of memory, or no such folder. */
static numbered *list_names(const char *folder, size_t *n, adcgs_error *error)
{
    size_t capacity = 64, prefix;
    numbered *list = malloc(capacity * sizeof *list);
    DIR *const directory = list ? opendir(folder) : NULL;
    struct dirent *entry;
    *n = 0;
    if (list && !directory)
        adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot read the folder: %s", folder, strerror(errno));
    while (list && directory && (entry = readdir(directory))) {
        uint64_t number;
        if (!adcgs_splat_files_name(entry->d_name, &prefix, &number) || *n >= ADCGS_DYNAMIC_FRAMES_MAX)
            continue;
        if (*n == capacity) {
            numbered *const more = realloc(list, 2 * capacity * sizeof *list);
            if (!more)
                break;
            list = more;
            capacity *= 2;
        }
        list[*n] = (numbered){strdup(entry->d_name), number};
        if (!list[(*n)++].name)
            break;
    }
    if (directory)
        closedir(directory);
    if (list && !directory) {
        free(list);
        return NULL;
    }
    if (list)
        qsort(list, *n, sizeof *list, by_number);
    return list;
}

static void free_names(numbered *list, size_t n)
{
    for (size_t i = 0; i < n; i++)
        free(list[i].name);
    free(list);
}

/** Copies names of one prefix to paths. ADCGS_ERR_DATA for two prefixes. */
static adcgs_status take_names(files *f, const char *folder, const numbered *list, size_t n, adcgs_error *error)
{
    size_t first = 0, prefix = 0;
    uint64_t number;
    f->path = calloc(n + 1, sizeof *f->path);
    for (size_t i = 0; f->path && i < n; i++) {
        if (!list[i].name || !adcgs_splat_files_name(list[i].name, &prefix, &number))
            break;
        if (i == 0)
            first = prefix;
        if (prefix != first || strncmp(list[i].name, list[0].name, prefix))
            return adcgs_fail(error, ADCGS_ERR_DATA,
                              "%s: files of splats with different names before the number (%.60s, %.60s), expected one sequence",
                              folder, list[0].name, list[i].name);
        f->path[i] = adcgs_path("%s/%s", folder, list[i].name);
        if (!f->path[i])
            break;
        f->n = (uint32_t)i + 1;
    }
    return f->n == n ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", folder);
}

int adcgs_splat_files_are(const char *folder)
{
    size_t n, prefix;
    adcgs_error unused;
    numbered *const list = list_names(folder, &n, &unused);
    uint64_t number;
    int found = 0;
    if (list && n > 1 && list[0].name && adcgs_splat_files_name(list[0].name, &prefix, &number)) {
        char *const path = adcgs_path("%s/%s", folder, list[0].name);
        found = path && adcgs_splats_is(path);
        free(path);
    }
    if (list)
        free_names(list, n);
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
    size_t n;
    files *const f = d->state = calloc(1, sizeof *f);
    if (!f)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", d->path);
    adcgs_error reason = {.status = ADCGS_ERR_MEMORY, .text = "out of memory"};
    numbered *const list = list_names(d->path, &n, &reason);
    if (!list)
        return adcgs_fail(error, reason.status, "%s", reason.text);
    const adcgs_status status =
        n > 1 ? take_names(f, d->path, list, n, error)
              : adcgs_fail(error, ADCGS_ERR_DATA, "%s: %zu numbered files of splats, expected at least two", d->path, n);
    free_names(list, n);
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

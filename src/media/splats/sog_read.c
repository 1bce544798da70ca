/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Splats from SOG: the images of an archive or a folder, pixel by pixel. */
#include "config.h"

#include "media/splats/sog.h"

#include "media/arrays/zip_read.h"
#include "media/image/webp.h"
#include "media/splats/sog_meta.h"
#include "media/splats/splat_set.h"
#include "system/file.h"
#include "system/paths.h"

#include <math.h>
#include <stdlib.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define META_MAX ((uint64_t)1 << 20)  /* bytes of meta.json; three codebooks need 20 KB */
#define IMAGE_MAX ((uint64_t)1 << 30) /* bytes of an image's file */
#define SPLATS_PER_BYTE 64            /* most splats per byte of the images; a scene has about one per 10 bytes */
#define SPARE 65536                   /* pixels that images may have beyond twice the splats */
#define STEPS 65535.0                 /* of a position; definition (SOG) */
#define LARGEST 252                   /* alpha that stands for w as the omitted component; definition (SOG) */
#define ROW 64                        /* centroids in a row of their image; definition (SOG) */
#define CENTROIDS_MAX 65536           /* centroids; definition (SOG: labels have 16 bits) */

typedef struct reader {
    const char *path;
    adcgs_error *error;
    const adcgs_zip_archive *zip; /**< NULL: the files are in the folder of path */
    adcgs_sog_meta meta;
    uint8_t *packed[ADCGS_SOG_IMAGES];
    size_t bytes[ADCGS_SOG_IMAGES];
    adcgs_webp image[ADCGS_SOG_IMAGES];
    adcgs_splats *out;
} reader;

/* ---- Images ---- */

static adcgs_status load_neighbour(const reader *r, const char *name, uint8_t **data, size_t *bytes)
{
    const char *const slash = strrchr(r->path, '/');
    const int folder = slash ? (int)(slash + 1 - r->path) : 0;
    char *const path = adcgs_path("%.*s%s", folder, r->path, name);
    const adcgs_status status = path ? adcgs_file_load(data, bytes, path, IMAGE_MAX, r->error)
                                     : adcgs_fail(r->error, ADCGS_ERR_MEMORY, "%s: out of memory", r->path);
    free(path);
    return status;
}

/** Load all images as they are packed, and compare their size with the number of splats. */
static adcgs_status load_images(reader *r)
{
    uint64_t total = 0;
    for (int k = 0; k < ADCGS_SOG_IMAGES; k++) {
        const char *const name = r->meta.name[k];
        if (!*name)
            continue;
        ADCGS_TRY(r->zip ? adcgs_zip_unpack(&r->packed[k], &r->bytes[k], r->zip, name, IMAGE_MAX, r->error)
                         : load_neighbour(r, name, &r->packed[k], &r->bytes[k]));
        total += r->bytes[k];
    }
    if (r->meta.n > SPLATS_PER_BYTE * total)
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: %u splats, but only %llu bytes of images", r->path, r->meta.n,
                          (unsigned long long)total);
    return ADCGS_OK;
}

static adcgs_status unpack_image(reader *r, int k, uint64_t most)
{
    const adcgs_status status =
        adcgs_webp_parse(&r->image[k], r->packed[k], r->bytes[k], most, r->path, r->meta.name[k], r->error);
    free(r->packed[k]);
    r->packed[k] = NULL;
    return status;
}

/** Unpack an image with a pixel per splat. Further pixels are ignored. */
static adcgs_status unpack_pixels(reader *r, int k)
{
    adcgs_webp *const image = &r->image[k];
    ADCGS_TRY(unpack_image(r, k, 2 * (uint64_t)r->meta.n + SPARE));
    if ((uint64_t)image->width * (uint64_t)image->height < r->meta.n)
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: %s: %dx%d pixels, expected one for each of %u splats", r->path,
                          r->meta.name[k], image->width, image->height, r->meta.n);
    return ADCGS_OK;
}

static void clear_images(reader *r)
{
    for (int k = 0; k < ADCGS_SOG_IMAGES; k++) {
        free(r->packed[k]);
        r->packed[k] = NULL;
        adcgs_webp_clear(&r->image[k]);
    }
}

/* ---- Splats ---- */

static const uint8_t *pixel(const reader *r, int k, size_t i)
{
    return r->image[k].pixels + 4 * i;
}

static adcgs_status take_splat(const reader *r, uint32_t i)
{
    const adcgs_sog_meta *const m = &r->meta;
    const uint8_t *const low = pixel(r, ADCGS_SOG_MEANS_LOW, i), *const high = pixel(r, ADCGS_SOG_MEANS_HIGH, i),
                         *const scale = pixel(r, ADCGS_SOG_SCALES, i), *const colour = pixel(r, ADCGS_SOG_COLOURS, i),
                         *const rotation = pixel(r, ADCGS_SOG_ROTATIONS, i);
    adcgs_splat s = {.opacity = m->opacity[colour[3]]};
    double three[3];
    for (int a = 0; a < 3; a++) {
        const double v = m->low[a] + (m->high[a] - m->low[a]) * ((low[a] | high[a] << 8) / STEPS);
        s.mean[a] = copysign(expm1(fabs(v)), v);
        s.scale[a] = m->scale[a][scale[a]];
        s.colour[a] = m->colour[a][colour[a]];
        three[a] = sqrt(2.0) * (rotation[a] / 255.0 - 0.5);
    }
    if (rotation[3] < LARGEST)
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: splat %u: alpha %d of a rotation, expected 252 to 255", r->path, i,
                          rotation[3]);
    adcgs_rotation_of_three(s.rotation, three, rotation[3] - LARGEST);
    return adcgs_splats_set(r->out, i, &s, r->path, r->error);
}

static adcgs_status take_splats(reader *r)
{
    for (int k = 0; k < ADCGS_SOG_CENTROIDS; k++)
        ADCGS_TRY(unpack_pixels(r, k));
    ADCGS_TRY(adcgs_splats_alloc(r->out, r->meta.n, r->path, r->error));
    r->out->antialiased = (uint8_t)r->meta.antialiased;
    for (uint32_t i = 0; i < r->meta.n; i++)
        ADCGS_TRY(take_splat(r, i));
    for (int k = 0; k < ADCGS_SOG_CENTROIDS; k++)
        adcgs_webp_clear(&r->image[k]);
    return ADCGS_OK;
}

/* ---- Harmonics ---- */

/** Check the centroids' image, and give the degree and number of centroids that version 1 does not state. */
static adcgs_status check_centroids(reader *r)
{
    adcgs_sog_meta *const m = &r->meta;
    const adcgs_webp *const image = &r->image[ADCGS_SOG_CENTROIDS];
    int degree = 1;
    while (degree < ADCGS_SPLATS_DEGREE_MAX && image->width > ROW * ((degree + 1) * (degree + 1) - 1))
        degree++;
    const uint64_t most = (uint64_t)ROW * (uint64_t)image->height;
    if (image->width != ROW * ((degree + 1) * (degree + 1) - 1) || (m->degree && m->degree != degree) || m->centroids > most)
        return adcgs_fail(r->error, ADCGS_ERR_DATA,
                          "%s: %s: %dx%d pixels, expected a width of 192, 512 or 960 by its degree, "
                          "and a row for 64 of %u centroids",
                          r->path, m->name[ADCGS_SOG_CENTROIDS], image->width, image->height, m->centroids);
    m->degree = degree;
    if (!m->centroids)
        m->centroids = (uint32_t)ADCGS_MIN(most, CENTROIDS_MAX);
    return ADCGS_OK;
}

static adcgs_status take_harmonic(const reader *r, uint32_t i)
{
    const adcgs_sog_meta *const m = &r->meta;
    const size_t each = (size_t)((m->degree + 1) * (m->degree + 1) - 1), width = ROW * each;
    const uint8_t *const at = pixel(r, ADCGS_SOG_LABELS, i);
    const size_t label = (size_t)at[0] | (size_t)at[1] << 8;
    if (label >= m->centroids)
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: splat %u: centroid %zu of its harmonics, but there are %u", r->path, i,
                          label, m->centroids);
    const uint8_t *const centroid = pixel(r, ADCGS_SOG_CENTROIDS, label / ROW * width + label % ROW * each);
    for (size_t j = 0; j < 3 * each; j++) {
        const double v = m->harmonic[centroid[4 * (j % each) + j / each]];
        if (!(fabs(v) <= (double)FLT_MAX))
            return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: splat %u: a harmonic is not a finite number", r->path, i);
        r->out->harmonics[3 * each * i + j] = (float)v;
    }
    return ADCGS_OK;
}

static adcgs_status take_harmonics(reader *r)
{
    ADCGS_TRY(unpack_image(r, ADCGS_SOG_CENTROIDS, (uint64_t)CENTROIDS_MAX * 15));
    ADCGS_TRY(check_centroids(r));
    ADCGS_TRY(unpack_pixels(r, ADCGS_SOG_LABELS));
    ADCGS_TRY(adcgs_splats_add_harmonics(r->out, r->meta.degree, r->path, r->error));
    for (uint32_t i = 0; i < r->meta.n; i++)
        ADCGS_TRY(take_harmonic(r, i));
    return ADCGS_OK;
}

static adcgs_status read_images(reader *r)
{
    ADCGS_TRY(load_images(r));
    ADCGS_TRY(take_splats(r));
    return r->meta.has_harmonics ? take_harmonics(r) : ADCGS_OK;
}

static adcgs_status read_all(reader *r, const uint8_t *text, size_t bytes, int over_time)
{
    ADCGS_TRY(adcgs_sog_meta_parse(&r->meta, text, bytes, over_time, r->path, r->error));
    const adcgs_status status = read_images(r);
    clear_images(r);
    return status;
}

adcgs_status adcgs_sog_parse_meta(adcgs_splats *out, const uint8_t *text, size_t bytes, const char *path, adcgs_error *error)
{
    reader r = {.path = path, .error = error, .out = out};
    if (bytes > META_MAX)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %zu bytes, expected meta.json of at most %llu", path, bytes,
                          (unsigned long long)META_MAX);
    return read_all(&r, text, bytes, 0);
}

adcgs_status adcgs_sog_parse_timeless(adcgs_splats *out, const adcgs_zip_archive *zip, const uint8_t *text, size_t bytes,
                                      adcgs_error *error)
{
    reader r = {.path = zip->path, .error = error, .zip = zip, .out = out};
    return read_all(&r, text, bytes, 1);
}

adcgs_status adcgs_sog_parse(adcgs_splats *out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error)
{
    adcgs_zip_archive zip;
    uint8_t *text = NULL;
    size_t text_bytes = 0;
    reader r = {.path = path, .error = error, .zip = &zip, .out = out};
    ADCGS_TRY(adcgs_zip_open(&zip, data, bytes, path, error));
    if (!adcgs_zip_has(&zip, "meta.json"))
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: an archive without meta.json, expected splats (SOG)", path);
    ADCGS_TRY(adcgs_zip_unpack(&text, &text_bytes, &zip, "meta.json", META_MAX, error));
    const adcgs_status status = read_all(&r, text, text_bytes, 0);
    free(text);
    return status;
}

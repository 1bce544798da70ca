/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Writing splats as SOG. */
#include "config.h"

#include "media/splats/sog.h"

#ifdef HAVE_SOG

#include "geom/geom.h"
#include "media/splats/codebook.h"
#include "system/json.h"
#include "system/zip.h"

#include <math.h>
#include <stdlib.h>
#include <webp/encode.h>

#define PLACE_MAX 65535.0 /* largest quantised coordinate; definition (SOG: 16 bits) */

typedef struct writer {
    const adcgs_splats *s;
    adcgs_zip zip;
    uint32_t (*at)[3];      /**< [n] positions quantised to 16 bits, z y x, in Morton order (z's bits first) */
    uint32_t *order;        /**< [n] index of each splat in that order, which is also that of the pixels */
    double low[3], high[3]; /**< bounds of the positions' logarithms */
    float scales[ADCGS_CODEBOOK], colours[ADCGS_CODEBOOK];
    int width, height;
    uint8_t *pixels; /**< RGBA */
} writer;

static uint8_t to_byte(double value)
{
    return (uint8_t)fmin(fmax(floor(value + 0.5), 0.0), 255.0);
}

static double log_of(float x)
{
    return copysign(log1p(fabs((double)x)), (double)x);
}

static float colour_of(const adcgs_splats *s, uint32_t i, int c)
{
    return (float)(((double)s->colour[c][i] - 0.5) / ADCGS_SPLATS_DC);
}

static float scale_of(const adcgs_splats *s, uint32_t i, int a)
{
    return (float)log((double)s->scale[a][i]);
}

/* ---- Positions ---- */

static void find_bounds(writer *w)
{
    for (int a = 0; a < 3; a++) {
        w->low[a] = w->high[a] = log_of(w->s->mean[a][0]);
        for (uint32_t i = 1; i < w->s->n; i++) {
            w->low[a] = fmin(w->low[a], log_of(w->s->mean[a][i]));
            w->high[a] = fmax(w->high[a], log_of(w->s->mean[a][i]));
        }
    }
}

/** Quantise the positions and sort the splats along the curve. \return 0 on allocation failure */
static int find_places(writer *w)
{
    for (uint32_t i = 0; i < w->s->n; i++)
        for (int a = 0; a < 3; a++) {
            const double span = w->high[a] > w->low[a] ? w->high[a] - w->low[a] : 1.0;
            w->at[i][2 - a] = (uint32_t)floor(PLACE_MAX * (log_of(w->s->mean[a][i]) - w->low[a]) / span + 0.5);
        }
    return adcgs_morton_sort(&w->at[0][0], w->s->n, w->order, NULL) >= 0;
}

/** Make a codebook of the values of all splats and channels. \return 0 on allocation failure */
static int make_book(float *book, const adcgs_splats *s, float (*value)(const adcgs_splats *, uint32_t, int))
{
    float *const values = malloc((size_t)3 * s->n * sizeof *values);
    for (size_t j = 0; values && j < (size_t)3 * s->n; j++)
        values[j] = value(s, (uint32_t)(j / 3), (int)(j % 3));
    const int done = values && adcgs_codebook_make(book, values, (size_t)3 * s->n);
    free(values);
    return done;
}

/* ---- Images ---- */

static void paint_low(uint8_t *to, const writer *w, uint32_t k)
{
    for (int a = 0; a < 3; a++)
        to[a] = (uint8_t)w->at[k][2 - a];
}

static void paint_high(uint8_t *to, const writer *w, uint32_t k)
{
    for (int a = 0; a < 3; a++)
        to[a] = (uint8_t)(w->at[k][2 - a] >> 8);
}

/** The three smaller components. Alpha holds the index of the largest of w x y z, which is made positive. */
static void paint_rotation(uint8_t *to, const writer *w, uint32_t k)
{
    double q[4];
    int largest = 0;
    for (int a = 0; a < 4; a++) {
        q[a] = (double)w->s->rotation[a][w->order[k]];
        largest = fabs(q[a]) > fabs(q[largest]) ? a : largest;
    }
    for (int a = 0; a < 4; a++)
        if (a != largest)
            *to++ = to_byte(255.0 * (0.5 + copysign(sqrt(0.5), q[largest]) * q[a]));
    *to = (uint8_t)(252 + largest);
}

static void paint_scale(uint8_t *to, const writer *w, uint32_t k)
{
    for (int a = 0; a < 3; a++)
        to[a] = adcgs_codebook_find(w->scales, scale_of(w->s, w->order[k], a));
}

static void paint_colour(uint8_t *to, const writer *w, uint32_t k)
{
    for (int c = 0; c < 3; c++)
        to[c] = adcgs_codebook_find(w->colours, colour_of(w->s, w->order[k], c));
    to[3] = to_byte(255.0 * (double)w->s->opacity[w->order[k]]);
}

/** \return 0 on allocation failure */
static int add_picture(writer *w, const char *name, void (*paint)(uint8_t *to, const writer *w, uint32_t k))
{
    uint8_t *packed = NULL;
    const size_t pixels = (size_t)w->width * (size_t)w->height;
    for (size_t k = 0; k < pixels; k++) {
        uint8_t *const to = w->pixels + 4 * k;
        memset(to, 0, 3);
        to[3] = 255;
        if (k < w->s->n)
            paint(to, w, (uint32_t)k);
    }
    const size_t bytes = WebPEncodeLosslessRGBA(w->pixels, w->width, w->height, 4 * w->width, &packed);
    if (bytes)
        adcgs_zip_add(&w->zip, name, packed, bytes);
    WebPFree(packed);
    return bytes != 0;
}

static int add_pictures(writer *w)
{
    return add_picture(w, "means_l.webp", paint_low) && add_picture(w, "means_u.webp", paint_high) &&
           add_picture(w, "quats.webp", paint_rotation) && add_picture(w, "scales.webp", paint_scale) &&
           add_picture(w, "sh0.webp", paint_colour);
}

/* ---- meta.json ---- */

static void write_files(adcgs_json *json, const char *first, const char *second)
{
    adcgs_json_open(json, "files", '[');
    adcgs_json_string(json, NULL, first);
    if (second)
        adcgs_json_string(json, NULL, second);
    adcgs_json_close(json);
}

static void write_book(adcgs_json *json, const char *key, const float *book, const char *file)
{
    adcgs_json_open(json, key, '{');
    adcgs_json_open(json, "codebook", '[');
    for (int k = 0; k < ADCGS_CODEBOOK; k++)
        adcgs_json_real(json, NULL, (double)book[k]);
    adcgs_json_close(json);
    write_files(json, file, NULL);
    adcgs_json_close(json);
}

static adcgs_status write_meta(FILE *file, const writer *w, const char *generator, const char *path, adcgs_error *error)
{
    adcgs_json json;
    adcgs_json_init(&json);
    json.is_line = 1;
    json.digits = 17;
    adcgs_json_open(&json, NULL, '{');
    adcgs_json_int(&json, "version", 2);
    adcgs_json_open(&json, "asset", '{');
    adcgs_json_string(&json, "generator", generator);
    adcgs_json_close(&json);
    adcgs_json_int(&json, "count", w->s->n);
    adcgs_json_open(&json, "means", '{');
    for (int side = 0; side < 2; side++) {
        adcgs_json_open(&json, side ? "maxs" : "mins", '[');
        for (int a = 0; a < 3; a++)
            adcgs_json_real(&json, NULL, side ? w->high[a] : w->low[a]);
        adcgs_json_close(&json);
    }
    write_files(&json, "means_l.webp", "means_u.webp");
    adcgs_json_close(&json);
    write_book(&json, "scales", w->scales, "scales.webp");
    adcgs_json_open(&json, "quats", '{');
    write_files(&json, "quats.webp", NULL);
    adcgs_json_close(&json);
    write_book(&json, "sh0", w->colours, "sh0.webp");
    adcgs_json_close(&json);
    return adcgs_json_write(&json, file, path, error);
}

static adcgs_status add_meta(writer *w, const char *generator, const char *path, adcgs_error *error)
{
    char *text = NULL;
    size_t bytes = 0;
    FILE *const memory = open_memstream(&text, &bytes);
    if (!memory)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    const adcgs_status status = write_meta(memory, w, generator, path, error);
    fclose(memory);
    if (status == ADCGS_OK)
        adcgs_zip_add(&w->zip, "meta.json", (const uint8_t *)text, bytes);
    free(text);
    return status;
}

/** \return 0 on allocation failure */
static int fill(writer *w)
{
    const uint32_t n = w->s->n;
    w->width = 4 * (int)ceil(sqrt((double)n) / 4.0); /* at most 4096, and a multiple of 4, as other programs write it */
    w->height = 4 * (int)ceil((double)n / w->width / 4.0);
    w->at = malloc(n * sizeof *w->at);
    w->order = malloc(n * sizeof *w->order);
    w->pixels = malloc((size_t)4 * (size_t)w->width * (size_t)w->height);
    if (!w->at || !w->order || !w->pixels || !make_book(w->scales, w->s, scale_of) || !make_book(w->colours, w->s, colour_of))
        return 0;
    find_bounds(w);
    return find_places(w) && add_pictures(w);
}

adcgs_status adcgs_sog_put(const adcgs_splats *splats, const adcgs_splats_style *style, FILE *file, const char *path,
                           adcgs_error *error)
{
    if (!splats->n)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: SOG holds at least one splat", path);
    writer w = {.s = splats, .zip = {.file = file}};
    adcgs_status status = fill(&w) ? add_meta(&w, style->comment, path, error)
                                   : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %u splats", path, splats->n);
    if (status == ADCGS_OK)
        adcgs_zip_end(&w.zip);
    free(w.at);
    free(w.order);
    free(w.pixels);
    return status;
}

#else

adcgs_status adcgs_sog_put(const adcgs_splats *splats, const adcgs_splats_style *style, FILE *file, const char *path,
                           adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: this build has no SOG: it needs libwebp and zlib", path);
}

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Parsing SOG's meta.json. */
#include "config.h"

#include "media/splats/sog_meta.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>

#define LAST 255.0  /* largest value of a byte; definition */
#define OVER_TIME 4 /* version of TSOG; definition */

typedef struct reader {
    const char *path;
    adcgs_error *error;
    json_t *root;
    int version; /**< 1, or 2 and versions like it */
    adcgs_sog_meta *out;
} reader;

static adcgs_status bad(const reader *r, const char *object, const char *key, const char *expected)
{
    return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: meta.json: %s.%s: expected %s", r->path, object, key, expected);
}

/** Read exactly n finite numbers of an array, or the same number n times if the value is a number. */
static adcgs_status read_numbers(const reader *r, const char *object, const char *key, double *out, size_t n)
{
    json_t *const value = json_object_get(json_object_get(r->root, object), key);
    char expected[32];
    snprintf(expected, sizeof expected, "%zu numbers", n);
    if (!json_is_number(value) && json_array_size(value) != n)
        return bad(r, object, key, expected);
    for (size_t i = 0; i < n; i++) {
        json_t *const number = json_is_array(value) ? json_array_get(value, i) : value;
        out[i] = json_number_value(number);
        if (!json_is_number(number) || !isfinite(out[i]))
            return bad(r, object, key, expected);
    }
    return ADCGS_OK;
}

/**
 * Read a codebook of at most 256 numbers; further bytes have none. Some programs wrote null as the first number: it then is one
 * mean step below the second.
 */
static adcgs_status read_book(const reader *r, const char *object, double book[ADCGS_SOG_BYTES])
{
    json_t *const list = json_object_get(json_object_get(r->root, object), "codebook");
    const size_t n = json_array_size(list);
    if (n < 1 || n > ADCGS_SOG_BYTES)
        return bad(r, object, "codebook", "1 to 256 numbers");
    for (size_t i = 0; i < ADCGS_SOG_BYTES; i++)
        book[i] = json_is_number(json_array_get(list, i)) ? json_number_value(json_array_get(list, i)) : (double)NAN;
    if (json_is_null(json_array_get(list, 0)) && n > 2)
        book[0] = book[1] - (book[n - 1] - book[1]) / (double)(n - 1);
    return ADCGS_OK;
}

/** Read the numbers that an image's bytes in a channel stand for: a codebook, or steps between two bounds (version 1). */
static adcgs_status read_values(const reader *r, const char *object, double (*out)[ADCGS_SOG_BYTES], size_t channels)
{
    double low[4], high[4];
    if (r->version == 2) {
        for (size_t c = 0; c < channels; c++)
            ADCGS_TRY(read_book(r, object, out[c]));
        return ADCGS_OK;
    }
    ADCGS_TRY(read_numbers(r, object, "mins", low, channels));
    ADCGS_TRY(read_numbers(r, object, "maxs", high, channels));
    for (size_t c = 0; c < channels; c++)
        for (int i = 0; i < ADCGS_SOG_BYTES; i++)
            out[c][i] = low[c] + (high[c] - low[c]) * (i / LAST);
    return ADCGS_OK;
}

/** Read the names of an object's images. They may not lead to another folder. */
static adcgs_status read_names(const reader *r, const char *object, adcgs_sog_image first, size_t n)
{
    json_t *const list = json_object_get(json_object_get(r->root, object), "files");
    if (json_array_size(list) < n)
        return bad(r, object, "files", n > 1 ? "two names" : "a name");
    for (size_t i = 0; i < n; i++) {
        const char *const name = json_string_value(json_array_get(list, i));
        if (!name || !*name || *name == '.' || strlen(name) >= ADCGS_SOG_NAME || strpbrk(name, "/\\"))
            return bad(r, object, "files", "names of files without folders");
        snprintf(r->out->name[first + i], ADCGS_SOG_NAME, "%s", name);
    }
    return ADCGS_OK;
}

/* ---- Members ---- */

static adcgs_status read_version(reader *r, int over_time)
{
    json_t *const version = json_object_get(r->root, "version");
    if (!over_time && (json_object_get(r->root, "timeline") || json_object_get(r->root, "temporal")))
        return adcgs_fail(r->error, ADCGS_ERR_UNSUPPORTED, "%s: splats over time (TSOG), expected static ones", r->path);
    if (version && !json_is_integer(version))
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: meta.json: version: expected an integer", r->path);
    const json_int_t number = version ? json_integer_value(version) : 1;
    if (over_time ? number != OVER_TIME : number != 1 && number != 2)
        return adcgs_fail(r->error, ADCGS_ERR_UNSUPPORTED, "%s: %s of version %lld, expected %s", r->path,
                          over_time ? "TSOG" : "SOG", (long long)number, over_time ? "4" : "1 or 2");
    r->version = over_time ? 2 : (int)number;
    return ADCGS_OK;
}

static adcgs_status read_count(const reader *r)
{
    json_t *const shape = json_object_get(json_object_get(r->root, "means"), "shape");
    json_t *const count = r->version == 2 ? json_object_get(r->root, "count") : json_array_get(shape, 0);
    const json_int_t n = json_integer_value(count);
    if (!json_is_integer(count) || n < 1 || n > (json_int_t)ADCGS_SPLATS_MAX)
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: meta.json: %s: expected 1 to %u splats", r->path,
                          r->version == 2 ? "count" : "means.shape", ADCGS_SPLATS_MAX);
    r->out->n = (uint32_t)n;
    return ADCGS_OK;
}

static adcgs_status read_harmonics(const reader *r)
{
    json_t *const harmonics = json_object_get(r->root, "shN");
    adcgs_sog_meta *const m = r->out;
    if (!harmonics || json_is_null(harmonics))
        return ADCGS_OK;
    m->has_harmonics = 1;
    ADCGS_TRY(read_values(r, "shN", &m->harmonic, 1));
    ADCGS_TRY(read_names(r, "shN", ADCGS_SOG_CENTROIDS, 2));
    if (r->version == 1)
        return ADCGS_OK;
    const json_int_t degree = json_integer_value(json_object_get(harmonics, "bands"));
    const json_int_t count = json_integer_value(json_object_get(harmonics, "count"));
    if (degree < 1 || degree > ADCGS_SPLATS_DEGREE_MAX)
        return bad(r, "shN", "bands", "1 to 3");
    if (count < 1 || count > UINT16_MAX + 1)
        return bad(r, "shN", "count", "1 to 65536");
    m->degree = (int)degree;
    m->centroids = (uint32_t)count;
    return ADCGS_OK;
}

/** Read colours and opacities. Version 1 has opacities as logits in a fourth channel. */
static adcgs_status read_colours(const reader *r)
{
    adcgs_sog_meta *const m = r->out;
    double values[4][ADCGS_SOG_BYTES];
    ADCGS_TRY(read_values(r, "sh0", values, r->version == 2 ? 3 : 4));
    for (int i = 0; i < ADCGS_SOG_BYTES; i++) {
        m->opacity[i] = r->version == 2 ? i / LAST : 1.0 / (1.0 + exp(-values[3][i]));
        for (int c = 0; c < 3; c++)
            m->colour[c][i] = 0.5 + ADCGS_SPLATS_DC * values[c][i];
    }
    return ADCGS_OK;
}

static adcgs_status read_members(reader *r, int over_time)
{
    adcgs_sog_meta *const m = r->out;
    ADCGS_TRY(read_version(r, over_time));
    ADCGS_TRY(read_count(r));
    m->antialiased = json_is_true(json_object_get(r->root, "antialias"));
    ADCGS_TRY(read_numbers(r, "means", "mins", m->low, 3));
    ADCGS_TRY(read_numbers(r, "means", "maxs", m->high, 3));
    ADCGS_TRY(read_names(r, "means", ADCGS_SOG_MEANS_LOW, 2));
    ADCGS_TRY(read_values(r, "scales", m->scale, 3));
    for (int i = 0; i < 3 * ADCGS_SOG_BYTES; i++)
        m->scale[i / ADCGS_SOG_BYTES][i % ADCGS_SOG_BYTES] = exp(m->scale[i / ADCGS_SOG_BYTES][i % ADCGS_SOG_BYTES]);
    ADCGS_TRY(read_names(r, "scales", ADCGS_SOG_SCALES, 1));
    ADCGS_TRY(read_names(r, "quats", ADCGS_SOG_ROTATIONS, 1));
    ADCGS_TRY(read_colours(r));
    ADCGS_TRY(read_names(r, "sh0", ADCGS_SOG_COLOURS, 1));
    return read_harmonics(r);
}

adcgs_status adcgs_sog_meta_parse(adcgs_sog_meta *out, const uint8_t *text, size_t bytes, int over_time, const char *path,
                                  adcgs_error *error)
{
    reader r = {.path = path, .error = error, .out = out};
    json_error_t where;
    *out = (adcgs_sog_meta){0};
    r.root = json_loadb((const char *)text, bytes, JSON_REJECT_DUPLICATES, &where);
    if (!r.root)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: meta.json: line %d: malformed JSON: %s", path, where.line, where.text);
    const adcgs_status status = read_members(&r, over_time);
    json_decref(r.root);
    return status;
}

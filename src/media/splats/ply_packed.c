/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Splats from compressed PLY. */
#include "config.h"

#include "media/splats/ply_packed.h"

#include "media/splats/splat_set.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Origin: definition (compressed PLY). */
#define CHUNK 256         /* splats of a chunk */
#define HARMONIC_SPAN 8.0 /* the range of harmonics, around 0 */
enum { POSITION, ROTATION, SCALE, COLOUR, WORDS };
/** Bounds of a chunk: least and largest of three values each. */
enum { MEANS, LOGARITHMS = 6, COLOURS = 12, BOUNDS = 18, OLD_BOUNDS = 12, REST_MAX = 45 };

static const char *const words[WORDS] = {"packed_position", "packed_rotation", "packed_scale", "packed_color"};
static const char *const bounds[BOUNDS] = {"min_x",       "min_y",       "min_z",       "max_x",       "max_y",
                                           "max_z",       "min_scale_x", "min_scale_y", "min_scale_z", "max_scale_x",
                                           "max_scale_y", "max_scale_z", "min_r",       "min_g",       "min_b",
                                           "max_r",       "max_g",       "max_b"};

typedef struct reader {
    adcgs_ply *ply;
    adcgs_splats *out;
    float *chunks;   /**< [chunks][BOUNDS] */
    uint32_t *words; /**< [splats][WORDS] */
    size_t n_rest;
} reader;

int adcgs_ply_packed_is(adcgs_ply *ply)
{
    return adcgs_ply_find(ply, words[POSITION]) != NULL;
}

/* ---- Numbers of the file ---- */

static void take_bound(void *user, uint64_t item, const adcgs_ply_property *property, double value)
{
    ((reader *)user)->chunks[item * BOUNDS + (uint64_t)property->role] = (float)value;
}

static void take_word(void *user, uint64_t item, const adcgs_ply_property *property, double value)
{
    const int fits = value >= 0.0 && value <= (double)UINT32_MAX; /* text may hold any number */
    ((reader *)user)->words[item * WORDS + (uint64_t)property->role] = fits ? (uint32_t)value : 0;
}

/** A byte stands for the middle of its step, except that the first and the last one are the ends of the range. */
static void take_harmonic(void *user, uint64_t item, const adcgs_ply_property *property, double value)
{
    const reader *const r = user;
    const double part = value >= 255.0 ? 1.0 : value > 0.0 ? (value + 0.5) / 256.0 : 0.0;
    r->out->harmonics[item * r->n_rest + (uint64_t)property->role] = (float)(HARMONIC_SPAN * (part - 0.5));
}

static adcgs_status give_role(adcgs_ply *ply, adcgs_ply_element *e, const char *name, adcgs_ply_type type, int role)
{
    adcgs_ply_property *const p = adcgs_ply_find_in(e, name);
    if (!p)
        return adcgs_fail(ply->error, ADCGS_ERR_DATA, "%s: compressed splats without the property %s of the element %s",
                          ply->path, name, e->name);
    if (p->type != type)
        return adcgs_fail(ply->error, ADCGS_ERR_DATA, "%s: the property %s is of type %s, expected %s", ply->path, name,
                          adcgs_ply_type_name(p->type), adcgs_ply_type_name(type));
    p->role = role;
    return ADCGS_OK;
}

static adcgs_status no_memory(const reader *r)
{
    return adcgs_fail(r->ply->error, ADCGS_ERR_MEMORY, "%s: out of memory for %llu splats", r->ply->path,
                      (unsigned long long)r->ply->vertex.count);
}

/** Read the bounds. Files without those of colours have colours from 0 to 1. */
static adcgs_status read_chunks(reader *r)
{
    adcgs_ply *const ply = r->ply;
    adcgs_ply_element *const e = adcgs_ply_find_element(ply, "chunk");
    const uint64_t needed = (ply->vertex.count + CHUNK - 1) / CHUNK;
    if (!e || !e->at || e->count < needed)
        return adcgs_fail(ply->error, ADCGS_ERR_DATA, "%s: compressed splats: %llu items of the element chunk, expected %llu",
                          ply->path, (unsigned long long)(e && e->at ? e->count : 0), (unsigned long long)needed);
    const int n = adcgs_ply_find_in(e, bounds[COLOURS]) ? BOUNDS : OLD_BOUNDS;
    for (int i = 0; i < n; i++)
        ADCGS_TRY(give_role(ply, e, bounds[i], ADCGS_PLY_FLOAT32, i));
    r->chunks = malloc(e->count * BOUNDS * sizeof *r->chunks); /* the count has been checked against the file */
    if (!r->chunks)
        return no_memory(r);
    for (uint64_t i = 0; i < e->count * BOUNDS; i++)
        r->chunks[i] = i % BOUNDS >= COLOURS + 3 ? 1.0f : 0.0f;
    return adcgs_ply_items(ply, e, take_bound, r);
}

static adcgs_status read_words(reader *r)
{
    for (int i = 0; i < WORDS; i++)
        ADCGS_TRY(give_role(r->ply, &r->ply->vertex, words[i], ADCGS_PLY_UINT32, i));
    r->words = calloc(r->out->n, WORDS * sizeof *r->words);
    return r->words ? adcgs_ply_vertices(r->ply, take_word, r) : no_memory(r);
}

/** Read the harmonics, which follow the vertices. */
static adcgs_status read_harmonics(reader *r)
{
    adcgs_ply *const ply = r->ply;
    adcgs_ply_element *const e = adcgs_ply_find_element(ply, "sh");
    char name[32];
    int degree = 0;
    if (!e)
        return ADCGS_OK;
    for (; r->n_rest <= REST_MAX; r->n_rest++) {
        snprintf(name, sizeof name, "f_rest_%zu", r->n_rest);
        if (!adcgs_ply_find_in(e, name))
            break;
        ADCGS_TRY(give_role(ply, e, name, ADCGS_PLY_UINT8, (int)r->n_rest));
    }
    while (degree < ADCGS_SPLATS_DEGREE_MAX && r->n_rest > 3 * ((size_t)(degree + 1) * (size_t)(degree + 1) - 1))
        degree++;
    if (r->n_rest != 3 * ((size_t)(degree + 1) * (size_t)(degree + 1) - 1))
        return adcgs_fail(ply->error, ADCGS_ERR_DATA, "%s: %zu properties f_rest_*, expected none, 9, 24 or 45", ply->path,
                          r->n_rest);
    if (e->count != ply->vertex.count)
        return adcgs_fail(ply->error, ADCGS_ERR_DATA, "%s: harmonics of %llu splats, expected %llu", ply->path,
                          (unsigned long long)e->count, (unsigned long long)ply->vertex.count);
    ADCGS_TRY(adcgs_splats_add_harmonics(r->out, degree, ply->path, ply->error));
    return degree ? adcgs_ply_items(ply, e, take_harmonic, r) : ADCGS_OK;
}

/* ---- Unpacking ---- */

/** The lowest bits of a word as a number from 0 to 1. */
static double part_of(uint32_t word, int bits)
{
    const uint32_t most = (1u << bits) - 1;
    return (word & most) / (double)most;
}

static double between(const float *low, double part)
{
    return (double)low[0] * (1.0 - part) + (double)low[3] * part;
}

/** Three numbers of 11, 10 and 11 bits, from the highest bits down, within bounds. */
static void unpack_three(double out[3], uint32_t word, const float *low)
{
    out[0] = between(low, part_of(word >> 21, 11));
    out[1] = between(low + 1, part_of(word >> 11, 10));
    out[2] = between(low + 2, part_of(word, 11));
}

static adcgs_splat unpack(const uint32_t *word, const float *chunk)
{
    adcgs_splat s = {.opacity = part_of(word[COLOUR], 8)};
    double three[3];
    unpack_three(s.mean, word[POSITION], chunk + MEANS);
    unpack_three(s.scale, word[SCALE], chunk + LOGARITHMS);
    for (int a = 0; a < 3; a++) {
        s.scale[a] = exp(s.scale[a]);
        s.colour[a] = between(chunk + COLOURS + a, part_of(word[COLOUR] >> (24 - 8 * a), 8));
        three[a] = sqrt(2.0) * (part_of(word[ROTATION] >> (20 - 10 * a), 10) - 0.5);
    }
    adcgs_rotation_of_three(s.rotation, three, (int)(word[ROTATION] >> 30));
    return s;
}

static adcgs_status read_all(reader *r)
{
    adcgs_ply *const ply = r->ply;
    if (!ply->vertex.count)
        return adcgs_fail(ply->error, ADCGS_ERR_DATA, "%s: no splats", ply->path);
    ADCGS_TRY(adcgs_splats_alloc(r->out, ply->vertex.count, ply->path, ply->error));
    adcgs_ply_offset(ply, r->out->offset);
    ADCGS_TRY(read_chunks(r));
    ADCGS_TRY(read_words(r));
    ADCGS_TRY(read_harmonics(r));
    for (uint32_t i = 0; i < r->out->n; i++) {
        const adcgs_splat s = unpack(r->words + (size_t)WORDS * i, r->chunks + (size_t)BOUNDS * (i / CHUNK));
        ADCGS_TRY(adcgs_splats_set(r->out, i, &s, ply->path, ply->error));
    }
    return ADCGS_OK;
}

adcgs_status adcgs_ply_packed_parse(adcgs_splats *out, adcgs_ply *ply)
{
    reader r = {.ply = ply, .out = out};
    const adcgs_status status = read_all(&r);
    free(r.chunks);
    free(r.words);
    return status;
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Splats from PLY: the roles of properties, and the activations of logits and logarithms. */
#include "config.h"

#include "media/splats/splats_ply.h"

#include "media/points/ply.h"
#include "media/splats/offset.h"
#include "media/splats/ply_packed.h"
#include "system/median.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <strings.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define LOG_SCALE_MAX 80.0f  /* upper bound of a scale's logarithm */
#define LOG_SCALE_MIN -80.0f /* the scale of a flat axis, as in GLB */

/* Roles of properties; f_rest_i has the role REST + i. Arithmetic: counts of names[], and 3 * 15 of f_rest_*. */
enum { MEAN, DC = 3, OPACITY = 6, SCALE = 7, ROTATION = 10, REST = 14, REST_MAX = 45 };

static const char *const names[REST] = {"x",       "y",       "z",       "f_dc_0", "f_dc_1", "f_dc_2", "opacity",
                                        "scale_0", "scale_1", "scale_2", "rot_0",  "rot_1",  "rot_2",  "rot_3"};

typedef struct taker {
    adcgs_splats *out;
    double shift[3]; /**< subtracted from binary64 positions before they are rounded to binary32 */
    float *to[REST];
    size_t n_rest;
    int fault;      /**< role of the first invalid number, or -1 */
    uint64_t where; /**< its vertex */
} taker;

/** Logits and logarithms may be infinite: opacities of 0 and 1, and a flat splat. */
static int may_be(int role, float v)
{
    const int is_scale = role >= SCALE && role < ROTATION;
    return isfinite(v) || (!isnan(v) && (role == OPACITY || (is_scale && v < 0.0f)));
}

static void set_property(void *user, uint64_t vertex, const adcgs_ply_property *property, double value)
{
    taker *t = user;
    const float v = (float)(property->role < DC ? value - t->shift[property->role] : value);
    if (t->fault < 0 && !may_be(property->role, v)) {
        t->fault = property->role;
        t->where = vertex;
    }
    if (property->role < REST)
        t->to[property->role][vertex] = v;
    else
        t->out->harmonics[vertex * t->n_rest + (size_t)(property->role - REST)] = v;
}

/** True if the vertices have positions, but none of the other properties of splats. */
static int is_cloud(adcgs_ply *ply)
{
    int found = 0;
    for (int role = DC; role < REST; role++)
        found |= adcgs_ply_find(ply, names[role]) != NULL;
    return !found && adcgs_ply_find(ply, "x") && adcgs_ply_find(ply, "y") && adcgs_ply_find(ply, "z");
}

static adcgs_status give_role(adcgs_ply *ply, const char *name, int role)
{
    adcgs_ply_property *p = adcgs_ply_find(ply, name);
    if (!p)
        return adcgs_fail(ply->error, ADCGS_ERR_DATA,
                          "%s: no property %s: not splats, which have x, y, z, f_dc_0..2, opacity, scale_0..2 and rot_0..3%s",
                          ply->path, name, is_cloud(ply) ? "; give a point cloud with a scene, by --points" : "");
    if (p->type != ADCGS_PLY_FLOAT32 && p->type != ADCGS_PLY_FLOAT64)
        return adcgs_fail(ply->error, ADCGS_ERR_DATA, "%s: the property %s is of type %s, expected float or double", ply->path,
                          name, adcgs_ply_type_name(p->type));
    p->role = role;
    return ADCGS_OK;
}

/** Find f_rest_0, f_rest_1, ... up to the first missing one. */
static adcgs_status find_rest(adcgs_ply *ply, int *out, size_t *n_rest)
{
    char name[32];
    for (*n_rest = 0; *n_rest < REST_MAX; ++*n_rest) {
        snprintf(name, sizeof name, "f_rest_%zu", *n_rest);
        if (!adcgs_ply_find(ply, name))
            break;
        ADCGS_TRY(give_role(ply, name, REST + (int)*n_rest));
    }
    if (*n_rest == REST_MAX && adcgs_ply_find(ply, "f_rest_45"))
        return adcgs_fail(ply->error, ADCGS_ERR_UNSUPPORTED,
                          "%s: harmonics of degree 4 or more (it has f_rest_45), expected "
                          "degree 3 at most",
                          ply->path);
    for (int degree = 0; degree <= ADCGS_SPLATS_DEGREE_MAX; degree++)
        if (*n_rest == 3 * ((size_t)(degree + 1) * (size_t)(degree + 1) - 1)) {
            *out = degree;
            return ADCGS_OK;
        }
    return adcgs_fail(ply->error, ADCGS_ERR_DATA, "%s: %zu properties f_rest_*, expected none, 9, 24 or 45", ply->path, *n_rest);
}

/** Apply the activations to a splat. \return ADCGS_ERR_DATA for an invalid scale or rotation */
static adcgs_status activate(adcgs_splats *s, uint32_t i, const char *path, adcgs_error *error)
{
    double length = 0.0;
    for (int a = 0; a < 3; a++) {
        if (!(s->scale[a][i] <= LOG_SCALE_MAX))
            return adcgs_fail(error, ADCGS_ERR_DATA, "%s: vertex %u: scale_%d is %g, expected a logarithm of at most 80", path, i,
                              a, (double)s->scale[a][i]);
        s->scale[a][i] = (float)exp((double)fmaxf(s->scale[a][i], LOG_SCALE_MIN));
        s->colour[a][i] = (float)(0.5 + ADCGS_SPLATS_DC * (double)s->colour[a][i]);
    }
    s->opacity[i] = (float)(1.0 / (1.0 + exp(-(double)s->opacity[i])));
    for (int a = 0; a < 4; a++)
        length += (double)s->rotation[a][i] * (double)s->rotation[a][i];
    if (!(length > 0.0))
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: vertex %u: rot_0..3 are all zero, expected a quaternion", path, i);
    for (int a = 0; a < 4; a++)
        s->rotation[a][i] = (float)((double)s->rotation[a][i] / sqrt(length));
    return ADCGS_OK;
}

static adcgs_status read_vertices(adcgs_ply *ply, taker *t)
{
    adcgs_splats *s = t->out;
    ADCGS_TRY(adcgs_ply_vertices(ply, set_property, t));
    if (t->fault >= REST)
        return adcgs_fail(ply->error, ADCGS_ERR_DATA, "%s: vertex %llu: f_rest_%d is not a finite number", ply->path,
                          (unsigned long long)t->where, t->fault - REST);
    if (t->fault >= 0)
        return adcgs_fail(ply->error, ADCGS_ERR_DATA, "%s: vertex %llu: %s is not a finite number", ply->path,
                          (unsigned long long)t->where, names[t->fault]);
    for (uint32_t i = 0; i < s->n; i++)
        ADCGS_TRY(activate(s, i, ply->path, ply->error));
    return ADCGS_OK;
}

/** True if a text of n bytes equals a word, ignoring case. */
static int is_word(const char *text, size_t n, const char *word)
{
    return n == strlen(word) && !strncasecmp(text, word, n);
}

/** The value of a comment with this key; NULL if it has another key. */
static const char *value_behind(const char *key, const char *comment, size_t *n)
{
    const size_t length = strlen(key);
    if (*n <= length || strncasecmp(comment, key, length))
        return NULL;
    for (comment += length, *n -= length; *n && (*comment == ' ' || *comment == '\t'); comment++)
        --*n;
    return comment;
}

/** True if trained with antialiasing. The last such comment counts, as in other readers. */
static int says_antialiased(const adcgs_ply *ply)
{
    const char *at = NULL, *value;
    size_t n;
    int found = 0;
    while (adcgs_ply_comment(ply, &at, &n)) {
        size_t left = n;
        if ((value = value_behind("SplatRenderMode:", at, &left)))
            found = is_word(value, left, "mip");
        left = n;
        if ((value = value_behind("antialiased ", at, &left)))
            found = is_word(value, left, "1");
    }
    return found;
}

/** Reject other kinds of splats in PLY, by a characteristic property. */
static adcgs_status check_kind(adcgs_ply *ply)
{
    static const struct {
        const char *property, *kind;
    } others[] = {{"trbf_center", "splats over time (SpacetimeGaussians: it has trbf_center), expected static ones"},
                  {"log_duration", "splats over time (FreeTimeGS: it has log_duration), expected static ones"},
                  {"scale_t", "splats over time (4D Gaussians: it has scale_t), expected static ones"}};
    for (size_t i = 0; i < ADCGS_COUNTOF(others); i++)
        if (adcgs_ply_find(ply, others[i].property))
            return adcgs_fail(ply->error, ADCGS_ERR_UNSUPPORTED, "%s: %s", ply->path, others[i].kind);
    return ADCGS_OK;
}

/* ---- Positions far from the origin ---- */

#define SAMPLES 1024 /* most positions that the median is computed from; chosen by hand, not measured */

/** Positions of some vertices, evenly spread over the file. */
typedef struct survey {
    uint64_t step;
    size_t n[3];
    double values[3][SAMPLES];
} survey;

static void sample(void *user, uint64_t vertex, const adcgs_ply_property *property, double value)
{
    survey *s = user;
    if (property->role >= MEAN && property->role < DC && vertex % s->step == 0 && isfinite(value) &&
        s->n[property->role] < SAMPLES)
        s->values[property->role][s->n[property->role]++] = value;
}

/** The rounded median of binary64 positions if it is far from the origin compared with their spread, else zero. */
static adcgs_status find_shift(adcgs_ply *ply, double shift[3])
{
    double middle[3] = {0.0, 0.0, 0.0}, spread = 0.0;
    survey *s = calloc(1, sizeof *s);
    if (!s)
        return adcgs_fail(ply->error, ADCGS_ERR_MEMORY, "%s: out of memory", ply->path);
    s->step = ply->vertex.count / SAMPLES + 1;
    const adcgs_status status = adcgs_ply_survey(ply, sample, s);
    for (int a = 0; a < 3 && status == ADCGS_OK && s->n[a]; a++) {
        middle[a] = adcgs_median(s->values[a], s->n[a]);
        for (size_t i = 0; i < s->n[a]; i++)
            s->values[a][i] = fabs(s->values[a][i] - middle[a]);
        spread = fmax(spread, adcgs_median(s->values[a], s->n[a]));
    }
    adcgs_offset_of(shift, middle, spread > 0.0 ? spread : 1.0);
    free(s);
    return status;
}

/** Sets the splats' offset: the one that the file states, plus the shift of binary64 positions. */
static adcgs_status take_offset(adcgs_ply *ply, taker *t)
{
    const adcgs_ply_property *const x = adcgs_ply_find(ply, names[MEAN]);
    if (x->type == ADCGS_PLY_FLOAT64)
        ADCGS_TRY(find_shift(ply, t->shift));
    adcgs_ply_offset(ply, t->out->offset);
    for (int a = 0; a < 3; a++)
        t->out->offset[a] += t->shift[a];
    return ADCGS_OK;
}

/** True for surfels of 2D Gaussian splatting, which have only two scales. */
static int are_surfels(adcgs_ply *ply)
{
    return !adcgs_ply_find(ply, "scale_2") && adcgs_ply_find(ply, "scale_1") && adcgs_ply_find(ply, "rot_3") &&
           adcgs_ply_find(ply, "opacity");
}

static adcgs_status read_splats(adcgs_ply *ply, adcgs_splats *out)
{
    taker t = {.out = out, .fault = -1};
    const int surfels = are_surfels(ply);
    int degree = 0;
    ADCGS_TRY(check_kind(ply));
    for (int role = 0; role < REST; role++)
        if (!surfels || role != SCALE + 2)
            ADCGS_TRY(give_role(ply, names[role], role));
    ADCGS_TRY(find_rest(ply, &degree, &t.n_rest));
    if (!ply->vertex.count)
        return adcgs_fail(ply->error, ADCGS_ERR_DATA, "%s: no splats", ply->path);
    ADCGS_TRY(adcgs_splats_alloc(out, ply->vertex.count, ply->path, ply->error));
    ADCGS_TRY(take_offset(ply, &t));
    out->antialiased = !surfels && says_antialiased(ply);
    out->degree = degree;
    out->harmonics = t.n_rest ? malloc(out->n * t.n_rest * sizeof *out->harmonics) : NULL;
    if (t.n_rest && !out->harmonics)
        return adcgs_fail(ply->error, ADCGS_ERR_MEMORY, "%s: out of memory for %u splats", ply->path, out->n);
    for (int a = 0; a < 3; a++) {
        t.to[MEAN + a] = out->mean[a];
        t.to[DC + a] = out->colour[a];
        t.to[SCALE + a] = out->scale[a];
    }
    t.to[OPACITY] = out->opacity;
    for (int a = 0; a < 4; a++)
        t.to[ROTATION + a] = out->rotation[a];
    for (uint32_t i = 0; surfels && i < out->n; i++)
        out->scale[2][i] = -INFINITY;
    return read_vertices(ply, &t);
}

/** Read splats of a compressed PLY. */
static adcgs_status read_packed(adcgs_ply *ply, adcgs_splats *out)
{
    ADCGS_TRY(adcgs_ply_packed_parse(out, ply));
    out->antialiased = (uint8_t)says_antialiased(ply);
    return ADCGS_OK;
}

adcgs_status adcgs_splats_parse_ply(adcgs_splats *out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error)
{
    adcgs_ply *ply;
    ADCGS_TRY(adcgs_ply_open(&ply, data, bytes, path, error));
    const adcgs_status status = adcgs_ply_packed_is(ply) ? read_packed(ply, out) : read_splats(ply, out);
    adcgs_ply_close(&ply);
    return status;
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Splats from GLB: its chunks, the primitives with splats, and their attributes' numbers. */
#include "config.h"

#include "media/splats/glb.h"

#include "media/splats/glb_nodes.h"
#include "media/splats/glb_spz.h"
#include "media/splats/splats_move.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Origin: chosen by hand, not measured. */
#define TEXT_MAX \
    ((size_t)16 << 20) /* bytes of JSON; splats need a few kilobytes, and jansson takes about 20 times the text in
                                       memory */

int adcgs_glb_is(const uint8_t *data, size_t bytes)
{
    return bytes >= 4 && !memcmp(data, "glTF", 4);
}

static adcgs_status bad(const adcgs_glb *g, adcgs_status status, const char *what)
{
    return adcgs_fail(g->error, status, "%s: glTF: %s", g->path, what);
}

/* ---- Chunks ---- */

/** The chunk at *at. Moves *at behind it. */
static adcgs_status next_chunk(const adcgs_glb *g, const uint8_t **at, const uint8_t *end, const uint8_t **data, size_t *bytes,
                               uint32_t *type)
{
    if (end - *at < ADCGS_GLB_CHUNK)
        return bad(g, ADCGS_ERR_DATA, "the file ends where a chunk should begin");
    *bytes = adcgs_load_le32(*at);
    *type = adcgs_load_le32(*at + 4);
    *data = *at + ADCGS_GLB_CHUNK;
    if (*bytes > (size_t)(end - *data))
        return adcgs_fail(g->error, ADCGS_ERR_DATA, "%s: glTF: a chunk of %zu bytes, but %td follow", g->path, *bytes,
                          end - *data);
    *at = *data + *bytes;
    return ADCGS_OK;
}

static adcgs_status parse_text(adcgs_glb *g, const uint8_t *text, size_t bytes)
{
    json_error_t where;
    if (bytes > TEXT_MAX)
        return adcgs_fail(g->error, ADCGS_ERR_UNSUPPORTED, "%s: glTF: %zu bytes of JSON, expected at most %zu", g->path, bytes,
                          TEXT_MAX);
    g->root = json_loadb((const char *)text, bytes, JSON_REJECT_DUPLICATES, &where);
    if (!g->root)
        return adcgs_fail(g->error, ADCGS_ERR_DATA, "%s: glTF: line %d: malformed JSON: %s", g->path, where.line, where.text);
    const char *const version = json_string_value(json_object_get(json_object_get(g->root, "asset"), "version"));
    if (!version || strncmp(version, "2.", 2))
        return bad(g, ADCGS_ERR_DATA, "asset.version: expected 2.0");
    return ADCGS_OK;
}

static adcgs_status open_chunks(adcgs_glb *g, const uint8_t *data, size_t bytes)
{
    const uint8_t *at = data + ADCGS_GLB_HEADER, *chunk;
    size_t size;
    uint32_t type;
    if (bytes < ADCGS_GLB_HEADER || adcgs_load_le32(data + 4) != 2)
        return bad(g, ADCGS_ERR_DATA, "expected the header of version 2");
    const uint32_t length = adcgs_load_le32(data + 8);
    if (length > bytes || length < ADCGS_GLB_HEADER)
        return adcgs_fail(g->error, ADCGS_ERR_DATA, "%s: glTF: %u bytes by its header, but the file has %zu", g->path, length,
                          bytes);
    ADCGS_TRY(next_chunk(g, &at, data + length, &chunk, &size, &type));
    if (type != ADCGS_GLB_JSON)
        return bad(g, ADCGS_ERR_DATA, "the first chunk is not JSON");
    ADCGS_TRY(parse_text(g, chunk, size));
    while (at < data + length && !g->numbers) {
        ADCGS_TRY(next_chunk(g, &at, data + length, &chunk, &size, &type));
        if (type == ADCGS_GLB_BINARY) {
            g->numbers = chunk;
            g->n_bytes = size;
        }
    }
    return ADCGS_OK;
}

/* ---- Primitives ---- */

/** Extensions that may be required. Materials do not affect splats. */
static int is_known(const char *extension)
{
    return !strcmp(extension, ADCGS_GLB_SPLATS) || adcgs_glb_is_spz(extension) || !strcmp(extension, "KHR_mesh_quantization") ||
           !strcmp(extension, "KHR_materials_unlit");
}

static adcgs_status check_required(const adcgs_glb *g)
{
    size_t i;
    json_t *value;
    json_array_foreach(json_object_get(g->root, "extensionsRequired"), i, value)
    {
        const char *const name = json_string_value(value);
        if (!name || !is_known(name))
            return adcgs_fail(g->error, ADCGS_ERR_UNSUPPORTED, "%s: glTF: needs the extension %s, which is not supported",
                              g->path, name ? name : "?");
    }
    return ADCGS_OK;
}

/** Check a text of the extension. It may be missing, which means the expected value. */
static adcgs_status expect_text(const adcgs_glb *g, json_t *splats, const char *key, const char *expected)
{
    const char *const text = json_string_value(json_object_get(splats, key));
    if (text && strcmp(text, expected))
        return adcgs_fail(g->error, ADCGS_ERR_UNSUPPORTED, "%s: glTF: %s: %s, expected %s", g->path, key, text, expected);
    return ADCGS_OK;
}

/** The packing extension of splats and its name; NULL for unpacked splats. */
static json_t *packing_of(json_t *splats, const char **name)
{
    void *const first = json_object_iter(json_object_get(splats, "extensions"));
    *name = first ? json_object_iter_key(first) : NULL;
    return first ? json_object_iter_value(first) : NULL;
}

static adcgs_status check_primitive(const adcgs_glb *g, json_t *primitive, json_t *splats)
{
    const json_t *const mode = json_object_get(primitive, "mode");
    const char *packing;
    packing_of(splats, &packing);
    if (!json_is_integer(mode) || json_integer_value(mode))
        return bad(g, ADCGS_ERR_DATA, "splats with a mode that is not 0 (points)");
    if (packing && !adcgs_glb_is_spz(packing))
        return adcgs_fail(g->error, ADCGS_ERR_UNSUPPORTED,
                          "%s: glTF: splats packed by the extension %s, expected unpacked ones or SPZ", g->path, packing);
    ADCGS_TRY(expect_text(g, splats, "kernel", ADCGS_GLB_KERNEL));
    return expect_text(g, splats, "colorSpace", ADCGS_GLB_COLOURS);
}

/* ---- Splats ---- */

/* Store the finite numbers of an attribute in a splat. \return NULL, or the expected values for a message. */

static const char *put_position(adcgs_splats *s, uint32_t i, int k, const double v[4])
{
    for (int a = 0; a < 3; a++)
        s->mean[a][i] = (float)v[a];
    return NULL;
}

static const char *put_rotation(adcgs_splats *s, uint32_t i, int k, const double v[4])
{
    const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + v[3] * v[3]);
    for (int a = 0; a < 4 && length > 0.0; a++)
        s->rotation[(a + 1) % 4][i] = (float)(v[a] / length);
    return length > 0.0 ? NULL : "a quaternion";
}

static const char *put_scale(adcgs_splats *s, uint32_t i, int k, const double v[4])
{
    for (int a = 0; a < 3; a++) {
        if (!(v[a] >= 0.0 && v[a] <= (double)ADCGS_SPLATS_SCALE_MAX))
            return "numbers from 0 to e^80";
        s->scale[a][i] = fmaxf((float)v[a], ADCGS_SPLATS_SCALE_MIN);
    }
    return NULL;
}

static const char *put_opacity(adcgs_splats *s, uint32_t i, int k, const double v[4])
{
    s->opacity[i] = (float)v[0];
    return v[0] >= 0.0 && v[0] <= 1.0 ? NULL : "a number from 0 to 1";
}

static const char *put_colour(adcgs_splats *s, uint32_t i, int k, const double v[4])
{
    for (int c = 0; c < 3; c++)
        s->colour[c][i] = (float)(0.5 + ADCGS_SPLATS_DC * v[c]);
    return NULL;
}

/** k: index of the coefficient above degree 0. */
static const char *put_harmonic(adcgs_splats *s, uint32_t i, int k, const double v[4])
{
    const size_t per = (size_t)((s->degree + 1) * (s->degree + 1) - 1);
    for (size_t c = 0; c < 3; c++)
        s->harmonics[(3 * i + c) * per + (size_t)k] = (float)v[c];
    return NULL;
}

typedef const char *(*put_fn)(adcgs_splats *s, uint32_t i, int k, const double v[4]);

static adcgs_status find(adcgs_glb_view *view, const adcgs_glb *g, const adcgs_splats *s, const char *name, int components)
{
    ADCGS_TRY(adcgs_glb_find(view, g, name, components));
    return view->count == s->n
               ? ADCGS_OK
               : adcgs_fail(g->error, ADCGS_ERR_DATA, "%s: glTF: %s: %u elements, expected %u", g->path, name, view->count, s->n);
}

static adcgs_status read_attribute(const adcgs_glb *g, adcgs_splats *s, const char *name, int components, put_fn put, int k)
{
    adcgs_glb_view view;
    ADCGS_TRY(find(&view, g, s, name, components));
    for (uint32_t i = 0; i < s->n; i++) {
        double v[4] = {0};
        const char *wrong = NULL;
        for (int c = 0; c < components; c++) {
            v[c] = adcgs_glb_number(&view, i, c);
            wrong = isfinite(v[c]) ? wrong : "finite numbers";
        }
        wrong = wrong ? wrong : put(s, i, k, v);
        if (wrong)
            return adcgs_fail(g->error, ADCGS_ERR_DATA, "%s: glTF: splat %u: %s: expected %s", g->path, i, name, wrong);
    }
    return ADCGS_OK;
}

static const char *harmonic_name(char out[64], int degree, int n)
{
    snprintf(out, 64, ADCGS_GLB_SPLATS ":SH_DEGREE_%d_COEF_%d", degree, n);
    return out;
}

/** The degree is the highest one present. Memory is allocated only after all coefficients have been found. */
static adcgs_status take_harmonics(const adcgs_glb *g, adcgs_splats *s)
{
    adcgs_glb_view view;
    char name[64];
    if (json_object_get(g->attributes, harmonic_name(name, ADCGS_SPLATS_DEGREE_MAX + 1, 0)))
        return bad(g, ADCGS_ERR_UNSUPPORTED, "harmonics of degree 4, expected at most 3");
    while (s->degree < ADCGS_SPLATS_DEGREE_MAX && json_object_get(g->attributes, harmonic_name(name, s->degree + 1, 0)))
        s->degree++;
    for (int degree = 1; degree <= s->degree; degree++)
        for (int j = 0; j <= 2 * degree; j++)
            ADCGS_TRY(find(&view, g, s, harmonic_name(name, degree, j), 3));
    if (!s->degree)
        return ADCGS_OK;
    const size_t n = (size_t)s->n * 3 * (size_t)((s->degree + 1) * (s->degree + 1) - 1);
    s->harmonics = malloc(n * sizeof *s->harmonics);
    if (!s->harmonics)
        return bad(g, ADCGS_ERR_MEMORY, "out of memory for harmonics");
    for (int degree = 1, k = 0; degree <= s->degree; degree++)
        for (int j = 0; j <= 2 * degree; j++, k++)
            ADCGS_TRY(read_attribute(g, s, harmonic_name(name, degree, j), 3, put_harmonic, k));
    return ADCGS_OK;
}

static adcgs_status take_splats(const adcgs_glb *g, adcgs_splats *s)
{
    adcgs_glb_view view;
    char name[64];
    ADCGS_TRY(adcgs_glb_find(&view, g, "POSITION", 3));
    ADCGS_TRY(adcgs_splats_alloc(s, view.count, g->path, g->error));
    s->axes = ADCGS_SPLATS_Y_UP;
    ADCGS_TRY(read_attribute(g, s, "POSITION", 3, put_position, 0));
    ADCGS_TRY(read_attribute(g, s, ADCGS_GLB_SPLATS ":ROTATION", 4, put_rotation, 0));
    ADCGS_TRY(read_attribute(g, s, ADCGS_GLB_SPLATS ":SCALE", 3, put_scale, 0));
    ADCGS_TRY(read_attribute(g, s, ADCGS_GLB_SPLATS ":OPACITY", 1, put_opacity, 0));
    ADCGS_TRY(read_attribute(g, s, harmonic_name(name, 0, 0), 3, put_colour, 0));
    return take_harmonics(g, s);
}

/* ---- The whole file ---- */

/** The splats read so far, transformed by their nodes. */
typedef struct parts {
    adcgs_splats *list;
    size_t n;
    uint64_t splats;
    double offset[3]; /**< of a file that is far from the origin; subtracted from all positions */
} parts;

static void clear_parts(parts *p)
{
    for (size_t i = 0; i < p->n; i++)
        adcgs_splats_free(&p->list[i]);
    free(p->list);
}

#define FAR \
    1024.0 /* distance of a node from the origin over the extent of its splats; beyond it binary32 leaves fewer than
                      four digits of a position */

/** Take a node position far from the origin, as in scenes in map coordinates, as the offset of the file. */
static void find_offset(parts *p, const adcgs_splats *s, const double place[12])
{
    double reach = 0.0, far = 0.0;
    for (int a = 0; a < 3; a++) {
        far = fmax(far, fabs(place[4 * a + 3]));
        for (uint32_t i = 0; i < s->n; i++)
            reach = fmax(reach, fabs((double)s->mean[a][i]));
    }
    for (int a = 0; a < 3 && far > FAR * reach; a++)
        p->offset[a] = place[4 * a + 3];
}

/** Add splats at a node; takes ownership of *splats. */
static adcgs_status add_part(parts *p, adcgs_splats *splats, const double node[12], const adcgs_glb *g)
{
    double place[12];
    memcpy(place, node, sizeof place);
    if (!p->n)
        find_offset(p, splats, place);
    for (int a = 0; a < 3; a++)
        place[4 * a + 3] -= p->offset[a];
    adcgs_splats *const list = realloc(p->list, (p->n + 1) * sizeof *list);
    if (!list) {
        adcgs_splats_free(splats);
        return bad(g, ADCGS_ERR_MEMORY, "out of memory");
    }
    p->list = list;
    p->list[p->n] = *splats;
    *splats = (adcgs_splats){0};
    return adcgs_glb_moves(place) ? adcgs_splats_move(&p->list[p->n++], place, g->path, g->error) : (p->n++, ADCGS_OK);
}

/** Add splats once per node; the last node needs no copy. */
static adcgs_status add_parts(parts *p, adcgs_splats *splats, const adcgs_glb_places *places, const adcgs_glb *g)
{
    p->splats += (uint64_t)splats->n * places->n;
    if (p->splats > ADCGS_SPLATS_MAX)
        return adcgs_fail(g->error, ADCGS_ERR_DATA, "%s: glTF: %llu splats of all nodes, expected at most %u", g->path,
                          (unsigned long long)p->splats, ADCGS_SPLATS_MAX);
    for (size_t i = 0; i + 1 < places->n; i++) {
        adcgs_splats copy;
        ADCGS_TRY(adcgs_splats_join(&copy, splats, 1, g->path, g->error));
        ADCGS_TRY(add_part(p, &copy, places->matrix[i], g));
    }
    return add_part(p, splats, places->matrix[places->n - 1], g);
}

static adcgs_status read_primitive(parts *p, adcgs_glb *g, json_t *primitive, size_t mesh)
{
    json_t *const splats = json_object_get(json_object_get(primitive, "extensions"), ADCGS_GLB_SPLATS);
    adcgs_glb_places places;
    adcgs_splats read = {0};
    const char *packing;
    ADCGS_TRY(check_primitive(g, primitive, splats));
    g->attributes = json_object_get(primitive, "attributes");
    json_t *const packed = packing_of(splats, &packing);
    adcgs_status status = adcgs_glb_places_find(&places, g, mesh);
    if (status == ADCGS_OK)
        status = packed ? adcgs_glb_take_spz(&read, g, packed) : take_splats(g, &read);
    if (status == ADCGS_OK)
        status = add_parts(p, &read, &places, g);
    adcgs_splats_free(&read);
    adcgs_glb_places_clear(&places);
    return status;
}

static adcgs_status read_parts(parts *p, adcgs_glb *g)
{
    size_t m, i;
    json_t *mesh, *primitive;
    json_array_foreach(json_object_get(g->root, "meshes"), m, mesh)
    {
        json_array_foreach(json_object_get(mesh, "primitives"), i,
                           primitive) if (json_object_get(json_object_get(primitive, "extensions"), ADCGS_GLB_SPLATS))
            ADCGS_TRY(read_primitive(p, g, primitive, m));
    }
    return p->n ? ADCGS_OK : bad(g, ADCGS_ERR_DATA, "no splats: no primitive with " ADCGS_GLB_SPLATS);
}

static adcgs_status read_file(adcgs_glb *g, parts *p, adcgs_splats *out, const uint8_t *data, size_t bytes)
{
    ADCGS_TRY(open_chunks(g, data, bytes));
    ADCGS_TRY(check_required(g));
    ADCGS_TRY(read_parts(p, g));
    if (p->n > 1)
        ADCGS_TRY(adcgs_splats_join(out, p->list, p->n, g->path, g->error));
    else {
        *out = *p->list;
        *p->list = (adcgs_splats){0};
    }
    memcpy(out->offset, p->offset, sizeof p->offset);
    return ADCGS_OK;
}

adcgs_status adcgs_glb_parse(adcgs_splats *out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error)
{
    adcgs_glb g = {.path = path, .error = error};
    parts p = {0};
    const adcgs_status status = read_file(&g, &p, out, data, bytes);
    clear_parts(&p);
    json_decref(g.root);
    return status;
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Writing splats as GLB: the header, a chunk of JSON, and one of numbers,
 * attribute by attribute.
 */
#include "config.h"

#include "media/splats/glb.h"

#ifdef HAVE_ENCODER

#include "media/splats/offset.h"
#include "system/json.h"

#include <math.h>
#include <stdlib.h>

/* Origin: arithmetic. */
#define ATTRIBUTES 5 /* entries of attributes[], below */
#define FLOATS 14    /* numbers per splat: the sum of their components */
#define DIGITS 9     /* significant decimal digits that preserve each binary32 */

static const struct {
    const char *name, *type;
    int n; /**< components */
} attributes[ATTRIBUTES] = {{"POSITION", "VEC3", 3},
                            {ADCGS_GLB_SPLATS ":ROTATION", "VEC4", 4},
                            {ADCGS_GLB_SPLATS ":SCALE", "VEC3", 3},
                            {ADCGS_GLB_SPLATS ":OPACITY", "SCALAR", 1},
                            {ADCGS_GLB_SPLATS ":SH_DEGREE_0_COEF_0", "VEC3", 3}};

/** Component c of an attribute of splat i. */
static float value_of(const adcgs_splats *s, uint32_t i, int attribute, int c)
{
    switch (attribute) {
    case 0:
        return s->mean[c][i];
    case 1:
        return s->rotation[(c + 1) % 4][i];
    case 2:
        return s->scale[c][i];
    case 3:
        return s->opacity[i];
    default:
        return (float)(((double)s->colour[c][i] - 0.5) / ADCGS_SPLATS_DC);
    }
}

/* ---- JSON ---- */

/** Open an array and one object in it. close_one() closes both. */
static void open_one(adcgs_json *json, const char *key)
{
    adcgs_json_open(json, key, '[');
    adcgs_json_open(json, NULL, '{');
}

static void close_one(adcgs_json *json)
{
    adcgs_json_close(json);
    adcgs_json_close(json);
}

static void list_one(adcgs_json *json, const char *key, const char *name)
{
    adcgs_json_open(json, key, '[');
    adcgs_json_string(json, NULL, name);
    adcgs_json_close(json);
}

/** "min" and "max" of positions, which glTF requires. */
static void write_bounds(adcgs_json *json, const adcgs_splats *s)
{
    for (int side = 0; side < 2; side++) {
        adcgs_json_open(json, side ? "max" : "min", '[');
        for (int a = 0; a < 3; a++) {
            float bound = s->mean[a][0];
            for (uint32_t i = 1; i < s->n; i++)
                bound = side ? fmaxf(bound, s->mean[a][i]) : fminf(bound, s->mean[a][i]);
            adcgs_json_real(json, NULL, (double)bound);
        }
        adcgs_json_close(json);
    }
}

/** Layout of the numbers: one buffer, a view of it for each attribute, and an accessor for each view. */
static void write_numbers(adcgs_json *json, const adcgs_splats *s)
{
    int64_t offset = 0;
    open_one(json, "buffers");
    adcgs_json_int(json, "byteLength", (int64_t)4 * FLOATS * s->n);
    close_one(json);
    adcgs_json_open(json, "bufferViews", '[');
    for (int k = 0; k < ATTRIBUTES; k++) {
        const int64_t bytes = (int64_t)4 * attributes[k].n * s->n;
        adcgs_json_open(json, NULL, '{');
        adcgs_json_int(json, "buffer", 0);
        adcgs_json_int(json, "byteOffset", offset);
        adcgs_json_int(json, "byteLength", bytes);
        adcgs_json_int(json, "target", 34962); /* ARRAY_BUFFER */
        adcgs_json_close(json);
        offset += bytes;
    }
    adcgs_json_close(json);
    adcgs_json_open(json, "accessors", '[');
    for (int k = 0; k < ATTRIBUTES; k++) {
        adcgs_json_open(json, NULL, '{');
        adcgs_json_int(json, "bufferView", k);
        adcgs_json_int(json, "componentType", ADCGS_GLB_FLOAT);
        adcgs_json_int(json, "count", s->n);
        adcgs_json_string(json, "type", attributes[k].type);
        if (k == 0)
            write_bounds(json, s);
        adcgs_json_close(json);
    }
    adcgs_json_close(json);
}

static void write_mesh(adcgs_json *json)
{
    open_one(json, "meshes");
    open_one(json, "primitives");
    adcgs_json_open(json, "attributes", '{');
    for (int k = 0; k < ATTRIBUTES; k++)
        adcgs_json_int(json, attributes[k].name, k);
    adcgs_json_close(json);
    adcgs_json_int(json, "mode", 0); /* points */
    adcgs_json_open(json, "extensions", '{');
    adcgs_json_open(json, ADCGS_GLB_SPLATS, '{');
    adcgs_json_string(json, "kernel", ADCGS_GLB_KERNEL);
    adcgs_json_string(json, "colorSpace", ADCGS_GLB_COLOURS);
    adcgs_json_close(json);
    adcgs_json_close(json);
    close_one(json);
    close_one(json);
}

/** The single node, with a translation if the scene is far from the origin. */
static void write_node(adcgs_json *json, const adcgs_splats *s)
{
    open_one(json, "nodes");
    adcgs_json_int(json, "mesh", 0);
    if (adcgs_offset_is(s->offset)) {
        json->digits = 17;
        adcgs_json_open(json, "translation", '[');
        for (int a = 0; a < 3; a++)
            adcgs_json_real(json, NULL, s->offset[a]);
        adcgs_json_close(json);
        json->digits = DIGITS;
    }
    close_one(json);
}

static adcgs_status write_json(FILE *file, const adcgs_splats *s, const char *generator, const char *path, adcgs_error *error)
{
    adcgs_json json;
    adcgs_json_init(&json);
    json.is_line = 1;
    json.digits = DIGITS;
    adcgs_json_open(&json, NULL, '{');
    adcgs_json_open(&json, "asset", '{');
    adcgs_json_string(&json, "version", "2.0");
    adcgs_json_string(&json, "generator", generator);
    adcgs_json_close(&json);
    list_one(&json, "extensionsUsed", ADCGS_GLB_SPLATS);
    adcgs_json_int(&json, "scene", 0);
    open_one(&json, "scenes");
    adcgs_json_open(&json, "nodes", '[');
    adcgs_json_int(&json, NULL, 0);
    adcgs_json_close(&json);
    close_one(&json);
    write_node(&json, s);
    write_mesh(&json);
    write_numbers(&json, s);
    adcgs_json_close(&json);
    return adcgs_json_write(&json, file, path, error);
}

/* ---- The file ---- */

static void put_word(FILE *file, uint32_t word)
{
    uint8_t bytes[4];
    adcgs_store_le32(bytes, word);
    fwrite(bytes, sizeof bytes, 1, file);
}

static void put_file(FILE *file, const adcgs_splats *s, const char *text, size_t bytes)
{
    const uint32_t padded = (uint32_t)((bytes + 3) / 4 * 4), numbers = 4 * FLOATS * s->n;
    fwrite("glTF\2\0\0", 8, 1, file);
    put_word(file, ADCGS_GLB_HEADER + 2 * ADCGS_GLB_CHUNK + padded + numbers);
    put_word(file, padded);
    put_word(file, ADCGS_GLB_JSON);
    fwrite(text, bytes, 1, file);
    for (size_t i = bytes; i < padded; i++)
        fputc(' ', file);
    put_word(file, numbers);
    put_word(file, ADCGS_GLB_BINARY);
    for (int k = 0; k < ATTRIBUTES; k++)
        for (uint32_t i = 0; i < s->n; i++) {
            uint8_t record[16];
            for (int c = 0; c < attributes[k].n; c++)
                adcgs_store_le32(record + 4 * c, adcgs_float_bits(value_of(s, i, k, c)));
            fwrite(record, (size_t)4 * (size_t)attributes[k].n, 1, file);
        }
}

adcgs_status adcgs_glb_put(const adcgs_splats *splats, const adcgs_splats_style *style, FILE *file, const char *path,
                           adcgs_error *error)
{
    char *text = NULL;
    size_t bytes = 0;
    if (!splats->n)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: glTF holds at least one splat", path);
    FILE *const memory = open_memstream(&text, &bytes);
    if (!memory)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    const adcgs_status status = write_json(memory, splats, style->comment, path, error);
    fclose(memory);
    if (status == ADCGS_OK)
        put_file(file, splats, text, bytes);
    free(text);
    return status;
}

#else

adcgs_status adcgs_glb_put(const adcgs_splats *splats, const adcgs_splats_style *style, FILE *file, const char *path,
                           adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: this build has no glTF: it needs jansson", path);
}

#endif

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Reading the conformance manifest. Unknown members are refused: a misspelt expectation must not pass as met. */
#include "config.h"

#include "apps/conform/conform.h"

#include "base/digest.h"
#include "scene/camera_json.h"

#include <errno.h>
#include <stdlib.h>

static const struct {
    const char *name;
    adcgs_status status;
} classes[] = {{"data", ADCGS_ERR_DATA},
               {"truncated", ADCGS_ERR_TRUNCATED},
               {"unsupported", ADCGS_ERR_UNSUPPORTED},
               {"limit", ADCGS_ERR_LIMIT}};

int adcgs_vector_class(const char *name, adcgs_status *status)
{
    for (size_t i = 0; i < ADCGS_COUNTOF(classes); i++)
        if (!strcmp(name, classes[i].name)) {
            *status = classes[i].status;
            return 0;
        }
    return -1;
}

const char *adcgs_vector_class_name(adcgs_status status)
{
    for (size_t i = 0; i < ADCGS_COUNTOF(classes); i++)
        if (classes[i].status == status)
            return classes[i].name;
    return "none";
}

void adcgs_hex_of(const void *data, size_t bytes, char hex[ADCGS_HEX])
{
    adcgs_md5 md5;
    uint8_t digest[16];
    adcgs_md5_init(&md5);
    adcgs_md5_update(&md5, data, bytes);
    adcgs_md5_final(&md5, digest);
    adcgs_md5_hex(digest, hex);
}

static adcgs_status bad(const adcgs_vector *v, const char *what, adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_DATA, "manifest: %s: %s", v->id, what);
}

static int copy_hex(char out[ADCGS_HEX], const char *text)
{
    if (!text || strlen(text) != ADCGS_HEX - 1 || strspn(text, "0123456789abcdef") != ADCGS_HEX - 1)
        return -1;
    memcpy(out, text, ADCGS_HEX);
    return 0;
}

static int copy_text(char *out, size_t size, const char *text)
{
    return snprintf(out, size, "%s", text) >= (int)size;
}

/* Requires an array of least to most elements. */
static adcgs_status check_array(const adcgs_vector *v, const json_t *array, size_t least, size_t most, adcgs_error *error)
{
    if (json_is_array(array) && json_array_size(array) >= least && json_array_size(array) <= most)
        return ADCGS_OK;
    return adcgs_fail(error, ADCGS_ERR_DATA, "manifest: %s: an array should have %zu to %zu elements", v->id, least, most);
}

static adcgs_status read_models(adcgs_vector *v, const json_t *models, adcgs_error *error)
{
    ADCGS_TRY(check_array(v, models, 1, ADCGS_VECTOR_MODELS, error));
    for (v->n_models = 0; v->n_models < (int)json_array_size(models); v->n_models++)
        if (copy_hex(v->models[v->n_models], json_string_value(json_array_get(models, (size_t)v->n_models))) != 0)
            return bad(v, "a model is not an MD5", error);
    return ADCGS_OK;
}

static adcgs_status read_camera(adcgs_vector *v, adcgs_camera *c, json_t *object, adcgs_error *error)
{
    const char *name;
    json_t *pose;
    json_error_t where;
    if (json_unpack_ex(object, &where, JSON_STRICT, "{s:s, s:i, s:i, s:F, s:F, s:F, s:F, s:F, s:o}", "name", &name, "width",
                       &c->width, "height", &c->height, "fx", &c->fx, "fy", &c->fy, "cx", &c->cx, "cy", &c->cy, "near",
                       &c->near_plane, "cam_to_world", &pose) != 0)
        return bad(v, where.text, error);
    snprintf(c->name, sizeof c->name, "%s", name);
    ADCGS_TRY(check_array(v, pose, ADCGS_COUNTOF(c->cam_to_world), ADCGS_COUNTOF(c->cam_to_world), error));
    for (size_t i = 0; i < ADCGS_COUNTOF(c->cam_to_world); i++)
        c->cam_to_world[i] = json_number_value(json_array_get(pose, i));
    return ADCGS_OK;
}

static adcgs_status read_splats(adcgs_vector *v, const json_t *splats, adcgs_error *error)
{
    ADCGS_TRY(check_array(v, splats, 1, ADCGS_VECTOR_TIMES, error));
    for (v->n_splats = 0; v->n_splats < (int)json_array_size(splats); v->n_splats++) {
        const char *md5;
        json_error_t where;
        if (json_unpack_ex(json_array_get(splats, (size_t)v->n_splats), &where, JSON_STRICT, "{s:F, s:s}", "time",
                           &v->splats[v->n_splats].time, "md5", &md5) != 0)
            return bad(v, where.text, error);
        if (copy_hex(v->splats[v->n_splats].md5, md5) != 0)
            return bad(v, "splats have a digest that is not an MD5", error);
    }
    return ADCGS_OK;
}

static adcgs_status read_frames(adcgs_vector *v, const json_t *frames, adcgs_error *error)
{
    ADCGS_TRY(check_array(v, frames, 1, ADCGS_VECTOR_FRAMES, error));
    for (v->n_frames = 0; v->n_frames < (int)json_array_size(frames); v->n_frames++) {
        const char *md5;
        json_error_t where;
        const int i = v->n_frames;
        if (json_unpack_ex(json_array_get(frames, (size_t)i), &where, JSON_STRICT, "{s:i, s:F, s:s}", "camera",
                           &v->frames[i].camera, "time", &v->frames[i].time, "md5", &md5) != 0)
            return bad(v, where.text, error);
        if (strcmp(md5, ADCGS_REFUSED) == 0)
            copy_text(v->frames[i].md5, ADCGS_HEX, md5);
        else if (copy_hex(v->frames[i].md5, md5) != 0)
            return bad(v, "a frame has a bad MD5", error);
        if (v->frames[i].camera < 0 || v->frames[i].camera >= v->n_cameras)
            return bad(v, "a frame has no such camera", error);
    }
    return ADCGS_OK;
}

static adcgs_status read_fewer(adcgs_vector *v, json_t *entry, adcgs_error *error)
{
    adcgs_fewer *const to = &v->fewer[v->n_fewer++];
    adcgs_vector *const read = calloc(1, sizeof *read); /* its lists of models and splats have the same form */
    json_t *models, *splats;
    json_error_t where;
    adcgs_status status = ADCGS_OK;
    if (!read)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "manifest: out of memory");
    memcpy(read->id, v->id, sizeof read->id);
    if (json_unpack_ex(entry, &where, JSON_STRICT, "{s:i, s:o, s:o}", "layers", &to->layers, "M", &models, "S", &splats) != 0)
        status = bad(v, where.text, error);
    if (status == ADCGS_OK)
        status = read_models(read, models, error);
    if (status == ADCGS_OK)
        status = read_splats(read, splats, error);
    to->n_models = read->n_models;
    to->n_splats = read->n_splats;
    memcpy(to->models, read->models, sizeof to->models);
    memcpy(to->splats, read->splats, sizeof to->splats);
    free(read);
    return status;
}

static adcgs_status read_expected(adcgs_vector *v, json_t *expect, adcgs_error *error)
{
    const char *trace;
    int elements;
    json_t *models, *splats, *frames, *fewer = NULL;
    json_error_t where;
    if (json_unpack_ex(expect, &where, JSON_STRICT, "{s:{s:i, s:s}, s:o, s:o, s:o, s?o}", "P", "elements", &elements, "trace_md5",
                       &trace, "M", &models, "S", &splats, "R", &frames, "L", &fewer) != 0)
        return bad(v, where.text, error);
    if (copy_hex(v->trace, trace) != 0 || elements < 1)
        return bad(v, "the trace has no elements or no MD5", error);
    v->elements = (uint32_t)elements;
    ADCGS_TRY(read_models(v, models, error));
    ADCGS_TRY(read_splats(v, splats, error));
    if (fewer)
        ADCGS_TRY(check_array(v, fewer, 1, ADCGS_VECTOR_LAYERS, error));
    for (size_t i = 0; fewer && i < json_array_size(fewer); i++)
        ADCGS_TRY(read_fewer(v, json_array_get(fewer, i), error));
    return read_frames(v, frames, error);
}

static adcgs_status read_good(adcgs_vector *v, json_t *props, const json_t *cameras, json_t *expect, adcgs_error *error)
{
    int bytes, anchors, segments, frames;
    json_error_t where;
    ADCGS_TRY(check_array(v, cameras, 1, ADCGS_VECTOR_CAMERAS, error));
    for (v->n_cameras = 0; v->n_cameras < (int)json_array_size(cameras); v->n_cameras++)
        ADCGS_TRY(read_camera(v, &v->cameras[v->n_cameras], json_array_get(cameras, (size_t)v->n_cameras), error));
    ADCGS_TRY(read_expected(v, expect, error));
    if (json_unpack_ex(props, &where, JSON_STRICT, "{s:i, s:i, s:i, s:i, s:b}", "bytes", &bytes, "anchors", &anchors, "segments",
                       &segments, "frames", &frames, "truncated", &v->truncated) != 0)
        return bad(v, where.text, error);
    if (segments != v->n_models || frames != v->n_frames)
        return bad(v, "props does not match the expected results", error);
    return ADCGS_OK;
}

/* Requires a list of requirements that is not empty. */
static adcgs_status check_requirements(const adcgs_vector *v, const json_t *list, adcgs_error *error)
{
    ADCGS_TRY(check_array(v, list, 1, 64, error));
    for (size_t i = 0; i < json_array_size(list); i++) {
        const char *const text = json_string_value(json_array_get(list, i));
        if (!text || strncmp(text, "REQ-", 4))
            return bad(v, "requirements begin with REQ-", error);
    }
    return ADCGS_OK;
}

static adcgs_status read_vector(adcgs_vector *v, json_t *object, int index, adcgs_error *error)
{
    const char *id, *file, *recipe, *md5, *title, *verdict, *status = NULL;
    json_t *violates = NULL, *covers = NULL, *props = NULL, *cameras = NULL, *expect = NULL;
    json_error_t where;
    if (json_unpack_ex(object, &where, JSON_STRICT, "{s:s, s:s, s:s, s:s, s:s, s:i, s:s, s?s, s?o, s?o, s:o, s?o, s?o}", "id",
                       &id, "file", &file, "recipe", &recipe, "title", &title, "md5", &md5, "level", &v->level, "verdict",
                       &verdict, "status", &status, "violates", &violates, "covers", &covers, "props", &props, "cameras",
                       &cameras, "expect", &expect) != 0)
        return adcgs_fail(error, ADCGS_ERR_DATA, "manifest: vector %d: %s", index, where.text);
    if (copy_text(v->id, sizeof v->id, id) || copy_text(v->file, sizeof v->file, file) || file[0] == '/' || strstr(file, "..") ||
        copy_hex(v->md5, md5) != 0)
        return adcgs_fail(error, ADCGS_ERR_DATA, "manifest: vector %d: bad name, file or MD5", index);
    snprintf(v->title, sizeof v->title, "%s", title);
    if (strncmp(id, verdict, strlen(verdict)) || id[strlen(verdict)] != '-' || v->level < 1 || v->level > 3)
        return bad(v, "its name does not begin with its verdict, or it has no level", error);
    if (!strcmp(verdict, "good") && !status && !violates) {
        ADCGS_TRY(check_requirements(v, covers, error));
        return read_good(v, props, cameras, expect, error);
    }
    ADCGS_TRY(check_requirements(v, violates, error));
    if (!status || covers || cameras || expect || adcgs_vector_class(status, &v->status) != 0)
        return bad(v, "a vector that is not good has a status and no expectations", error);
    const char *const fitting = v->status == ADCGS_ERR_LIMIT ? "limit" : v->status == ADCGS_ERR_UNSUPPORTED ? "unsup" : "bad";
    return strcmp(verdict, fitting) ? bad(v, "verdict and status do not match", error) : ADCGS_OK;
}

static adcgs_status read_root(adcgs_manifest *m, json_t *root, const char *path, adcgs_error *error)
{
    int format = 0;
    json_t *list = NULL;
    json_error_t where;
    if (json_unpack_ex(root, &where, JSON_STRICT, "{s:i, s:o}", "format", &format, "vectors", &list) != 0)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %s", path, where.text);
    if (format != 1)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: format %d, expected 1", path, format);
    m->vectors = calloc(json_array_size(list) + 1, sizeof *m->vectors);
    if (!m->vectors)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    for (; m->n < (int)json_array_size(list); m->n++)
        ADCGS_TRY(read_vector(&m->vectors[m->n], json_array_get(list, (size_t)m->n), m->n, error));
    return m->n > 0 ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_DATA, "%s: no vectors", path);
}

adcgs_status adcgs_manifest_read(adcgs_manifest *out, const char *path, adcgs_error *error)
{
    json_t *root;
    const char *const slash = strrchr(path, '/');
    *out = (adcgs_manifest){NULL, 0, NULL};
    ADCGS_TRY(adcgs_json_load(&root, path, error));
    out->directory = slash ? strndup(path, (size_t)(slash - path)) : strdup(".");
    const adcgs_status status =
        out->directory ? read_root(out, root, path, error) : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    json_decref(root);
    if (status != ADCGS_OK)
        adcgs_manifest_clear(out);
    return status;
}

void adcgs_manifest_clear(adcgs_manifest *manifest)
{
    free(manifest->directory);
    free(manifest->vectors);
    *manifest = (adcgs_manifest){NULL, 0, NULL};
}

adcgs_status adcgs_vector_load(const adcgs_manifest *manifest, const adcgs_vector *vector, uint8_t **data, size_t *bytes,
                               adcgs_error *error)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", manifest->directory, vector->file);
    FILE *const file = fopen(path, "rb");
    if (!file)
        return adcgs_fail(error, ADCGS_ERR_IO, "%.160s: cannot open: %s", path, strerror(errno));
    const long size = fseek(file, 0, SEEK_END) == 0 ? ftell(file) : -1;
    *data = size >= 0 ? malloc((size_t)size + 1) : NULL;
    *bytes = size >= 0 ? (size_t)size : 0;
    rewind(file);
    const int good = *data && fread(*data, 1, *bytes, file) == *bytes;
    fclose(file);
    if (good)
        return ADCGS_OK;
    free(*data);
    *data = NULL;
    return adcgs_fail(error, ADCGS_ERR_IO, "%.160s: cannot read", path);
}

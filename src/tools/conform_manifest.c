/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Reading the conformance manifest. Unknown members are refused: a misspelt expectation must not pass for a met one. */
#include "config.h"

#include "tools/conform.h"

#include <errno.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>

int adcgs_vector_class(const char *name, adcgs_status *status)
{
    static const struct {
        const char *name;
        adcgs_status status;
    } classes[] = {{"data", ADCGS_ERR_DATA}, {"truncated", ADCGS_ERR_TRUNCATED}, {"unsupported", ADCGS_ERR_UNSUPPORTED},
                   {"limit", ADCGS_ERR_LIMIT}};
    for (size_t i = 0; i < ADCGS_COUNTOF(classes); i++)
        if (!strcmp(name, classes[i].name)) {
            *status = classes[i].status;
            return 0;
        }
    return -1;
}

static int copy_hex(char out[ADCGS_HEX], const char *text)
{
    if (strlen(text) != ADCGS_HEX - 1 || strspn(text, "0123456789abcdef") != ADCGS_HEX - 1)
        return -1;
    memcpy(out, text, ADCGS_HEX);
    return 0;
}

static adcgs_status read_models(adcgs_vector *v, const json_t *models, adcgs_error *error)
{
    if (json_array_size(models) > ADCGS_VECTOR_MODELS)
        return adcgs_fail(error, ADCGS_ERR_DATA, "manifest: %s: more than %d models", v->file, ADCGS_VECTOR_MODELS);
    v->n_models = (int)json_array_size(models);
    for (int i = 0; i < v->n_models; i++) {
        const char *const text = json_string_value(json_array_get(models, (size_t)i));
        if (!text || copy_hex(v->models[i], text) != 0)
            return adcgs_fail(error, ADCGS_ERR_DATA, "manifest: %s: model %d is not an MD5", v->file, i);
    }
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
        return adcgs_fail(error, ADCGS_ERR_DATA, "manifest: %s: camera: %s", v->file, where.text);
    snprintf(c->name, sizeof c->name, "%s", name);
    if (json_array_size(pose) != ADCGS_COUNTOF(c->cam_to_world))
        return adcgs_fail(error, ADCGS_ERR_DATA, "manifest: %s: cam_to_world has not 12 numbers", v->file);
    for (size_t i = 0; i < ADCGS_COUNTOF(c->cam_to_world); i++)
        c->cam_to_world[i] = json_number_value(json_array_get(pose, i));
    return ADCGS_OK;
}

static adcgs_status read_frame(adcgs_vector *v, int i, json_t *object, adcgs_error *error)
{
    const char *md5;
    json_error_t where;
    if (json_unpack_ex(object, &where, JSON_STRICT, "{s:i, s:F, s:s}", "camera", &v->frames[i].camera, "time", &v->frames[i].time,
                       "md5", &md5) != 0)
        return adcgs_fail(error, ADCGS_ERR_DATA, "manifest: %s: frame %d: %s", v->file, i, where.text);
    if (copy_hex(v->frames[i].md5, md5) != 0 || v->frames[i].camera < 0 || v->frames[i].camera >= v->n_cameras)
        return adcgs_fail(error, ADCGS_ERR_DATA, "manifest: %s: frame %d: bad MD5 or no such camera", v->file, i);
    return ADCGS_OK;
}

static adcgs_status read_good(adcgs_vector *v, const json_t *models, const json_t *cameras, const json_t *frames,
                              adcgs_error *error)
{
    if (json_array_size(models) == 0)
        return adcgs_fail(error, ADCGS_ERR_DATA, "manifest: %s: a good vector names its models", v->file);
    if (json_array_size(cameras) > ADCGS_VECTOR_CAMERAS || json_array_size(frames) > ADCGS_VECTOR_FRAMES)
        return adcgs_fail(error, ADCGS_ERR_DATA, "manifest: %s: more than %d cameras or %d frames", v->file, ADCGS_VECTOR_CAMERAS,
                          ADCGS_VECTOR_FRAMES);
    ADCGS_TRY(read_models(v, models, error));
    v->n_cameras = (int)json_array_size(cameras);
    v->n_frames = (int)json_array_size(frames);
    for (int i = 0; i < v->n_cameras; i++)
        ADCGS_TRY(read_camera(v, &v->cameras[i], json_array_get(cameras, (size_t)i), error));
    for (int i = 0; i < v->n_frames; i++)
        ADCGS_TRY(read_frame(v, i, json_array_get(frames, (size_t)i), error));
    return ADCGS_OK;
}

static adcgs_status read_vector(adcgs_vector *v, json_t *object, int index, adcgs_error *error)
{
    const char *file, *md5, *title, *verdict, *status = NULL;
    json_t *models = NULL, *cameras = NULL, *frames = NULL;
    json_error_t where;
    if (json_unpack_ex(object, &where, JSON_STRICT, "{s:s, s:s, s:s, s:s, s?s, s?o, s?o, s?o}", "file", &file, "md5", &md5,
                       "title", &title, "verdict", &verdict, "status", &status, "models", &models, "cameras", &cameras, "frames",
                       &frames) != 0)
        return adcgs_fail(error, ADCGS_ERR_DATA, "manifest: vector %d: %s", index, where.text);
    if (snprintf(v->file, sizeof v->file, "%s", file) >= (int)sizeof v->file || file[0] == '/' || strstr(file, "..") ||
        copy_hex(v->md5, md5) != 0)
        return adcgs_fail(error, ADCGS_ERR_DATA, "manifest: vector %d: bad file name or MD5", index);
    snprintf(v->title, sizeof v->title, "%s", title);
    if (!strcmp(verdict, "good") && !status)
        return read_good(v, models, cameras, frames, error);
    if (!strcmp(verdict, "bad") && status && !models && !cameras && !frames && adcgs_vector_class(status, &v->status) == 0)
        return ADCGS_OK;
    return adcgs_fail(error, ADCGS_ERR_DATA, "manifest: %s: expected verdict good, or bad with a status and nothing else",
                      v->file);
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
    json_error_t where;
    const char *const slash = strrchr(path, '/');
    *out = (adcgs_manifest){NULL, 0, NULL};
    json_t *const root = json_load_file(path, JSON_REJECT_DUPLICATES, &where);
    if (!root)
        return adcgs_fail(error, where.line < 0 ? ADCGS_ERR_IO : ADCGS_ERR_DATA, "%s: %s", path, where.text);
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
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot open: %s", path, strerror(errno));
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
    return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot read", path);
}

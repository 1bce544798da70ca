/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The camera fields that transforms files and camera paths share. */
#include "config.h"

#include "scene/camera_json.h"

#include "media/image/image.h"
#include "media/kind.h"
#include "scene/pose_check.h"
#include "system/file.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

/* Bounds of valid files, far above any capture; chosen by hand, not measured. */
#define FILE_MAX ((uint64_t)256 << 20) /* bytes */
#define FRAMES_MAX 1000000             /* frames of a file */
#define TERM_MAX 1e6                   /* largest magnitude of a distortion coefficient */
#define FOCAL_MIN 1e-3                 /* pixels */
#define FOCAL_MAX 1e9                  /* pixels */
#define ANGLE_MIN 1e-6                 /* radians: least field of view */
#define ANGLE_MAX 3.14159              /* radians: just below a half turn, geometry */

/** Reports the kind of a file that does not begin like JSON, if it is known, else jansson's error. */
static adcgs_status refuse_text(const char *path, const uint8_t *text, const json_error_t *where, adcgs_error *error)
{
    const adcgs_kind *const kind = adcgs_kind_at(path);
    while (*text == ' ' || *text == '\t' || *text == '\r' || *text == '\n')
        text++;
    if (kind->class != ADCGS_KIND_UNKNOWN && *text != '{' && *text != '[')
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %s, expected JSON", path, kind->name);
    return adcgs_fail(error, ADCGS_ERR_DATA, "%s: line %d: malformed JSON: %s", path, where->line, where->text);
}

adcgs_status adcgs_json_load(json_t **root, const char *path, adcgs_error *error)
{
    uint8_t *text;
    size_t bytes;
    json_error_t where;
    *root = NULL;
    ADCGS_TRY(adcgs_file_load_text(&text, &bytes, path, FILE_MAX, error));
    if (!bytes) {
        free(text);
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: empty, expected JSON", path);
    }
    json_t *value = json_loadb((const char *)text, bytes, JSON_REJECT_DUPLICATES, &where);
    const adcgs_status status = value ? ADCGS_OK : refuse_text(path, text, &where, error);
    free(text);
    ADCGS_TRY(status);
    if (!json_is_object(value)) {
        json_decref(value);
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: expected a JSON object", path);
    }
    *root = value;
    return ADCGS_OK;
}

static const char *list_name(const adcgs_json_place *at)
{
    return at->list ? at->list : "frames";
}

adcgs_status adcgs_json_bad(const adcgs_json_place *at, adcgs_status status, const char *field, const char *format, ...)
{
    char what[160];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    if (at->frame && (json_object_get(at->frame, field) || !json_object_get(at->root, field)))
        return adcgs_fail(at->error, status, "%s: %s[%zu].%s: %s", at->path, list_name(at), at->index, field, what);
    return adcgs_fail(at->error, status, "%s: %s: %s", at->path, field, what);
}

json_t *adcgs_json_find(const adcgs_json_place *at, const char *field)
{
    json_t *own = at->frame ? json_object_get(at->frame, field) : NULL;
    return own ? own : json_object_get(at->root, field);
}

adcgs_status adcgs_json_number(const adcgs_json_place *at, const char *field, double min, double max, double *value, int *found)
{
    json_t *item = adcgs_json_find(at, field);
    *found = 0;
    if (!item)
        return ADCGS_OK;
    if (!json_is_number(item))
        return adcgs_json_bad(at, ADCGS_ERR_DATA, field, "expected a number");
    const double v = json_number_value(item);
    if (!(v >= min && v <= max))
        return adcgs_json_bad(at, ADCGS_ERR_DATA, field, "%g, expected %g to %g", v, min, max);
    *value = v;
    *found = 1;
    return ADCGS_OK;
}

adcgs_status adcgs_json_fps(const adcgs_json_place *at, const char *field, adcgs_fps *rate, int *found)
{
    const char *text = json_string_value(adcgs_json_find(at, field));
    double value;
    if (!text) {
        ADCGS_TRY(adcgs_json_number(at, field, ADCGS_FPS_MIN, ADCGS_FPS_MAX, &value, found));
        if (*found)
            *rate = adcgs_fps_of(value);
        return ADCGS_OK;
    }
    *found = 1;
    if (adcgs_fps_parse(text, rate))
        return adcgs_json_bad(at, ADCGS_ERR_DATA, field, "%.32s, expected frames per second as 30, 29.97 or 30000/1001", text);
    return ADCGS_OK;
}

/* ---- Camera models ---- */

enum { N_TERMS = 8 }; /* coefficients of a lens; literature: OpenCV's model */
static const char *const terms[N_TERMS] = {"k1", "k2", "k3", "k4", "k5", "k6", "p1", "p2"};

/** A camera model, with the number of its coefficients among k1 .. k6 and among p1, p2. */
typedef struct model {
    const char *name;
    int n_radial, n_tangential, is_fisheye;
} model;

static const model models[] = {
    {"OPENCV", 4, 2, 0},         {"OPENCV_FISHEYE", 4, 0, 1},        {"PINHOLE", 0, 0, 0},
    {"SIMPLE_PINHOLE", 0, 0, 0}, {"SIMPLE_RADIAL", 1, 0, 0},         {"RADIAL", 2, 0, 0},
    {"FULL_OPENCV", 6, 2, 0},    {"SIMPLE_RADIAL_FISHEYE", 1, 0, 1}, {"RADIAL_FISHEYE", 2, 0, 1},
};

/** Without a name: the first model, or the second if the file sets is_fisheye. */
static adcgs_status find_model(const adcgs_json_place *at, const model **out)
{
    json_t *item = adcgs_json_find(at, "camera_model");
    const int is_fisheye = json_is_true(adcgs_json_find(at, "is_fisheye"));
    const char *name = item ? json_string_value(item) : models[is_fisheye].name;
    if (!name)
        return adcgs_json_bad(at, ADCGS_ERR_DATA, "camera_model", "expected a string");
    for (size_t i = 0; i < ADCGS_COUNTOF(models); i++)
        if (!strcmp(name, models[i].name)) {
            *out = &models[i];
            if (is_fisheye && !models[i].is_fisheye)
                return adcgs_json_bad(at, ADCGS_ERR_DATA, "is_fisheye", "true, but camera_model is %s", name);
            return ADCGS_OK;
        }
    return adcgs_json_bad(at, ADCGS_ERR_UNSUPPORTED, "camera_model",
                          "%.32s is not supported, expected PINHOLE, SIMPLE_RADIAL, "
                          "RADIAL, OPENCV, FULL_OPENCV or OPENCV_FISHEYE",
                          name);
}

/** Refuses instant-ngp's fields for other projections, and skew, which has no agreed meaning here. */
static adcgs_status refuse_others(const adcgs_json_place *at)
{
    static const char *const kinds[] = {"ftheta_p0", "latlong", "equirectangular"};
    static const char *const skews[] = {"sk_x", "sk_y"};
    for (size_t i = 0; i < ADCGS_COUNTOF(kinds); i++) {
        json_t *item = adcgs_json_find(at, kinds[i]);
        if (item && !json_is_false(item) && !json_is_null(item))
            return adcgs_json_bad(at, ADCGS_ERR_UNSUPPORTED, kinds[i], "f-theta and panoramic cameras are not supported");
    }
    for (size_t i = 0; i < ADCGS_COUNTOF(skews); i++) {
        double value = 0.0;
        int found;
        ADCGS_TRY(adcgs_json_number(at, skews[i], -HUGE_VAL, HUGE_VAL, &value, &found));
        if (value != 0.0)
            return adcgs_json_bad(at, ADCGS_ERR_UNSUPPORTED, skews[i], "skewed pixels (%g) are not supported here", value);
    }
    return ADCGS_OK;
}

static adcgs_status read_terms(const adcgs_json_place *at, const model **out, double values[N_TERMS])
{
    ADCGS_TRY(find_model(at, out));
    ADCGS_TRY(refuse_others(at));
    for (int i = 0; i < N_TERMS; i++) {
        const int has = i < 6 ? i < (*out)->n_radial : i - 6 < (*out)->n_tangential;
        int found;
        values[i] = 0.0;
        ADCGS_TRY(adcgs_json_number(at, terms[i], -TERM_MAX, TERM_MAX, &values[i], &found));
        if (values[i] != 0.0 && !has)
            return adcgs_json_bad(at, ADCGS_ERR_DATA, terms[i], "%g, but camera_model %s has no %s", values[i], (*out)->name,
                                  terms[i]);
    }
    return ADCGS_OK;
}

adcgs_status adcgs_json_frames(const adcgs_json_place *at, json_t **frames, size_t *n)
{
    const char *name = list_name(at);
    *frames = json_object_get(at->root, name);
    *n = json_array_size(*frames);
    if (!json_is_array(*frames))
        return adcgs_json_bad(at, ADCGS_ERR_DATA, name, "expected an array");
    if (!*n)
        return adcgs_json_bad(at, ADCGS_ERR_DATA, name, "is empty");
    if (*n > FRAMES_MAX)
        return adcgs_json_bad(at, ADCGS_ERR_DATA, name, "%zu elements, expected at most %d", *n, FRAMES_MAX);
    return ADCGS_OK;
}

adcgs_status adcgs_json_size(const adcgs_json_place *at, adcgs_camera *camera, int *found)
{
    double w = 0.0, h = 0.0;
    int has_h;
    ADCGS_TRY(adcgs_json_number(at, "w", 1.0, ADCGS_IMAGE_MAX, &w, found));
    ADCGS_TRY(adcgs_json_number(at, "h", 1.0, ADCGS_IMAGE_MAX, &h, &has_h));
    if (*found != has_h)
        return adcgs_json_bad(at, ADCGS_ERR_DATA, has_h ? "w" : "h", "missing, expected both w and h or neither");
    if (w != floor(w) || h != floor(h))
        return adcgs_json_bad(at, ADCGS_ERR_DATA, w != floor(w) ? "w" : "h", "expected a whole number of pixels");
    if (*found) {
        camera->width = (int32_t)w;
        camera->height = (int32_t)h;
    }
    return ADCGS_OK;
}

/** Reads the focal length along an axis, in pixels; if it is absent, derives it from the field of view. */
static adcgs_status read_focal(const adcgs_json_place *at, const char *pixels, const char *angle, int size, double *focal,
                               int *found)
{
    double view = 0.0;
    ADCGS_TRY(adcgs_json_number(at, pixels, FOCAL_MIN, FOCAL_MAX, focal, found));
    if (*found)
        return ADCGS_OK;
    ADCGS_TRY(adcgs_json_number(at, angle, ANGLE_MIN, ANGLE_MAX, &view, found));
    if (*found)
        *focal = 0.5 * size / tan(0.5 * view);
    return ADCGS_OK;
}

static adcgs_status read_pinhole(const adcgs_json_place *at, adcgs_camera *camera)
{
    int found;
    ADCGS_TRY(read_focal(at, "fl_x", "camera_angle_x", camera->width, &camera->fx, &found));
    if (!found)
        return adcgs_json_bad(at, ADCGS_ERR_DATA, "fl_x", "missing, expected fl_x or camera_angle_x");
    ADCGS_TRY(read_focal(at, "fl_y", "camera_angle_y", camera->height, &camera->fy, &found));
    if (!found)
        camera->fy = camera->fx;
    camera->cx = 0.5 * camera->width;
    camera->cy = 0.5 * camera->height;
    ADCGS_TRY(adcgs_json_number(at, "cx", -1e6, 1e6, &camera->cx, &found));
    return adcgs_json_number(at, "cy", -1e6, 1e6, &camera->cy, &found);
}

adcgs_status adcgs_json_intrinsics(const adcgs_json_place *at, adcgs_camera *camera)
{
    const model *its;
    double values[N_TERMS];
    ADCGS_TRY(read_terms(at, &its, values));
    if (its->is_fisheye)
        return adcgs_json_bad(at, ADCGS_ERR_UNSUPPORTED, "camera_model", "%s, expected a pinhole camera", its->name);
    for (int i = 0; i < N_TERMS; i++)
        if (values[i] != 0.0)
            return adcgs_json_bad(at, ADCGS_ERR_UNSUPPORTED, terms[i], "lens distortion %g, expected a pinhole camera",
                                  values[i]);
    return read_pinhole(at, camera);
}

adcgs_status adcgs_json_lens(const adcgs_json_place *at, adcgs_lens *lens)
{
    adcgs_camera camera = {.width = lens->width, .height = lens->height};
    const model *its;
    double values[N_TERMS];
    ADCGS_TRY(read_terms(at, &its, values));
    if (its->is_fisheye && !adcgs_json_find(at, "fl_x"))
        return adcgs_json_bad(at, ADCGS_ERR_DATA, "fl_x", "missing: a fisheye lens needs fl_x, its field of view is not enough");
    ADCGS_TRY(read_pinhole(at, &camera));
    *lens = (adcgs_lens){.width = camera.width,
                         .height = camera.height,
                         .fx = camera.fx,
                         .fy = camera.fy,
                         .cx = camera.cx,
                         .cy = camera.cy,
                         .p = {values[6], values[7]},
                         .is_fisheye = its->is_fisheye};
    memcpy(lens->k, values, sizeof lens->k);
    if (its == &models[0]) { /* nerfstudio's polynomial */
        lens->k8 = lens->k[3];
        lens->k[3] = 0.0;
    }
    return ADCGS_OK;
}

adcgs_status adcgs_json_pose(const adcgs_json_place *at, adcgs_camera *camera)
{
    static const double last_row[4] = {0.0, 0.0, 0.0, 1.0};
    const char *field = "transform_matrix";
    json_t *matrix = json_object_get(at->frame, field);
    const size_t rows = json_array_size(matrix);
    if (rows != 3 && rows != 4)
        return adcgs_json_bad(at, ADCGS_ERR_DATA, field, "expected 4 rows of 4 numbers");
    for (size_t i = 0; i < rows; i++) {
        json_t *row = json_array_get(matrix, i);
        if (json_array_size(row) != 4)
            return adcgs_json_bad(at, ADCGS_ERR_DATA, field, "expected 4 rows of 4 numbers");
        for (size_t j = 0; j < 4; j++) {
            json_t *item = json_array_get(row, j);
            if (!json_is_number(item))
                return adcgs_json_bad(at, ADCGS_ERR_DATA, field, "row %zu column %zu: expected a number", i, j);
            const double value = json_number_value(item);
            if (i < 3)
                camera->cam_to_world[4 * i + j] = value;
            else if (fabs(value - last_row[j]) > ADCGS_POSE_TOLERANCE)
                return adcgs_json_bad(at, ADCGS_ERR_DATA, field, "the last row must be 0 0 0 1");
        }
    }
    const char *wrong = adcgs_pose_from_opengl(camera->cam_to_world);
    return wrong ? adcgs_json_bad(at, ADCGS_ERR_DATA, field, "%s", wrong) : ADCGS_OK;
}

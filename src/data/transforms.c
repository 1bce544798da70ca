/* SPDX-License-Identifier: BSD-2-Clause */
/** \file transforms*.json of D-NeRF and nerfstudio. */
#include "config.h"

#include "data/transforms.h"

#include "data/pose.h"
#include "io/file.h"

#include <jansson.h>

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

#define FILE_MAX ((uint64_t)256 << 20)
#define FRAMES_MAX 1000000
#define TEST_EVERY 8

/** Where we are, for messages and for fields that frames inherit. */
typedef struct place {
    const char *path;   /**< of the JSON file */
    const char *folder; /**< of it, with the slash at its end */
    json_t *root;
    json_t *frame; /**< NULL: at the root */
    size_t index;
    int width, height; /**< of the images, for frames that do not say; 0: not known yet */
    adcgs_error *error;
} place;

static adcgs_status bad(const place *at, adcgs_status status, const char *field, const char *format, ...) ADCGS_PRINTF(4, 5);
static adcgs_status bad(const place *at, adcgs_status status, const char *field, const char *format, ...)
{
    char what[160];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    if (at->frame)
        return adcgs_fail(at->error, status, "%s: frames[%zu].%s: %s", at->path, at->index, field, what);
    return adcgs_fail(at->error, status, "%s: %s: %s", at->path, field, what);
}

/** A field of the frame, or else of the whole file. */
static json_t *find(const place *at, const char *field)
{
    json_t *own = at->frame ? json_object_get(at->frame, field) : NULL;
    return own ? own : json_object_get(at->root, field);
}

/** Leaves *value alone and *found 0 when the field is not there. */
static adcgs_status number(const place *at, const char *field, double min, double max, double *value, int *found)
{
    json_t *item = find(at, field);
    *found = 0;
    if (!item)
        return ADCGS_OK;
    if (!json_is_number(item))
        return bad(at, ADCGS_ERR_DATA, field, "expected a number");
    const double v = json_number_value(item);
    if (!(v >= min && v <= max))
        return bad(at, ADCGS_ERR_DATA, field, "%g, expected %g to %g", v, min, max);
    *value = v;
    *found = 1;
    return ADCGS_OK;
}

static adcgs_status check_model(const place *at)
{
    static const char *const distortions[] = {"k1", "k2", "k3", "k4", "p1", "p2"};
    json_t *model = find(at, "camera_model");
    if (model) {
        const char *name = json_string_value(model);
        if (!name)
            return bad(at, ADCGS_ERR_DATA, "camera_model", "expected a string");
        if (strcmp(name, "PINHOLE") && strcmp(name, "SIMPLE_PINHOLE") && strcmp(name, "OPENCV"))
            return bad(at, ADCGS_ERR_UNSUPPORTED, "camera_model", "%.32s, expected PINHOLE or OPENCV without distortion", name);
    }
    if (json_is_true(find(at, "is_fisheye")))
        return bad(at, ADCGS_ERR_UNSUPPORTED, "is_fisheye", "fisheye cameras are not supported");
    for (size_t i = 0; i < ADCGS_COUNTOF(distortions); i++) {
        double value = 0.0;
        int found;
        ADCGS_TRY(number(at, distortions[i], -HUGE_VAL, HUGE_VAL, &value, &found));
        if (found && value != 0.0)
            return bad(at, ADCGS_ERR_UNSUPPORTED, distortions[i], "lens distortion %g is not supported, undistort the images first", value);
    }
    return ADCGS_OK;
}

static int is_file(const char *path)
{
    struct stat status;
    return !stat(path, &status) && S_ISREG(status.st_mode);
}

/** folder + name + extension, allocated. Absolute names stand for themselves. */
static char *join(const char *folder, const char *name, const char *extension)
{
    while (name[0] == '.' && name[1] == '/')
        name += 2;
    if (*name == '/')
        folder = "";
    const size_t size = strlen(folder) + strlen(name) + strlen(extension) + 1;
    char *path = malloc(size);
    if (path)
        snprintf(path, size, "%s%s%s", folder, name, extension);
    return path;
}

/** The image's file: as named, or with an extension that makes it exist. */
static adcgs_status find_image(const place *at, char **out)
{
    static const char *const extensions[] = {"", ".png", ".jpg", ".jpeg", ".exr", ".tif", ".tiff", ".webp", ".ppm"};
    const char *name = json_string_value(json_object_get(at->frame, "file_path"));
    if (!name || !*name)
        return bad(at, ADCGS_ERR_DATA, "file_path", "expected the name of an image");
    for (size_t i = 0; i < ADCGS_COUNTOF(extensions); i++) {
        char *path = join(at->folder, name, extensions[i]);
        if (!path)
            return bad(at, ADCGS_ERR_MEMORY, "file_path", "out of memory");
        if (is_file(path)) {
            *out = path;
            return ADCGS_OK;
        }
        free(path);
    }
    return bad(at, ADCGS_ERR_DATA, "file_path", "no such image: %.100s", name);
}

static adcgs_status read_size(place *at, const char *image, adcgs_camera *camera)
{
    double w = 0.0, h = 0.0;
    int has_w, has_h;
    ADCGS_TRY(number(at, "w", 1.0, ADCGS_IMAGE_MAX, &w, &has_w));
    ADCGS_TRY(number(at, "h", 1.0, ADCGS_IMAGE_MAX, &h, &has_h));
    if (has_w != has_h)
        return bad(at, ADCGS_ERR_DATA, has_w ? "h" : "w", "missing, expected both w and h or neither");
    if (has_w && (w != floor(w) || h != floor(h)))
        return bad(at, ADCGS_ERR_DATA, "w", "expected whole numbers of pixels");
    if (!has_w && !at->width) {
        int channels;
        ADCGS_TRY(adcgs_image_probe(&at->width, &at->height, &channels, image, at->error));
    }
    camera->width = has_w ? (int32_t)w : at->width;
    camera->height = has_h ? (int32_t)h : at->height;
    return ADCGS_OK;
}

/** Focal length of an axis from pixels, or else from the field of view. */
static adcgs_status read_focal(const place *at, const char *pixels, const char *angle, int size, double *focal, int *found)
{
    double view = 0.0;
    ADCGS_TRY(number(at, pixels, 1e-3, 1e9, focal, found));
    if (*found)
        return ADCGS_OK;
    ADCGS_TRY(number(at, angle, 1e-6, 3.14159, &view, found));
    if (*found)
        *focal = 0.5 * size / tan(0.5 * view);
    return ADCGS_OK;
}

static adcgs_status read_intrinsics(place *at, const char *image, adcgs_camera *camera)
{
    int found;
    ADCGS_TRY(check_model(at));
    ADCGS_TRY(read_size(at, image, camera));
    ADCGS_TRY(read_focal(at, "fl_x", "camera_angle_x", camera->width, &camera->fx, &found));
    if (!found)
        return bad(at, ADCGS_ERR_DATA, "fl_x", "missing, expected fl_x or camera_angle_x");
    ADCGS_TRY(read_focal(at, "fl_y", "camera_angle_y", camera->height, &camera->fy, &found));
    if (!found)
        camera->fy = camera->fx;
    camera->cx = 0.5 * camera->width;
    camera->cy = 0.5 * camera->height;
    ADCGS_TRY(number(at, "cx", -1e6, 1e6, &camera->cx, &found));
    return number(at, "cy", -1e6, 1e6, &camera->cy, &found);
}

static adcgs_status read_pose(const place *at, adcgs_camera *camera)
{
    static const double last_row[4] = {0.0, 0.0, 0.0, 1.0};
    const char *field = "transform_matrix";
    json_t *matrix = json_object_get(at->frame, field);
    const size_t rows = json_array_size(matrix);
    if (rows != 3 && rows != 4)
        return bad(at, ADCGS_ERR_DATA, field, "expected 4 rows of 4 numbers");
    for (size_t i = 0; i < rows; i++) {
        json_t *row = json_array_get(matrix, i);
        if (json_array_size(row) != 4)
            return bad(at, ADCGS_ERR_DATA, field, "expected 4 rows of 4 numbers");
        for (size_t j = 0; j < 4; j++) {
            json_t *item = json_array_get(row, j);
            if (!json_is_number(item))
                return bad(at, ADCGS_ERR_DATA, field, "row %zu column %zu: expected a number", i, j);
            const double value = json_number_value(item);
            if (i < 3)
                camera->cam_to_world[4 * i + j] = value;
            else if (fabs(value - last_row[j]) > ADCGS_POSE_TOLERANCE)
                return bad(at, ADCGS_ERR_DATA, field, "the last row must be 0 0 0 1");
        }
    }
    const char *wrong = adcgs_pose_from_opengl(camera->cam_to_world);
    return wrong ? bad(at, ADCGS_ERR_DATA, field, "%s", wrong) : ADCGS_OK;
}

/** The file's name without folder and extension. */
static void set_name(adcgs_camera *camera, const char *path)
{
    const char *slash = strrchr(path, '/');
    snprintf(camera->name, sizeof camera->name, "%s", slash ? slash + 1 : path);
    char *dot = strrchr(camera->name, '.');
    if (dot && dot != camera->name)
        *dot = 0;
}

/** On failure view->path is freed. */
static adcgs_status read_view(place *at, adcgs_scene_view *view, adcgs_transforms *out)
{
    int found;
    if (!json_is_object(at->frame))
        return adcgs_fail(at->error, ADCGS_ERR_DATA, "%s: frames[%zu]: expected an object", at->path, at->index);
    json_t *time = json_object_get(at->frame, "time");
    if (at->index == 0)
        out->has_times = time != NULL;
    else if (out->has_times != (time != NULL))
        return bad(at, ADCGS_ERR_DATA, "time", time ? "given, but missing in frames[0]" : "missing, but given in frames[0]");
    if (time)
        ADCGS_TRY(number(at, "time", 0.0, 1.0, &view->time, &found));
    ADCGS_TRY(read_pose(at, &view->camera));
    ADCGS_TRY(find_image(at, &view->path));
    const adcgs_status status = read_intrinsics(at, view->path, &view->camera);
    if (status != ADCGS_OK) {
        free(view->path);
        view->path = NULL;
        return status;
    }
    set_name(&view->camera, view->path);
    return ADCGS_OK;
}

static int lists(json_t *names, const char *name)
{
    size_t i;
    json_t *item;
    json_array_foreach(names, i, item)
    {
        const char *text = json_string_value(item);
        if (text && !strcmp(text, name))
            return 1;
    }
    return 0;
}

/** Where a frame of an undivided file belongs; ADCGS_SPLITS: nowhere, when the file lists names and not this one. */
static adcgs_split choose_split(const place *at)
{
    static const char *const fields[ADCGS_SPLITS] = {"train_filenames", "val_filenames", "test_filenames"};
    if (!json_object_get(at->root, fields[ADCGS_SPLIT_TRAIN]))
        return at->index % TEST_EVERY == 0 ? ADCGS_SPLIT_TEST : ADCGS_SPLIT_TRAIN;
    const char *name = json_string_value(json_object_get(at->frame, "file_path"));
    for (int split = 0; split < ADCGS_SPLITS; split++)
        if (name && lists(json_object_get(at->root, fields[split]), name))
            return (adcgs_split)split;
    return ADCGS_SPLITS;
}

static adcgs_status read_frames(place *at, adcgs_scene *scene, adcgs_transforms *out, adcgs_split split)
{
    json_t *frames = json_object_get(at->root, "frames");
    const size_t n = json_array_size(frames);
    if (!json_is_array(frames) || !n)
        return bad(at, ADCGS_ERR_DATA, "frames", json_is_array(frames) ? "is empty" : "expected an array");
    if (n > FRAMES_MAX)
        return bad(at, ADCGS_ERR_DATA, "frames", "%zu frames, expected at most %d", n, FRAMES_MAX);
    for (int s = 0; s < ADCGS_SPLITS; s++)
        if ((split == ADCGS_SPLITS || (int)split == s) && !(scene->views[s] = calloc(n, sizeof *scene->views[s])))
            return bad(at, ADCGS_ERR_MEMORY, "frames", "out of memory");
    for (size_t i = 0; i < n; i++) {
        adcgs_scene_view view = {.time = 0.0};
        at->index = i;
        at->frame = json_array_get(frames, i);
        ADCGS_TRY(read_view(at, &view, out));
        const adcgs_split to = split == ADCGS_SPLITS ? choose_split(at) : split;
        if (to == ADCGS_SPLITS)
            free(view.path);
        else
            scene->views[to][scene->n_views[to]++] = view;
    }
    at->frame = NULL;
    return ADCGS_OK;
}

static adcgs_status read_root(place *at, adcgs_scene *scene, adcgs_transforms *out, adcgs_split split)
{
    int found;
    if (!json_is_object(at->root))
        return adcgs_fail(at->error, ADCGS_ERR_DATA, "%s: expected a JSON object", at->path);
    ADCGS_TRY(number(at, "fps", 1e-3, 1e4, &out->frame_rate, &found));
    json_t *points = json_object_get(at->root, "ply_file_path");
    if (points) {
        const char *name = json_string_value(points);
        if (!name)
            return bad(at, ADCGS_ERR_DATA, "ply_file_path", "expected a string");
        if (!(out->points_path = join(at->folder, name, "")))
            return bad(at, ADCGS_ERR_MEMORY, "ply_file_path", "out of memory");
        if (!is_file(out->points_path))
            return bad(at, ADCGS_ERR_DATA, "ply_file_path", "no such file: %.100s", name);
    }
    return read_frames(at, scene, out, split);
}

adcgs_status adcgs_transforms_read(adcgs_scene *scene, adcgs_transforms *out, const char *path, adcgs_split split,
                                   adcgs_error *error)
{
    uint8_t *text;
    size_t bytes;
    json_error_t where;
    *out = (adcgs_transforms){0};
    ADCGS_TRY(adcgs_file_load(&text, &bytes, path, FILE_MAX, error));
    json_t *root = json_loadb((const char *)text, bytes, JSON_REJECT_DUPLICATES, &where);
    free(text);
    if (!root)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: line %d: malformed JSON: %s", path, where.line, where.text);
    char *folder = strdup(path);
    if (folder) {
        char *slash = strrchr(folder, '/');
        folder[slash ? slash - folder + 1 : 0] = 0;
    }
    place at = {.path = path, .folder = folder, .root = root, .error = error};
    const adcgs_status status = folder ? read_root(&at, scene, out, split)
                                       : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    free(folder);
    json_decref(root);
    if (status != ADCGS_OK) {
        free(out->points_path);
        out->points_path = NULL;
    }
    return status;
}

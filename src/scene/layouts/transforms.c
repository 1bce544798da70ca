/* SPDX-License-Identifier: BSD-2-Clause */
/** \file transforms*.json of D-NeRF and nerfstudio. */
#include "config.h"

#include "scene/layouts/transforms.h"

#include "scene/camera_json.h"
#include "scene/layouts/calibration.h"
#include "media/listing.h"
#include "scene/layouts/transforms_clock.h"
#include "scene/layouts/transforms_files.h"
#include "scene/layouts/view_lens.h"
#include "system/paths.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define TEST_EVERY 8  /* frames: one of them is for testing; literature: NeRF, 2020 */
#define TIME_MAX 1e20 /* largest magnitude of a time, in units of the file: nanoseconds since 1970 are below */

typedef struct place {
    adcgs_json_place json;
    const char *folder;                                    /**< of the file, with its slash */
    adcgs_split split;                                     /**< of the frame; ADCGS_SPLITS: none */
    int width[ADCGS_SPLITS + 1], height[ADCGS_SPLITS + 1]; /**< size of a split's first image */
    int other_width, other_height;                         /**< size of an image that differs from it; 0: none does */
} place;

/** Finds the image's file: by its name, or at another possible location. */
static adcgs_status find_image(const place *at, const adcgs_scene *scene, char **out)
{
    const char *name = json_string_value(json_object_get(at->json.frame, "file_path"));
    *out = NULL;
    if (!name || !*name)
        return adcgs_json_bad(&at->json, ADCGS_ERR_DATA, "file_path", "expected the name of an image");
    ADCGS_TRY(adcgs_transforms_find(out, at->folder, name, at->json.error));
    if (!*out && scene->is_outline && adcgs_is_image_name(name))
        return (*out = adcgs_transforms_join(at->folder, name)) /* the file may exist elsewhere */
                   ? ADCGS_OK
                   : adcgs_json_bad(&at->json, ADCGS_ERR_MEMORY, "file_path", "out of memory");
    if (!*out && adcgs_is_windows_path(name))
        return adcgs_json_bad(&at->json, ADCGS_ERR_DATA, "file_path",
                              "no such image: %.60s, a Windows path, nor an image of "
                              "its name next to this file or in images",
                              name);
    return *out ? ADCGS_OK : adcgs_json_bad(&at->json, ADCGS_ERR_DATA, "file_path", "no such image: %.100s", name);
}

/** Finds the file of a mask named by the field of the frame or of the whole file; NULL if there is none. */
static adcgs_status find_mask(const place *at, const adcgs_scene *scene, const char *field, char **out)
{
    json_t *item = adcgs_json_find(&at->json, field);
    const char *name = json_string_value(item);
    *out = NULL;
    if (!item || json_is_null(item))
        return ADCGS_OK;
    if (!name || !*name)
        return adcgs_json_bad(&at->json, ADCGS_ERR_DATA, field, "expected the name of an image");
    ADCGS_TRY(adcgs_transforms_find(out, at->folder, name, at->json.error));
    if (*out)
        return ADCGS_OK;
    if (!scene->is_outline)
        return adcgs_json_bad(&at->json, ADCGS_ERR_DATA, field, "no such image: %.100s", name);
    *out = adcgs_transforms_join(at->folder, name);
    return *out ? ADCGS_OK : adcgs_json_bad(&at->json, ADCGS_ERR_MEMORY, field, "out of memory");
}

/** Finds the size of the view's image; if its file is elsewhere, the size of the first image of its split. */
static adcgs_status probe_size(place *at, const adcgs_scene *scene, const adcgs_scene_view *view, int *width, int *height)
{
    int channels, *first_width = &at->width[at->split], *first_height = &at->height[at->split];
    if (scene->is_outline && *first_width && !adcgs_is_there(view->path)) {
        *width = *first_width;
        *height = *first_height;
        return ADCGS_OK;
    }
    ADCGS_TRY(adcgs_image_probe(width, height, &channels, view->path, at->json.error));
    if (!*first_width) {
        *first_width = *width;
        *first_height = *height;
    } else if (*width != *first_width || *height != *first_height) {
        at->other_width = *width;
        at->other_height = *height;
    }
    return ADCGS_OK;
}

/** Scales numbers for images of w x h pixels to the image, which must have the same shape to a pixel of either. */
static adcgs_status fit_size(const place *at, const adcgs_scene_view *view, adcgs_lens *lens, int width, int height)
{
    const double x = (double)width / lens->width, y = (double)height / lens->height, slack = fmax(1.0, fmax(x, y));
    if (width == lens->width && height == lens->height)
        return ADCGS_OK;
    if (fabs(width - y * lens->width) > slack && fabs(height - x * lens->height) > slack)
        return adcgs_fail(at->json.error, ADCGS_ERR_DATA,
                          "%s: %dx%d pixels, expected %dx%d, w and h of frames[%zu] in %s, "
                          "or the same aspect ratio: check whether it was cropped or rotated",
                          view->path, width, height, lens->width, lens->height, at->json.index, at->json.path);
    adcgs_lens_resize(lens, width, height);
    return ADCGS_OK;
}

#define ANGLE_SLACK 0.1 /* tolerance, relative to the focal length; chosen by hand, not measured */

/** Checks that camera_angle_x, which programs for Blender's scenes use, agrees with fl_x, which others use, if both are given. */
static adcgs_status check_angle(const place *at, const adcgs_lens *lens)
{
    json_t *const own = json_object_get(at->json.frame, "fl_x") ? at->json.frame : at->json.root;
    json_t *const angle = json_object_get(own, "camera_angle_x");
    if (!json_object_get(own, "fl_x") || !json_is_number(angle) || lens->is_fisheye)
        return ADCGS_OK;
    const double focal = 0.5 * lens->width / tan(0.5 * json_number_value(angle));
    if (fabs(focal - lens->fx) <= ANGLE_SLACK * lens->fx)
        return ADCGS_OK;
    return adcgs_json_bad(&at->json, ADCGS_ERR_DATA, "fl_x",
                          "%g, but camera_angle_x %g is %g at a width of %d pixels: "
                          "nerfstudio uses the first, others the second; remove one",
                          lens->fx, json_number_value(angle), focal, lens->width);
}

/** Reads the lens and derives its pinhole. */
static adcgs_status read_camera(place *at, const adcgs_scene *scene, adcgs_scene_view *view)
{
    adcgs_camera said;
    int found, width = 0, height = 0;
    ADCGS_TRY(adcgs_json_size(&at->json, &said, &found));
    if (!found || !scene->is_outline || adcgs_is_there(view->path))
        ADCGS_TRY(probe_size(at, scene, view, &width, &height));
    view->lens.width = found ? said.width : width;
    view->lens.height = found ? said.height : height;
    ADCGS_TRY(adcgs_json_lens(&at->json, &view->lens));
    ADCGS_TRY(check_angle(at, &view->lens));
    if (width)
        ADCGS_TRY(fit_size(at, view, &view->lens, width, height));
    char *where = adcgs_path("%s: frames[%zu]", at->json.path, at->json.index);
    const adcgs_status status = where ? adcgs_view_lens(scene, view, where, at->json.error)
                                      : adcgs_fail(at->json.error, ADCGS_ERR_MEMORY, "%s: out of memory", at->json.path);
    free(where);
    return status;
}

/** On failure nothing of the view remains allocated. */
static adcgs_status read_view(place *at, const adcgs_scene *scene, adcgs_scene_view *view, adcgs_transforms *out)
{
    int found;
    if (!json_is_object(at->json.frame))
        return adcgs_fail(at->json.error, ADCGS_ERR_DATA, "%s: frames[%zu]: expected an object", at->json.path, at->json.index);
    json_t *time = json_object_get(at->json.frame, "time");
    time = json_is_null(time) ? NULL : time;
    if (at->json.index == 0)
        out->has_times = time != NULL;
    else if (out->has_times != (time != NULL))
        return adcgs_json_bad(&at->json, ADCGS_ERR_DATA, "time", "%s in frames[0]",
                              time ? "given, but missing" : "missing, but given");
    if (time)
        ADCGS_TRY(adcgs_json_number(&at->json, "time", -TIME_MAX, TIME_MAX, &view->time, &found));
    ADCGS_TRY(adcgs_json_pose(&at->json, &view->camera));
    ADCGS_TRY(find_image(at, scene, &view->path));
    adcgs_status status = read_camera(at, scene, view);
    if (status == ADCGS_OK)
        status = find_mask(at, scene, "mask_path", &view->mask);
    if (status == ADCGS_OK)
        status = find_mask(at, scene, "moving_path", &view->moving);
    if (status != ADCGS_OK) {
        adcgs_scene_view_clear(view);
        return status;
    }
    adcgs_stem(view->camera.name, sizeof view->camera.name, view->path);
    return ADCGS_OK;
}

/* ---- Lists of names ---- */

static const char *const lists[ADCGS_SPLITS] = {"train_filenames", "val_filenames", "test_filenames"};

/** Normalises a name from lists or frames for comparison, from malloc(). */
static char *plain_name(const char *name)
{
    while (name[0] == '.' && (name[1] == '/' || name[1] == '\\'))
        name += 2;
    char *plain = strdup(name);
    for (char *c = plain; c && (c = strchr(c, '\\'));)
        *c = '/';
    return plain;
}

/** Adds the names of one list to a table: a number with a bit for each split. */
static adcgs_status add_list(const place *at, json_t *table, int split)
{
    json_t *names = json_object_get(at->json.root, lists[split]), *item;
    size_t i;
    if (names && !json_is_array(names))
        return adcgs_json_bad(&at->json, ADCGS_ERR_DATA, lists[split], "expected an array of names");
    json_array_foreach(names, i, item)
    {
        const char *text = json_string_value(item);
        char *name = text ? plain_name(text) : NULL;
        const json_int_t before = name ? json_integer_value(json_object_get(table, name)) : 0;
        const int failed = text && (!name || json_object_set_new(table, name, json_integer(before | 1 << split)));
        free(name);
        if (!text)
            return adcgs_json_bad(&at->json, ADCGS_ERR_DATA, lists[split], "element %zu: expected a name", i);
        if (failed)
            return adcgs_json_bad(&at->json, ADCGS_ERR_MEMORY, lists[split], "out of memory");
        if ((before | 1 << split) == (1 << ADCGS_SPLIT_TRAIN | 1 << ADCGS_SPLIT_TEST))
            return adcgs_json_bad(&at->json, ADCGS_ERR_DATA, lists[split],
                                  "%.80s is in train_filenames, too: a view for testing "
                                  "must not be trained on",
                                  text);
    }
    return ADCGS_OK;
}

/** Makes the table of a file that lists names; NULL if it does not. */
static adcgs_status read_lists(const place *at, json_t **table)
{
    int found = 0;
    for (int split = 0; split < ADCGS_SPLITS; split++)
        found |= json_object_get(at->json.root, lists[split]) != NULL;
    *table = NULL;
    if (!found)
        return ADCGS_OK;
    if (!json_object_get(at->json.root, lists[ADCGS_SPLIT_TRAIN]))
        return adcgs_json_bad(&at->json, ADCGS_ERR_DATA, lists[ADCGS_SPLIT_TRAIN], "missing, but other splits have names");
    if (!(*table = json_object()))
        return adcgs_json_bad(&at->json, ADCGS_ERR_MEMORY, lists[ADCGS_SPLIT_TRAIN], "out of memory");
    adcgs_status status = ADCGS_OK;
    for (int split = 0; status == ADCGS_OK && split < ADCGS_SPLITS; split++)
        status = add_list(at, *table, split);
    if (status != ADCGS_OK) {
        json_decref(*table);
        *table = NULL;
    }
    return status;
}

/** Chooses the split of a frame in a file with all splits. ADCGS_SPLITS: none, if the file lists names without this one. */
static adcgs_status choose_split(const place *at, json_t *table, json_t *seen, adcgs_split *split)
{
    *split = at->json.index % TEST_EVERY == 0 ? ADCGS_SPLIT_TEST : ADCGS_SPLIT_TRAIN;
    if (!table)
        return ADCGS_OK;
    const char *text = json_string_value(json_object_get(at->json.frame, "file_path"));
    char *name = text ? plain_name(text) : NULL;
    const json_int_t in = name ? json_integer_value(json_object_get(table, name)) : 0;
    const int failed = text && (!name || json_object_set_new(seen, name, json_true()));
    free(name);
    if (failed)
        return adcgs_json_bad(&at->json, ADCGS_ERR_MEMORY, "file_path", "out of memory");
    *split = in & 1 << ADCGS_SPLIT_TRAIN  ? ADCGS_SPLIT_TRAIN
             : in & 1 << ADCGS_SPLIT_TEST ? ADCGS_SPLIT_TEST
             : in & 1 << ADCGS_SPLIT_VAL  ? ADCGS_SPLIT_VAL
                                          : ADCGS_SPLITS;
    return ADCGS_OK;
}

/** Refuses listed names without a frame, as nerfstudio does. */
static adcgs_status check_lists(const place *at, json_t *table, json_t *seen)
{
    const char *name;
    json_t *value;
    json_object_foreach(table, name, value)
    {
        const json_int_t in = json_integer_value(value);
        int split = 0;
        while (!(in & 1 << split))
            split++;
        if (!json_object_get(seen, name))
            return adcgs_json_bad(&at->json, ADCGS_ERR_DATA, lists[split], "%.100s is the file_path of no frame", name);
    }
    return ADCGS_OK;
}

/* ---- Frames ---- */

static adcgs_status add_frame(place *at, adcgs_scene *scene, adcgs_transforms *out, json_t *table, json_t *seen,
                              adcgs_split split)
{
    adcgs_scene_view view = {.time = 0.0};
    at->split = split;
    if (split == ADCGS_SPLITS)
        ADCGS_TRY(choose_split(at, table, seen, &at->split));
    ADCGS_TRY(read_view(at, scene, &view, out));
    if (at->split == ADCGS_SPLITS)
        adcgs_scene_view_clear(&view);
    else
        scene->views[at->split][scene->n_views[at->split]++] = view;
    return ADCGS_OK;
}

static adcgs_status read_frames(place *at, adcgs_scene *scene, adcgs_transforms *out, adcgs_split split)
{
    json_t *frames, *table = NULL, *seen = json_object();
    size_t n;
    adcgs_status status =
        seen ? adcgs_json_frames(&at->json, &frames, &n) : adcgs_json_bad(&at->json, ADCGS_ERR_MEMORY, "frames", "out of memory");
    if (status == ADCGS_OK && split == ADCGS_SPLITS)
        status = read_lists(at, &table);
    for (int s = 0; status == ADCGS_OK && s < ADCGS_SPLITS; s++)
        if ((split == ADCGS_SPLITS || (int)split == s) && !(scene->views[s] = calloc(n, sizeof *scene->views[s])))
            status = adcgs_json_bad(&at->json, ADCGS_ERR_MEMORY, "frames", "out of memory");
    for (size_t i = 0; status == ADCGS_OK && i < n; i++) {
        at->json.index = i;
        at->json.frame = json_array_get(frames, i);
        status = add_frame(at, scene, out, table, seen, split);
    }
    at->json.frame = NULL;
    if (status == ADCGS_OK && table)
        status = check_lists(at, table, seen);
    if (status == ADCGS_OK) {
        const char *const clock = adcgs_transforms_clock(frames, n);
        snprintf(out->clock, sizeof out->clock, "%s", clock ? clock : "");
        out->has_lists = table != NULL;
    }
    if (table)
        json_decref(table);
    json_decref(seen);
    return status;
}

/** If sizes differ, each image has its own size. Intrinsics in pixels shared by all images may be wrong for some. */
static void remark_sizes(const place *at, adcgs_scene *scene)
{
    if (!at->other_width || json_object_get(at->json.root, "w") || !json_object_get(at->json.root, "fl_x"))
        return;
    const adcgs_split split = scene->n_views[ADCGS_SPLIT_TRAIN] ? ADCGS_SPLIT_TRAIN : at->split;
    adcgs_scene_remark(scene,
                       "images have several sizes, such as %dx%d and %dx%d, and fl_x is one for all: it is used "
                       "unchanged; if some are reduced, give each frame w, h, fl_x, cx, cy",
                       at->width[split], at->height[split], at->other_width, at->other_height);
}

/** A missing file of points counts as none: training works without it. */
static adcgs_status find_points(const place *at, adcgs_scene *scene, adcgs_transforms *out)
{
    json_t *points = json_object_get(at->json.root, "ply_file_path");
    const char *name = json_string_value(points);
    if (!points || json_is_null(points))
        return ADCGS_OK;
    if (!name)
        return adcgs_json_bad(&at->json, ADCGS_ERR_DATA, "ply_file_path", "expected a string");
    if (!(out->points_path = adcgs_transforms_join(at->folder, name)))
        return adcgs_json_bad(&at->json, ADCGS_ERR_MEMORY, "ply_file_path", "out of memory");
    if (adcgs_is_there(out->points_path))
        return ADCGS_OK;
    free(out->points_path);
    out->points_path = NULL;
    adcgs_scene_remark(scene, "ply_file_path: there is no %.100s; training starts without these points", name);
    return ADCGS_OK;
}

static adcgs_status read_root(place *at, adcgs_scene *scene, adcgs_transforms *out, adcgs_split split)
{
    int found;
    ADCGS_TRY(adcgs_json_fps(&at->json, "fps", &out->rate, &found));
    if (split == ADCGS_SPLIT_TRAIN || split == ADCGS_SPLITS) /* only the training split decides */
        ADCGS_TRY(find_points(at, scene, out));
    ADCGS_TRY(read_frames(at, scene, out, split));
    remark_sizes(at, scene);
    return ADCGS_OK;
}

adcgs_status adcgs_transforms_read(adcgs_scene *scene, adcgs_transforms *out, const char *path, adcgs_split split,
                                   adcgs_error *error)
{
    json_t *root;
    *out = (adcgs_transforms){0};
    ADCGS_TRY(adcgs_json_load(&root, path, error));
    char *folder = strdup(path);
    if (folder) {
        char *slash = strrchr(folder, '/');
        folder[slash ? slash - folder + 1 : 0] = 0;
    }
    place at = {.json = {.path = path, .root = root, .error = error}, .folder = folder};
    const adcgs_status status =
        folder ? read_root(&at, scene, out, split) : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    free(folder);
    json_decref(root);
    if (status != ADCGS_OK) {
        free(out->points_path);
        out->points_path = NULL;
    }
    return status;
}

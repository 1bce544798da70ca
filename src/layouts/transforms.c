/* SPDX-License-Identifier: BSD-2-Clause */
/** \file transforms*.json of D-NeRF and nerfstudio. */
#include "config.h"

#include "layouts/transforms.h"

#include "data/camera_json.h"
#include "data/paths.h"
#include "layouts/listing.h"
#include "layouts/view_lens.h"

#include <stdio.h>
#include <stdlib.h>

#define TEST_EVERY 8

typedef struct place {
    adcgs_json_place json;
    const char *folder; /**< of the file, with the slash at its end */
    adcgs_split split;  /**< of the frame; ADCGS_SPLITS: of none */
    int width[ADCGS_SPLITS + 1], height[ADCGS_SPLITS + 1]; /**< of a split's first image, for frames that do not say */
} place;

/** folder + name, allocated. Absolute names stand for themselves. */
static char *join(const char *folder, const char *name)
{
    while (name[0] == '.' && name[1] == '/')
        name += 2;
    return adcgs_path("%s%s", *name == '/' ? "" : folder, name);
}

/** The image's file: as named, or with an extension that makes it exist. */
static adcgs_status find_image(const place *at, const adcgs_scene *scene, char **out)
{
    const char *name = json_string_value(json_object_get(at->json.frame, "file_path"));
    if (!name || !*name)
        return adcgs_json_bad(&at->json, ADCGS_ERR_DATA, "file_path", "expected the name of an image");
    char *stem = join(at->folder, name);
    const adcgs_status status = stem ? adcgs_find_image(out, stem, at->json.error)
                                     : adcgs_json_bad(&at->json, ADCGS_ERR_MEMORY, "file_path", "out of memory");
    if (status == ADCGS_OK && !*out && scene->is_outline && adcgs_is_image_name(stem)) {
        *out = stem; /* it may be elsewhere */
        return status;
    }
    free(stem);
    if (status == ADCGS_OK && !*out)
        return adcgs_json_bad(&at->json, ADCGS_ERR_DATA, "file_path", "no such image: %.100s", name);
    return status;
}

/** The file of a mask, as the field names it; NULL if the frame has none. */
static adcgs_status find_mask(const place *at, const adcgs_scene *scene, const char *field, char **out)
{
    json_t *item = json_object_get(at->json.frame, field);
    const char *name = json_string_value(item);
    *out = NULL;
    if (!item || json_is_null(item))
        return ADCGS_OK;
    if (!name || !*name)
        return adcgs_json_bad(&at->json, ADCGS_ERR_DATA, field, "expected the name of an image");
    *out = join(at->folder, name);
    if (*out && (scene->is_outline || adcgs_is_there(*out)))
        return ADCGS_OK;
    free(*out);
    if (!*out)
        return adcgs_json_bad(&at->json, ADCGS_ERR_MEMORY, field, "out of memory");
    *out = NULL;
    return adcgs_json_bad(&at->json, ADCGS_ERR_DATA, field, "no such image: %.100s", name);
}

/** The lens and the pinhole for it; w and h are the picture's as it was taken. */
static adcgs_status read_camera(place *at, const adcgs_scene *scene, adcgs_scene_view *view)
{
    adcgs_camera taken;
    int found;
    ADCGS_TRY(adcgs_json_size(&at->json, &taken, &found));
    int *width = &at->width[at->split], *height = &at->height[at->split];
    if (!found && !*width) {
        int channels;
        ADCGS_TRY(adcgs_image_probe(width, height, &channels, view->path, at->json.error));
    }
    view->lens.width = found ? taken.width : *width;
    view->lens.height = found ? taken.height : *height;
    ADCGS_TRY(adcgs_json_lens(&at->json, &view->lens));
    char *where = adcgs_path("%s: frames[%zu]", at->json.path, at->json.index);
    const adcgs_status status = where ? adcgs_view_lens(scene, view, where, at->json.error)
                                      : adcgs_fail(at->json.error, ADCGS_ERR_MEMORY, "%s: out of memory", at->json.path);
    free(where);
    return status;
}

/** On failure nothing of the view is left. */
static adcgs_status read_view(place *at, const adcgs_scene *scene, adcgs_scene_view *view, adcgs_transforms *out)
{
    int found;
    if (!json_is_object(at->json.frame))
        return adcgs_fail(at->json.error, ADCGS_ERR_DATA, "%s: frames[%zu]: expected an object", at->json.path, at->json.index);
    json_t *time = json_object_get(at->json.frame, "time");
    if (at->json.index == 0)
        out->has_times = time != NULL;
    else if (out->has_times != (time != NULL))
        return adcgs_json_bad(&at->json, ADCGS_ERR_DATA, "time", "%s in frames[0]",
                              time ? "given, but missing" : "missing, but given");
    if (time)
        ADCGS_TRY(adcgs_json_number(&at->json, "time", 0.0, 1.0, &view->time, &found));
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
    if (!json_object_get(at->json.root, fields[ADCGS_SPLIT_TRAIN]))
        return at->json.index % TEST_EVERY == 0 ? ADCGS_SPLIT_TEST : ADCGS_SPLIT_TRAIN;
    const char *name = json_string_value(json_object_get(at->json.frame, "file_path"));
    for (int split = 0; split < ADCGS_SPLITS; split++)
        if (name && lists(json_object_get(at->json.root, fields[split]), name))
            return (adcgs_split)split;
    return ADCGS_SPLITS;
}

static adcgs_status read_frames(place *at, adcgs_scene *scene, adcgs_transforms *out, adcgs_split split)
{
    json_t *frames;
    size_t n;
    ADCGS_TRY(adcgs_json_frames(&at->json, &frames, &n));
    for (int s = 0; s < ADCGS_SPLITS; s++)
        if ((split == ADCGS_SPLITS || (int)split == s) && !(scene->views[s] = calloc(n, sizeof *scene->views[s])))
            return adcgs_json_bad(&at->json, ADCGS_ERR_MEMORY, "frames", "out of memory");
    for (size_t i = 0; i < n; i++) {
        adcgs_scene_view view = {.time = 0.0};
        at->json.index = i;
        at->json.frame = json_array_get(frames, i);
        at->split = split == ADCGS_SPLITS ? choose_split(at) : split;
        ADCGS_TRY(read_view(at, scene, &view, out));
        if (at->split == ADCGS_SPLITS)
            adcgs_scene_view_clear(&view);
        else
            scene->views[at->split][scene->n_views[at->split]++] = view;
    }
    at->json.frame = NULL;
    return ADCGS_OK;
}

static adcgs_status read_root(place *at, adcgs_scene *scene, adcgs_transforms *out, adcgs_split split)
{
    int found;
    ADCGS_TRY(adcgs_json_fps(&at->json, "fps", &out->rate, &found));
    json_t *points = json_object_get(at->json.root, "ply_file_path");
    if (points) {
        const char *name = json_string_value(points);
        if (!name)
            return adcgs_json_bad(&at->json, ADCGS_ERR_DATA, "ply_file_path", "expected a string");
        if (!(out->points_path = join(at->folder, name)))
            return adcgs_json_bad(&at->json, ADCGS_ERR_MEMORY, "ply_file_path", "out of memory");
        if (!adcgs_is_there(out->points_path))
            return adcgs_json_bad(&at->json, ADCGS_ERR_DATA, "ply_file_path", "no such file: %.100s", name);
    }
    return read_frames(at, scene, out, split);
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

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Camera paths from JSON files. */
#include "config.h"

#include "camera/path_files.h"

#include "geometry/rotation.h"
#include "scene/camera_json.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define SECONDS_MAX 1e9 /* largest absolute value of a time, seconds; chosen by hand, not measured */

/** Input of the reader, and the position in the file. */
typedef struct reader {
    adcgs_json_place at;
    const adcgs_path_reader *of;
    const adcgs_info *info;
    const adcgs_camera_path_request *request;
    double near_plane; /* of cameras without one */
} reader;

/** Read a camera and its time; by default the time is after_begin seconds into the stream. */
static adcgs_status read_shot(const reader *r, double after_begin, const char *kind, adcgs_camera_frame *frame)
{
    const adcgs_json_place *at = &r->at;
    adcgs_camera *camera = &frame->camera;
    int found;
    frame->time = r->request->has_times ? r->request->begin : r->info->time_start + after_begin;
    if (json_object_get(at->frame, "time"))
        ADCGS_TRY(adcgs_json_number(at, "time", -SECONDS_MAX, SECONDS_MAX, &frame->time, &found));
    *camera = (adcgs_camera){.width = ADCGS_ORBIT_WIDTH, .height = ADCGS_ORBIT_HEIGHT, .near_plane = r->near_plane};
    snprintf(camera->name, sizeof camera->name, "%s %zu", kind, at->index);
    ADCGS_TRY(adcgs_json_size(at, camera, &found));
    ADCGS_TRY(adcgs_json_number(at, "near_plane", 1e-12, 1e12, &camera->near_plane, &found));
    ADCGS_TRY(adcgs_json_intrinsics(at, camera));
    return adcgs_json_pose(at, camera);
}

/** Enter element i of the array. */
static adcgs_status enter(reader *r, json_t *list, size_t i)
{
    r->at.index = i;
    r->at.frame = json_array_get(list, i);
    if (!json_is_object(r->at.frame))
        return adcgs_fail(r->at.error, ADCGS_ERR_DATA, "%s: %s[%zu]: expected an object", r->at.path, r->at.list, i);
    return ADCGS_OK;
}

/** Check for one size; sizes may differ only with --size, which fits them. */
static adcgs_status check_size(const reader *r, const adcgs_camera_frame *frame, const adcgs_camera_frame *first)
{
    if (!r->request->size[0] && (frame->camera.width != first->camera.width || frame->camera.height != first->camera.height))
        return adcgs_json_bad(&r->at, ADCGS_ERR_DATA, "w", "%s of one path must have one size; or use --size", r->at.list);
    return ADCGS_OK;
}

static adcgs_status read_frames(reader *r, adcgs_camera_path *out)
{
    json_t *frames;
    size_t n;
    r->at.list = "frames";
    ADCGS_TRY(adcgs_json_frames(&r->at, &frames, &n));
    ADCGS_TRY(adcgs_camera_path_alloc(out, (double)n, r->at.path, r->at.error));
    for (size_t i = 0; i < n; i++) {
        ADCGS_TRY(enter(r, frames, i));
        ADCGS_TRY(read_shot(r, (double)i / r->info->frame_rate, "frame", &out->frame[i]));
        ADCGS_TRY(check_size(r, &out->frame[i], &out->frame[0]));
    }
    return ADCGS_OK;
}

/* ---- Key frames ---- */

static adcgs_status read_key(reader *r, adcgs_camera_key *keys, size_t i)
{
    adcgs_camera_key *key = &keys[i];
    int found = 0;
    if (json_object_get(r->at.frame, "at"))
        ADCGS_TRY(adcgs_json_number(&r->at, "at", -SECONDS_MAX, SECONDS_MAX, &key->at, &found));
    if (!found)
        return adcgs_json_bad(&r->at, ADCGS_ERR_DATA, "at", "missing, expected seconds along the path");
    if (i && !(key->at >= key[-1].at + 1e-6))
        return adcgs_json_bad(&r->at, ADCGS_ERR_DATA, "at", "%g, expected more than the %g of the previous key", key->at,
                              key[-1].at);
    ADCGS_TRY(read_shot(r, key->at - keys[0].at, "key", &key->frame));
    ADCGS_TRY(check_size(r, &key->frame, &keys[0].frame));
    if (r->request->size[0]) /* lenses are comparable only at one size */
        adcgs_camera_fit(&key->frame.camera, r->request->size[0], r->request->size[1], r->request->fill);
    return ADCGS_OK;
}

static adcgs_status read_interpolation(const reader *r, int *linear)
{
    json_t *value = json_object_get(r->at.root, "interpolate");
    const char *name = value ? json_string_value(value) : "smooth";
    *linear = name && !strcmp(name, "linear");
    if (!name || (!*linear && strcmp(name, "smooth")))
        return adcgs_json_bad(&r->at, ADCGS_ERR_DATA, "interpolate", "expected \"smooth\" or \"linear\"");
    return ADCGS_OK;
}

static adcgs_status read_keys(reader *r, adcgs_camera_path *out)
{
    json_t *list;
    size_t n;
    int found, linear;
    r->at.list = "keys";
    out->frame_rate = r->info->frame_rate;
    ADCGS_TRY(adcgs_json_number(&r->at, "frame_rate", 1e-3, 1e4, &out->frame_rate, &found));
    ADCGS_TRY(read_interpolation(r, &linear));
    ADCGS_TRY(adcgs_json_frames(&r->at, &list, &n));
    adcgs_camera_key *keys = calloc(n, sizeof *keys);
    if (!keys)
        return adcgs_fail(r->at.error, ADCGS_ERR_MEMORY, "%s: out of memory for %zu keys", r->at.path, n);
    adcgs_status status = ADCGS_OK;
    for (size_t i = 0; i < n && status == ADCGS_OK; i++) {
        status = enter(r, list, i);
        if (status == ADCGS_OK)
            status = read_key(r, keys, i);
    }
    if (status == ADCGS_OK)
        status = adcgs_path_fly(r->of, keys, n, linear, out);
    free(keys);
    return status;
}

adcgs_status adcgs_path_json_read(adcgs_camera_path *out, const adcgs_path_reader *of)
{
    reader r = {{.path = of->path, .error = of->error}, of, of->info, of->request, of->like->near_plane};
    ADCGS_TRY(adcgs_json_load(&r.at.root, of->path, of->error));
    const int has_keys = json_object_get(r.at.root, "keys") != NULL;
    adcgs_status status;
    if (has_keys && json_object_get(r.at.root, "frames"))
        status = adcgs_json_bad(&r.at, ADCGS_ERR_DATA, "keys", "expected keys or frames, not both");
    else
        status = has_keys ? read_keys(&r, out) : read_frames(&r, out);
    json_decref(r.at.root);
    return status;
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Camera paths from JSON files. */
#include "config.h"

#include "tools/shots.h"

#include "data/camera_json.h"

#include <stdio.h>

static adcgs_status read_shot(const adcgs_json_place *at, const adcgs_info *info, const adcgs_shots_request *request,
                              double near_plane, adcgs_shot *shot)
{
    adcgs_camera *camera = &shot->camera;
    int found;
    if (!json_is_object(at->frame))
        return adcgs_fail(at->error, ADCGS_ERR_DATA, "%s: frames[%zu]: expected an object", at->path, at->index);
    shot->time = request->has_times ? request->begin : info->time_start + (double)at->index / info->frame_rate;
    if (json_object_get(at->frame, "time"))
        ADCGS_TRY(adcgs_json_number(at, "time", -1e9, 1e9, &shot->time, &found));
    camera->width = ADCGS_ORBIT_WIDTH;
    camera->height = ADCGS_ORBIT_HEIGHT;
    camera->near_plane = near_plane;
    snprintf(camera->name, sizeof camera->name, "frame %zu", at->index);
    ADCGS_TRY(adcgs_json_size(at, camera, &found));
    ADCGS_TRY(adcgs_json_number(at, "near_plane", 1e-12, 1e12, &camera->near_plane, &found));
    ADCGS_TRY(adcgs_json_intrinsics(at, camera));
    return adcgs_json_pose(at, camera);
}

static adcgs_status read_shots(adcgs_json_place *at, adcgs_shots *out, const adcgs_info *info,
                               const adcgs_shots_request *request, double near_plane)
{
    json_t *frames;
    size_t n;
    ADCGS_TRY(adcgs_json_frames(at, &frames, &n));
    ADCGS_TRY(adcgs_shots_alloc(out, (double)n, at->error));
    for (size_t i = 0; i < n; i++) {
        at->index = i;
        at->frame = json_array_get(frames, i);
        ADCGS_TRY(read_shot(at, info, request, near_plane, &out->shot[i]));
        if (!request->size[0] && (out->shot[i].camera.width != out->shot[0].camera.width ||
                                  out->shot[i].camera.height != out->shot[0].camera.height))
            return adcgs_json_bad(at, ADCGS_ERR_DATA, "w", "frames of one path must have one size; or use --size");
    }
    return ADCGS_OK;
}

adcgs_status adcgs_shots_read_path(adcgs_shots *out, const adcgs_info *info, const adcgs_shots_request *request,
                                   double near_plane, adcgs_error *error)
{
    adcgs_json_place at = {.path = request->camera, .error = error};
    if (request->has_times && request->begin != request->end)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "--time: a camera path takes one time, or none if it has its own");
    ADCGS_TRY(adcgs_json_load(&at.root, request->camera, error));
    const adcgs_status status = read_shots(&at, out, info, request, near_plane);
    json_decref(at.root);
    return status;
}

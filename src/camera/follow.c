/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Following a filmed path. */
#include "config.h"

#include "camera/follow.h"

#include "geometry/rotation.h"

#include <adcgs/decoder.h>

#include <stdlib.h>

adcgs_status adcgs_filmed_cameras_get(adcgs_filmed_camera **cameras, const adcgs_decoder *decoder, const adcgs_info *info,
                                      adcgs_error *error)
{
    adcgs_filmed_camera *const all = *cameras = calloc((size_t)info->cameras + 1, sizeof *all);
    if (!all)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for %d cameras", info->cameras);
    for (int i = 0; i < info->cameras; i++) {
        ADCGS_TRY(adcgs_get_camera(decoder, i, &all[i].camera, error));
        ADCGS_TRY(adcgs_get_camera_time(decoder, i, &all[i].time, &all[i].path, error));
    }
    return ADCGS_OK;
}

adcgs_status adcgs_follow_init(adcgs_follow *follow, const adcgs_filmed_camera *cameras, int n, int path, adcgs_error *error)
{
    int keys = 0;
    *follow = (adcgs_follow){.begin = 0};
    adcgs_camera_key *const key = calloc((size_t)n + 1, sizeof *key);
    if (!key)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for %d cameras", n);
    for (int i = 0; i < n; i++) {
        if (cameras[i].path != path)
            continue;
        key[keys].at = key[keys].frame.time = cameras[i].time;
        key[keys].frame.camera = cameras[i].camera;
        adcgs_camera_fit(&key[keys].frame.camera, key->frame.camera.width, key->frame.camera.height, 0);
        keys++;
    }
    if (keys) {
        follow->begin = key[0].at;
        follow->end = key[keys - 1].at;
    }
    const adcgs_status status = keys ? adcgs_camera_spline_init(&follow->spline, key, keys, 0, 0, error) : ADCGS_OK;
    free(key);
    return status;
}

void adcgs_follow_clear(adcgs_follow *follow)
{
    adcgs_camera_spline_clear(&follow->spline);
}

void adcgs_follow_at(const adcgs_follow *follow, double time, adcgs_camera *camera)
{
    adcgs_camera_frame frame;
    adcgs_camera_spline_at(&follow->spline, time, &frame);
    *camera = frame.camera;
}

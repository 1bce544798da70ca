/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Key frames as the file of a path, and the stored cameras as key frames to start from. */
#include "config.h"

#include "camera/path.h"
#include "camera/rotation.h"
#include "io/atomic.h"
#include "io/json.h"

#include <adcgs/decoder.h>

#include <stdlib.h>

/** Camera-to-world in OpenGL axes, row by row. */
static void write_matrix(adcgs_json *json, const double pose[12])
{
    adcgs_json_open(json, "transform_matrix", '[');
    for (int i = 0; i < 4; i++) {
        adcgs_json_open(json, NULL, '[');
        for (int j = 0; j < 4; j++) {
            const double value = i < 3 ? pose[4 * i + j] : j == 3;
            adcgs_json_real(json, NULL, i < 3 && (j == 1 || j == 2) ? 0.0 - value : value);
        }
        adcgs_json_close(json);
    }
    adcgs_json_close(json);
}

static void write_key(adcgs_json *json, const adcgs_camera_key *key, int has_time)
{
    const adcgs_camera *const camera = &key->frame.camera;
    adcgs_json_open(json, NULL, '{');
    adcgs_json_string(json, "name", camera->name);
    adcgs_json_real(json, "at", key->at);
    if (has_time)
        adcgs_json_real(json, "time", key->frame.time);
    adcgs_json_real(json, "fl_x", camera->fx);
    adcgs_json_real(json, "fl_y", camera->fy);
    adcgs_json_real(json, "cx", camera->cx);
    adcgs_json_real(json, "cy", camera->cy);
    adcgs_json_real(json, "near_plane", camera->near_plane);
    write_matrix(json, camera->cam_to_world);
    adcgs_json_close(json);
}

adcgs_status adcgs_camera_keys_write(const adcgs_camera_key *keys, int n, int has_times, double frame_rate, const char *path,
                                     adcgs_error *error)
{
    adcgs_atomic atomic;
    adcgs_json json;
    ADCGS_TRY(adcgs_atomic_open(&atomic, path, error));
    adcgs_json_init(&json);
    json.digits = 17; /* a camera that is read again is the same */
    adcgs_json_open(&json, NULL, '{');
    adcgs_json_string(&json, "interpolate", "smooth");
    adcgs_json_real(&json, "frame_rate", frame_rate);
    adcgs_json_int(&json, "w", keys[0].frame.camera.width);
    adcgs_json_int(&json, "h", keys[0].frame.camera.height);
    adcgs_json_open(&json, "keys", '[');
    for (int i = 0; i < n; i++)
        write_key(&json, &keys[i], has_times);
    adcgs_json_close(&json);
    adcgs_json_close(&json);
    const adcgs_status status = adcgs_json_write(&json, atomic.file, path, error);
    adcgs_json_clear(&json);
    if (status == ADCGS_OK)
        return adcgs_atomic_commit(&atomic, error);
    adcgs_atomic_abort(&atomic);
    return status;
}

adcgs_status adcgs_camera_path_write(const adcgs_decoder *decoder, const char *path, adcgs_error *error)
{
    adcgs_info info;
    ADCGS_TRY(adcgs_get_info(decoder, &info, sizeof info, error));
    if (!info.cameras)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: the stream stores no cameras to write", path);
    adcgs_camera_key *const keys = calloc((size_t)info.cameras, sizeof *keys);
    if (!keys)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %d cameras", path, info.cameras);
    adcgs_status status = ADCGS_OK;
    for (int i = 0; i < info.cameras && status == ADCGS_OK; i++) {
        adcgs_camera *const camera = &keys[i].frame.camera, *const first = &keys[0].frame.camera;
        keys[i].at = i;
        status = adcgs_get_camera(decoder, i, camera, error);
        adcgs_camera_fit(camera, first->width, first->height, 0); /* a path has one size */
    }
    if (status == ADCGS_OK)
        status = adcgs_camera_keys_write(keys, info.cameras, 0, info.frame_rate, path, error);
    free(keys);
    return status;
}

/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Writing key frames as a path in JSON. */
#include "config.h"

#include "camera/path_files.h"
#include "system/atomic.h"
#include "system/json.h"

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

adcgs_status adcgs_path_json_write(const adcgs_camera_key *keys, int n, int has_times, double frame_rate, const char *path,
                                   adcgs_error *error)
{
    adcgs_atomic atomic;
    adcgs_json json;
    ADCGS_TRY(adcgs_atomic_open(&atomic, path, error));
    adcgs_json_init(&json);
    json.digits = 17; /* reading the camera again gives the same values */
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

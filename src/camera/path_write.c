/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The stored cameras as a camera path to start from. */
#include "config.h"

#include "camera/path.h"
#include "camera/rotation.h"
#include "io/atomic.h"
#include "io/json.h"

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

static void write_key(adcgs_json *json, const adcgs_camera *camera, int index)
{
    adcgs_json_open(json, NULL, '{');
    adcgs_json_string(json, "name", camera->name);
    adcgs_json_real(json, "at", index);
    adcgs_json_real(json, "fl_x", camera->fx);
    adcgs_json_real(json, "fl_y", camera->fy);
    adcgs_json_real(json, "cx", camera->cx);
    adcgs_json_real(json, "cy", camera->cy);
    adcgs_json_real(json, "near_plane", camera->near_plane);
    write_matrix(json, camera->cam_to_world);
    adcgs_json_close(json);
}

adcgs_status adcgs_shots_write_path(const adcgs_decoder *decoder, const char *path, adcgs_error *error)
{
    adcgs_info info;
    adcgs_atomic atomic;
    adcgs_json json;
    ADCGS_TRY(adcgs_get_info(decoder, &info));
    if (!info.cameras)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: the stream stores no cameras to write", path);
    ADCGS_TRY(adcgs_atomic_open(&atomic, path, error));
    adcgs_camera camera;
    adcgs_status status = adcgs_get_camera(decoder, 0, &camera);
    const int size[2] = {camera.width, camera.height};
    adcgs_json_init(&json);
    json.digits = 17; /* a camera that is read again is the same */
    adcgs_json_open(&json, NULL, '{');
    adcgs_json_string(&json, "interpolate", "smooth");
    adcgs_json_real(&json, "frame_rate", info.frame_rate);
    adcgs_json_int(&json, "w", size[0]);
    adcgs_json_int(&json, "h", size[1]);
    adcgs_json_open(&json, "keys", '[');
    for (int i = 0; i < info.cameras && status == ADCGS_OK; i++) {
        status = adcgs_get_camera(decoder, i, &camera);
        adcgs_camera_fit(&camera, size[0], size[1], 0); /* a path has one size */
        write_key(&json, &camera, i);
    }
    adcgs_json_close(&json);
    adcgs_json_close(&json);
    if (status == ADCGS_OK)
        status = adcgs_json_write(&json, atomic.file, path, error);
    adcgs_json_clear(&json);
    if (status == ADCGS_OK)
        return adcgs_atomic_commit(&atomic, error);
    adcgs_atomic_abort(&atomic);
    return status;
}

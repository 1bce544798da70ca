/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Formats of path files, and writing a path. */
#include "config.h"

#include "camera/path_files.h"

#include "geometry/rotation.h"
#include "system/extension.h"

#include <adcgs/decoder.h>

#include <stdlib.h>
#include <strings.h>

static int is_usd(const char *path)
{
    const char *const extension = adcgs_extension(path);
    return !strcasecmp(extension, "usda") || !strcasecmp(extension, "usd") || !strcasecmp(extension, "usdc");
}

static int is_chan(const char *path)
{
    return !strcasecmp(adcgs_extension(path), "chan");
}

adcgs_status adcgs_camera_path_read(adcgs_camera_path *out, const adcgs_info *info, const adcgs_camera_path_request *request,
                                    const adcgs_camera *like, adcgs_error *error)
{
    const adcgs_path_reader r = {request->camera, info, request, like, error};
    if (request->has_times && request->begin != request->end)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "--time: a camera path takes one time, or none if it has its own");
    if (is_usd(r.path))
        return adcgs_path_usd_read(out, &r);
    return is_chan(r.path) ? adcgs_path_chan_read(out, &r) : adcgs_path_json_read(out, &r);
}

adcgs_status adcgs_camera_keys_write(const adcgs_camera_key *keys, int n, int has_times, const adcgs_info *info,
                                     double frame_rate, adcgs_rotation_order order, const char *path, adcgs_error *error)
{
    if (is_usd(path) && strcasecmp(adcgs_extension(path), "usda"))
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: USD is written as text: expected .usda", path);
    if (is_usd(path))
        return adcgs_path_usd_write(keys, n, has_times, frame_rate, info, path, error);
    return is_chan(path) ? adcgs_path_chan_write(keys, n, frame_rate, order, path, error)
                         : adcgs_path_json_write(keys, n, has_times, frame_rate, path, error);
}

/** Fit all cameras to the size of the first: a path has one size. */
static void fit_size(adcgs_camera_key *keys, int n)
{
    for (int i = 1; i < n; i++)
        adcgs_camera_fit(&keys[i].frame.camera, keys[0].frame.camera.width, keys[0].frame.camera.height, 0);
}

/** The keys of the filmed path, *timed 1, or all stored cameras. *n: their number, on entry that of the stored cameras. */
static adcgs_status fill_stored(adcgs_camera_key *keys, const adcgs_decoder *decoder, int *n, int *timed, adcgs_error *error)
{
    const int all = *n;
    double time;
    int path;
    *n = *timed = 0;
    for (int i = 0; i < all; i++) {
        ADCGS_TRY(adcgs_get_camera_time(decoder, i, &time, &path, error));
        if (path != 0)
            continue;
        keys[*n].at = keys[*n].frame.time = time;
        ADCGS_TRY(adcgs_get_camera(decoder, i, &keys[(*n)++].frame.camera, error));
    }
    *timed = *n > 0;
    for (int i = 0; i < all && !*timed; i++) {
        keys[i].at = i;
        ADCGS_TRY(adcgs_get_camera(decoder, i, &keys[i].frame.camera, error));
    }
    *n = *timed ? *n : all;
    return ADCGS_OK;
}

static adcgs_status fill_frames(adcgs_camera_key *keys, const adcgs_camera_path *frames)
{
    for (int i = 0; i < frames->n; i++)
        keys[i] = (adcgs_camera_key){.at = i / frames->frame_rate, .frame = frames->frame[i]};
    return ADCGS_OK;
}

adcgs_status adcgs_camera_path_write(const adcgs_decoder *decoder, const adcgs_camera_path *frames, adcgs_rotation_order order,
                                     const char *path, adcgs_error *error)
{
    adcgs_info info;
    ADCGS_TRY(adcgs_get_info(decoder, &info, sizeof info, error));
    int timed = frames != NULL, n = frames ? frames->n : info.cameras;
    if (!n)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: the stream stores no cameras to write", path);
    adcgs_camera_key *const keys = calloc((size_t)n, sizeof *keys);
    if (!keys)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %d cameras", path, n);
    adcgs_status status = frames ? fill_frames(keys, frames) : fill_stored(keys, decoder, &n, &timed, error);
    const double rate = frames ? frames->frame_rate : info.frame_rate;
    fit_size(keys, n);
    if (status == ADCGS_OK)
        status = adcgs_camera_keys_write(keys, n, timed, &info, rate, order, path, error);
    free(keys);
    return status;
}

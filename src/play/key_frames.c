/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Key frames set by the user. */
#include "config.h"

#include "play/key_frames.h"

#include "geometry/rotation.h"
#include "play/files.h"

#include <stdio.h>
#include <stdlib.h>

#define KEY_SECONDS 1.0 /* distance to a key that is not later; chosen by hand, not measured */

static adcgs_status write_keys(const adcgs_key_frames *keys, const adcgs_info *info, adcgs_error *error)
{
    return adcgs_camera_keys_write(keys->key, keys->n, 1, info, info->frame_rate, ADCGS_ROTATION_XYZ, keys->path, error);
}

static adcgs_status reserve(adcgs_key_frames *keys, adcgs_error *error)
{
    if (keys->n < keys->room)
        return ADCGS_OK;
    const int room = 2 * keys->room + 16;
    adcgs_camera_key *const more = realloc(keys->key, (size_t)room * sizeof *more);
    if (!more)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for %d key frames", room);
    keys->key = more;
    keys->room = room;
    return ADCGS_OK;
}

adcgs_status adcgs_key_frames_add(adcgs_key_frames *keys, const adcgs_camera *camera, double time, const char *stream,
                                  const adcgs_info *info, adcgs_error *error)
{
    ADCGS_TRY(reserve(keys, error));
    if (!*keys->path && !adcgs_play_free_name(keys->path, stream, "json"))
        return adcgs_fail(error, ADCGS_ERR_IO, "no unused file name is left for a path");
    adcgs_camera_key *const key = &keys->key[keys->n];
    *key = (adcgs_camera_key){.frame = {*camera, time}};
    if (keys->n) {
        const adcgs_camera *const first = &keys->key[0].frame.camera;
        const double later = time - key[-1].frame.time;
        key->at = key[-1].at + (later > 0.0 ? later : KEY_SECONDS);
        adcgs_camera_fit(&key->frame.camera, first->width, first->height, 0); /* a path has one size */
    }
    keys->n++;
    const adcgs_status status = write_keys(keys, info, error);
    keys->n -= status != ADCGS_OK; /* as in the file */
    return status;
}

adcgs_status adcgs_key_frames_take_back(adcgs_key_frames *keys, const adcgs_info *info, adcgs_error *error)
{
    if (!keys->n)
        return ADCGS_OK;
    keys->n--;
    if (keys->n)
        return write_keys(keys, info, error);
    remove(keys->path);
    *keys->path = 0;
    return ADCGS_OK;
}

void adcgs_key_frames_clear(adcgs_key_frames *keys)
{
    free(keys->key);
    *keys = (adcgs_key_frames){0};
}

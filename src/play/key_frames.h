/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Key frames that the user sets: a camera path, which is saved after each. */
#ifndef ADCGS_PLAY_KEY_FRAMES_H
#define ADCGS_PLAY_KEY_FRAMES_H

#include "camera/path.h"

#include <limits.h>

typedef struct adcgs_key_frames {
    int n, room;
    adcgs_camera_key *key;
    char path[PATH_MAX]; /**< of the file; "": no file yet */
} adcgs_key_frames;

/**
 * Adds a key and writes all keys to the file, which gets its name with the first. The distance of two keys along the path is the
 * difference of their times, or a second if the new key is not later. stream names the file, and the path has its frame rate.
 */
adcgs_status adcgs_key_frames_add(adcgs_key_frames *keys, const adcgs_camera *camera, double time, const char *stream,
                                  const adcgs_info *info, adcgs_error *error);
/** Removes the last key; the file is removed with the first. No effect without keys. */
adcgs_status adcgs_key_frames_take_back(adcgs_key_frames *keys, const adcgs_info *info, adcgs_error *error);
void adcgs_key_frames_clear(adcgs_key_frames *keys);

#endif

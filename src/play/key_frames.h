/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Key frames that the user sets: a camera path, which is in its file after each. */
#ifndef ADCGS_PLAY_KEY_FRAMES_H
#define ADCGS_PLAY_KEY_FRAMES_H

#include "camera/path.h"

#include <limits.h>

typedef struct adcgs_key_frames {
    int n, room;
    adcgs_camera_key *key;
    char path[PATH_MAX]; /**< of the file; "": none yet */
} adcgs_key_frames;

/**
 * One more, and write all to the file, which gets a name with the first. Along the path a key is as far behind the one before as
 * its moment is, or a second where it is not later. stream names the file, and the path has its frame rate.
 */
adcgs_status adcgs_key_frames_add(adcgs_key_frames *keys, const adcgs_camera *camera, double time, const char *stream,
                                  const adcgs_info *info, adcgs_error *error);
/** The last one back; with the first the file goes. Harmless when there is none. */
adcgs_status adcgs_key_frames_take_back(adcgs_key_frames *keys, const adcgs_info *info, adcgs_error *error);
void adcgs_key_frames_clear(adcgs_key_frames *keys);

#endif

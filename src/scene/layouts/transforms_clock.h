/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Fields that give the time of a frame of a transforms file in other programs. */
#ifndef ADCGS_SCENE_LAYOUTS_TRANSFORMS_CLOCK_H
#define ADCGS_SCENE_LAYOUTS_TRANSFORMS_CLOCK_H

#include <jansson.h>

/**
 * Finds a field of n frames, other than "time", that is named like a time or a number of frames and differs between frames.
 * Returns its name, valid as long as the frames, or NULL.
 */
const char *adcgs_transforms_clock(json_t *frames, size_t n);

#endif

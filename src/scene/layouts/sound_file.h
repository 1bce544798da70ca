/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The sound of a scene. */
#ifndef ADCGS_SCENE_LAYOUTS_SOUND_FILE_H
#define ADCGS_SCENE_LAYOUTS_SOUND_FILE_H

#include "base/base.h"

/**
 * The file of a sound, and the time of the stream at which it begins. A path of a folder or a scene file names a scene, which
 * determines both: *file is NULL if it has no sound. Any other path is the file itself, with time 0. The caller free()s *file.
 */
adcgs_status adcgs_sound_file_find(char **file, double *begin, const char *path, adcgs_error *error);

#endif

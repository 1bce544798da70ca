/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The sound of a video, kept next to the scene. */
#ifndef ADCGS_APPS_IMPORT_SCENE_SOUND_H
#define ADCGS_APPS_IMPORT_SCENE_SOUND_H

#include "apps/import/colmap_result.h"

#define ADCGS_IMPORT_SOUND "sound.opus" /**< in the scene's folder */

/** Time of the first view for training, seconds: there the model, and its sound, begin. */
double adcgs_import_begin(const adcgs_poses *poses, const adcgs_import_job *job);
/**
 * Writes the sound of the first video that has one, as Opus, from the first view for training to the last frame. The program
 * ffmpeg converts it. Without this program, or if it fails, the scene has no sound, and the report says why.
 */
adcgs_status adcgs_import_sound(const adcgs_poses *poses, adcgs_import_job *job);

#endif

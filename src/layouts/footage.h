/* SPDX-License-Identifier: BSD-2-Clause */
/** \file What a fixed camera took: a video, or a row of pictures. */
#ifndef ADCGS_LAYOUTS_FOOTAGE_H
#define ADCGS_LAYOUTS_FOOTAGE_H

#include "data/scene.h"

typedef struct adcgs_footage {
    char *video;       /**< NULL: pictures */
    char **pictures;   /**< as many as frames; NULL: one that is missing, where footage comes as it is taken */
    int64_t frames;
    int width, height; /**< of the video, or of the first picture */
    adcgs_fps rate;   /**< of the video; not known for pictures */
} adcgs_footage;

/** The frames of a video are counted. Errors as of adcgs_video_open(). */
adcgs_status adcgs_footage_video(adcgs_footage *out, const char *path, adcgs_error *error);
/** Pictures of a folder in the order of their names. ADCGS_ERR_DATA if there is none. */
adcgs_status adcgs_footage_folder(adcgs_footage *out, const char *folder, adcgs_error *error);
/**
 * Pictures by number: folder, which ends with its slash or is "", and a pattern that has one %d or %0Nd, or
 * none for a picture that stands for itself. count 0: as many as follow each other. ADCGS_ERR_DATA, naming the
 * file, if one is missing.
 */
adcgs_status adcgs_footage_pattern(adcgs_footage *out, const char *folder, const char *pattern, int64_t first, int64_t count,
                                   adcgs_error *error);
/** Whether it is such a pattern, with a number in it. */
int adcgs_footage_is_row(const char *pattern);
/** The path of a number of such a pattern, from malloc(); NULL without memory. */
char *adcgs_footage_number(const char *folder, const char *pattern, int64_t number);
void adcgs_footage_clear(adcgs_footage *footage);

/**
 * Append views to a split, one for each frame of the range, all with the camera and the lens of like; the n-th of them is at
 * begin + n * step. The range must have been counted. ADCGS_ERR_DATA, naming path, if a scene becomes too large.
 */
adcgs_status adcgs_footage_add(adcgs_scene *scene, adcgs_split split, const adcgs_scene_view *like, const adcgs_footage *footage,
                               const adcgs_frame_range *range, double begin, double step, const char *path, adcgs_error *error);
/** Append one view, whose path becomes the scene's; on failure it is freed. */
adcgs_status adcgs_scene_append(adcgs_scene *scene, adcgs_split split, adcgs_scene_view *view, const char *path,
                                adcgs_error *error);

#endif

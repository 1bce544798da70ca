/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The footage of a fixed camera: a video, or numbered images. */
#ifndef ADCGS_SCENE_LAYOUTS_FOOTAGE_H
#define ADCGS_SCENE_LAYOUTS_FOOTAGE_H

#include "scene/scene.h"

typedef struct adcgs_footage {
    char *video;     /**< NULL: images */
    char **pictures; /**< one per frame; NULL: a missing image, for live footage */
    int64_t frames;
    int width, height; /**< of the video, or of the first image */
    adcgs_fps rate;    /**< of the video; unknown for images */
} adcgs_footage;

/** Counts the frames of a video. Errors as from adcgs_video_open(). */
adcgs_status adcgs_footage_video(adcgs_footage *out, const char *path, adcgs_error *error);
/** Lists the images of a folder in the order of their names. ADCGS_ERR_DATA if there is none. */
adcgs_status adcgs_footage_folder(adcgs_footage *out, const char *folder, adcgs_error *error);
/**
 * Lists numbered images. folder ends with its slash or is "". pattern has one %d or %0Nd; without it, it names a single image.
 * count 0: as many as are numbered without a gap. ADCGS_ERR_DATA, naming the file, if one is missing.
 */
adcgs_status adcgs_footage_pattern(adcgs_footage *out, const char *folder, const char *pattern, int64_t first, int64_t count,
                                   adcgs_error *error);
/** True for a pattern with a number in it. */
int adcgs_footage_is_row(const char *pattern);
/** The path for a number in such a pattern, from malloc(); NULL on allocation failure. */
char *adcgs_footage_number(const char *folder, const char *pattern, int64_t number);
void adcgs_footage_clear(adcgs_footage *footage);

/**
 * Appends views to a split, one for each frame of the range, all with the camera and the lens of like. The n-th of them has the
 * time begin + n * step. The range must have been counted. ADCGS_ERR_DATA, naming path, if a scene becomes too large.
 */
adcgs_status adcgs_footage_add(adcgs_scene *scene, adcgs_split split, const adcgs_scene_view *like, const adcgs_footage *footage,
                               const adcgs_frame_range *range, double begin, double step, const char *path, adcgs_error *error);
/** Appends one view. The scene takes ownership of its paths; on failure they are freed. */
adcgs_status adcgs_scene_append(adcgs_scene *scene, adcgs_split split, adcgs_scene_view *view, const char *path,
                                adcgs_error *error);

#endif

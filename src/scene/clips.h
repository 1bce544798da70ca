/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The videos of a scene, kept open while they are in use. Any thread may ask for any frame. A video is decoded sequentially, so
 * it is cheap if one thread asks for all its frames in ascending order.
 */
#ifndef ADCGS_SCENE_CLIPS_H
#define ADCGS_SCENE_CLIPS_H

#include "media/video/video.h"
#include "scene/scene.h"

/** Videos open at once; the least recently used is closed to open another; chosen by hand, not measured. */
#define ADCGS_CLIPS_OPEN 32

typedef struct adcgs_clips adcgs_clips;

adcgs_status adcgs_clips_create(adcgs_clips **out, adcgs_error *error);
void adcgs_clips_free(adcgs_clips **clips);

/** Like adcgs_video_open() and adcgs_video_read(). Waits while all videos that may be open are in use. */
adcgs_status adcgs_clips_read(adcgs_clips *clips, const char *path, int64_t frame, adcgs_image *out, adcgs_error *error);

/** Views in runs. A thread loads the views of a run one after another: order[begin[i]] up to order[begin[i + 1]]. */
typedef struct adcgs_view_runs {
    uint32_t n;
    uint32_t *begin; /**< [n + 1] */
    uint32_t *order; /**< indices of views */
} adcgs_view_runs;

/** Makes one run for each video, by ascending frame, and one for each image file. */
adcgs_status adcgs_view_runs_make(adcgs_view_runs *runs, const adcgs_scene_view *views, uint32_t n, adcgs_error *error);
void adcgs_view_runs_clear(adcgs_view_runs *runs);

#endif
